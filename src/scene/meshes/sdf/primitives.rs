//! The primitives: ellipsoids, round cones, tubes along splines, and frames to place them in.

use glam::Vec3;

use super::Sdf;

/// A coordinate frame: `right`, `up` and `ahead`, of unit length and at right angles.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub origin: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub ahead: Vec3,
}

impl Frame {
    pub const WORLD: Self = Self { origin: Vec3::ZERO, right: Vec3::X, up: Vec3::Y, ahead: Vec3::Z };

    /// The frame at `origin` that looks `ahead`, with `up` as near as possible to the given one.
    pub fn looking(origin: Vec3, ahead: Vec3, up: Vec3) -> Self {
        let ahead = ahead.normalize();
        let right = up.cross(ahead).normalize();
        Self { origin, right, up: ahead.cross(right), ahead }
    }

    /// From local (right, up, ahead) to world coordinates.
    pub fn at(&self, x: f32, y: f32, z: f32) -> Vec3 {
        self.origin + (self.right * x + self.up * y + self.ahead * z)
    }

    /// From world coordinates to local (right, up, ahead).
    pub fn local(&self, p: Vec3) -> Vec3 {
        let q = p - self.origin;
        Vec3::new(q.dot(self.right), q.dot(self.up), q.dot(self.ahead))
    }
}

/// Two spheres with the tangent cone between them.
#[derive(Clone, Copy, Debug)]
pub struct RoundCone {
    pub a: Vec3,
    pub b: Vec3,
    pub radius_a: f32,
    pub radius_b: f32,
    /// Unit vector from `a` to `b`, and their distance; 0 when one sphere holds the other.
    axis: Vec3,
    length: f32,
    /// Sine and cosine of half the opening angle.
    sine: f32,
    cosine: f32,
}

impl RoundCone {
    pub fn new(a: Vec3, radius_a: f32, b: Vec3, radius_b: f32) -> Self {
        let length = a.distance(b);
        let change = radius_a - radius_b;
        if length <= change.abs() {
            let (centre, radius) = if change > 0.0 { (a, radius_a) } else { (b, radius_b) };
            let (a, b, radius_a, radius_b) = (centre, centre, radius, radius);
            return Self { a, b, radius_a, radius_b, axis: Vec3::ZERO, length: 0.0, sine: 0.0, cosine: 1.0 };
        }
        let sine = change / length;
        let cosine = (1.0 - sine * sine).sqrt();
        Self { a, b, radius_a, radius_b, axis: (b - a) / length, length, sine, cosine }
    }

    /// Exact distance, in the plane through the axis and `p`.
    pub fn distance(&self, p: Vec3) -> f32 {
        let q = p - self.a;
        let along = q.dot(self.axis);
        let off = (q.length_squared() - along * along).max(0.0).sqrt();

        // Foot of the perpendicular on the cone's side, along the axis and stretched by the cosine.
        let foot = along * self.cosine - off * self.sine;
        if foot <= 0.0 {
            q.length() - self.radius_a
        } else if foot >= self.length * self.cosine {
            p.distance(self.b) - self.radius_b
        } else {
            off * self.cosine + along * self.sine - self.radius_a
        }
    }
}

/// One point of a tube: x, y, z and radius.
#[derive(Clone, Copy, Debug)]
pub struct Knot(pub f32, pub f32, pub f32, pub f32);

impl Knot {
    fn place(self) -> Vec3 {
        Vec3::new(self.0, self.1, self.2)
    }
}

/// A tube along a smooth curve through given points.
pub struct Tube {
    pub centres: Vec<Vec3>,
    pub radii: Vec<f32>,
}

impl Tube {
    /// The Catmull-Rom curve through `points`, in `steps` pieces between two of them.
    pub fn through(points: &[Knot], steps: usize) -> Self {
        let at = |i: isize| points[i.clamp(0, points.len() as isize - 1) as usize];
        let (mut centres, mut radii) = (Vec::new(), Vec::new());
        for i in 0..points.len() as isize - 1 {
            let four = [at(i - 1), at(i), at(i + 1), at(i + 2)];
            for s in 0..steps {
                let t = s as f32 / steps as f32;
                centres.push(catmull_rom(four.map(Knot::place), t));
                radii.push(catmull_rom(four.map(|r| Vec3::splat(r.3)), t).x.max(0.5 * four[1].3.min(four[2].3)));
            }
        }
        let last = at(isize::MAX);
        centres.push(last.place());
        radii.push(last.3);
        Self { centres, radii }
    }

    /// Unit tangent at point `i`.
    pub fn tangent(&self, i: usize) -> Vec3 {
        let last = self.centres.len() - 1;
        (self.centres[(i + 1).min(last)] - self.centres[i.saturating_sub(1)]).normalize()
    }

    /// Frames along the tube that do not twist about it; the one at point `start` has `up` on top.
    pub fn frames(&self, start: usize, up: Vec3) -> Vec<Frame> {
        let count = self.centres.len();
        let mut frames = vec![Frame::looking(self.centres[start], self.tangent(start), up); count];
        for i in start + 1..count {
            frames[i] = Frame::looking(self.centres[i], self.tangent(i), frames[i - 1].up);
        }
        for i in (0..start).rev() {
            frames[i] = Frame::looking(self.centres[i], self.tangent(i), frames[i + 1].up);
        }
        frames
    }

    /// The piece between points `i` and `i + 1`.
    pub fn piece(&self, i: usize) -> RoundCone {
        RoundCone::new(self.centres[i], self.radii[i], self.centres[i + 1], self.radii[i + 1])
    }

    pub fn pieces(&self) -> usize {
        self.centres.len() - 1
    }
}

fn catmull_rom([a, b, c, d]: [Vec3; 4], t: f32) -> Vec3 {
    let (t2, t3) = (t * t, t * t * t);
    (b * 2.0 + (c - a) * t + (a * 2.0 - b * 5.0 + c * 4.0 - d) * t2 + (b * 3.0 - a - c * 3.0 + d) * t3) * 0.5
}

/// Sine of an angle in radians, the same on every machine.
pub fn sine(angle: f32) -> f32 {
    libm::sin(f64::from(angle)) as f32
}

/// Cosine of an angle in radians, the same on every machine.
pub fn cosine(angle: f32) -> f32 {
    libm::cos(f64::from(angle)) as f32
}

/// The intersection of two solids whose surfaces meet at right angles, grown by `radius`, which rounds the edge.
pub fn rounded_intersection(u: f32, v: f32, radius: f32) -> f32 {
    let (out_u, out_v) = (u.max(0.0), v.max(0.0));
    (out_u * out_u + out_v * out_v).sqrt() + u.max(v).min(0.0) - radius
}

impl Sdf {
    pub fn sphere(&mut self, centre: Vec3, radius: f32) -> &mut Self {
        self.primitive(centre, radius, move |p| p.distance(centre) - radius)
    }

    /// An ellipsoid along the axes of the world.
    pub fn ellipsoid(&mut self, centre: Vec3, radii: Vec3) -> &mut Self {
        self.ellipsoid_in(&Frame { origin: centre, ..Frame::WORLD }, Vec3::ZERO, radii)
    }

    /// An ellipsoid along the axes of `frame`, around the point `centre` there.
    pub fn ellipsoid_in(&mut self, frame: &Frame, centre: impl Into<Vec3>, radii: impl Into<Vec3>) -> &mut Self {
        let (centre, radii) = (centre.into(), radii.into());
        let frame = Frame { origin: frame.at(centre.x, centre.y, centre.z), ..*frame };
        self.primitive(frame.origin, radii.max_element(), move |p| {
            // Exact on the surface and to first order near it.
            let q = frame.local(p);
            let (a, b) = ((q / radii).length(), (q / (radii * radii)).length());
            if b < 1e-9 { -radii.min_element() } else { a * (a - 1.0) / b }
        })
    }

    pub fn cone(&mut self, a: Vec3, radius_a: f32, b: Vec3, radius_b: f32) -> &mut Self {
        let cone = RoundCone::new(a, radius_a, b, radius_b);
        let radius = 0.5 * a.distance(b) + radius_a.max(radius_b);
        self.primitive((a + b) * 0.5, radius, move |p| cone.distance(p))
    }

    /// A tube through `knots`, in `steps` cones between two of them.
    pub fn tube(&mut self, knots: &[Knot], steps: usize) -> &mut Self {
        let tube = Tube::through(knots, steps);
        for i in 0..tube.pieces() {
            let piece = tube.piece(i);
            self.cone(piece.a, piece.radius_a, piece.b, piece.radius_b);
        }
        self
    }

    /// A tube through `knots` that are given in `frame`.
    pub fn tube_in(&mut self, frame: &Frame, knots: &[Knot], steps: usize) -> &mut Self {
        let outside = |&Knot(x, y, z, radius): &Knot| {
            let p = frame.at(x, y, z);
            Knot(p.x, p.y, p.z, radius)
        };
        self.tube(&knots.iter().map(outside).collect::<Vec<_>>(), steps)
    }
}
