//! Ellipsoids, round cones, tubes along splines, and frames that place primitives.

use glam::{Vec3, Vec4};

use super::Sdf;

/// `right`, `up` and `ahead` are orthogonal unit vectors.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub origin: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub ahead: Vec3,
}

impl Frame {
    pub const WORLD: Self = Self { origin: Vec3::ZERO, right: Vec3::X, up: Vec3::Y, ahead: Vec3::Z };

    /// The up axis of the frame is as near to `up` as possible.
    pub fn looking(origin: Vec3, ahead: Vec3, up: Vec3) -> Self {
        let ahead = ahead.normalize();
        let right = up.cross(ahead).normalize();
        Self { origin, right, up: ahead.cross(right), ahead }
    }

    pub fn at(&self, x: f32, y: f32, z: f32) -> Vec3 {
        self.origin + (self.right * x + self.up * y + self.ahead * z)
    }

    pub fn local(&self, p: Vec3) -> Vec3 {
        let q = p - self.origin;
        Vec3::new(q.dot(self.right), q.dot(self.up), q.dot(self.ahead))
    }
}

/// The convex hull of two spheres: a cone with round ends.
#[derive(Clone, Copy, Debug)]
pub struct RoundCone {
    pub a: Vec3,
    pub b: Vec3,
    pub radius_a: f32,
    pub radius_b: f32,
    /// `axis` and `length` are 0 if one sphere contains the other sphere.
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

    pub fn distance(&self, p: Vec3) -> f32 {
        let q = p - self.a;
        let along = q.dot(self.axis);
        let off = (q.length_squared() - along * along).max(0.0).sqrt();

        // `foot` is the coordinate of `p` along the side of the cone.
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

/// Points (x, y, z, radius) along a smooth curve.
pub struct Tube(pub Vec<Vec4>);

impl Tube {
    /// Catmull-Rom curve through `knots`, with `steps` pieces from one knot to the next.
    pub fn through(knots: &[Vec4], steps: usize) -> Self {
        let at = |i: usize| knots[i.min(knots.len() - 1)];
        let piece = |i: usize| {
            let four @ [_, b, c, _] = [at(i.saturating_sub(1)), at(i), at(i + 1), at(i + 2)];
            let points = (0..steps).map(move |s| catmull_rom(four, s as f32 / steps as f32));
            points.map(move |p| p.with_w(p.w.max(0.5 * b.w.min(c.w))))
        };
        Self((0..knots.len() - 1).flat_map(piece).chain(knots.last().copied()).collect())
    }

    pub fn centre(&self, i: usize) -> Vec3 {
        self.0[i].truncate()
    }

    pub fn tangent(&self, i: usize) -> Vec3 {
        (self.centre((i + 1).min(self.pieces())) - self.centre(i.saturating_sub(1))).normalize()
    }

    /// Returns one frame per point, without twist about the tube. The up axis of frame `start` is near `up`.
    pub fn frames(&self, start: usize, up: Vec3) -> Vec<Frame> {
        let frame = |i: usize, up: Vec3| Frame::looking(self.centre(i), self.tangent(i), up);
        let mut frames = vec![frame(start, up); self.0.len()];
        (start + 1..frames.len()).for_each(|i| frames[i] = frame(i, frames[i - 1].up));
        (0..start).rev().for_each(|i| frames[i] = frame(i, frames[i + 1].up));
        frames
    }

    pub fn piece(&self, i: usize) -> RoundCone {
        RoundCone::new(self.centre(i), self.0[i].w, self.centre(i + 1), self.0[i + 1].w)
    }

    pub fn pieces(&self) -> usize {
        self.0.len() - 1
    }
}

fn catmull_rom([a, b, c, d]: [Vec4; 4], t: f32) -> Vec4 {
    let (t2, t3) = (t * t, t * t * t);
    (b * 2.0 + (c - a) * t + (a * 2.0 - b * 5.0 + c * 4.0 - d) * t2 + (b * 3.0 - a - c * 3.0 + d) * t3) * 0.5
}

/// Sine of an angle in radians, the same on every machine.
pub fn sine(angle: f32) -> f32 {
    libm::sin(f64::from(angle)) as f32
}

pub fn cosine(angle: f32) -> f32 {
    libm::cos(f64::from(angle)) as f32
}

/// If `a` and `b` are the signed distances to two solids, pass `u = a + radius` and `v = b + radius`.
pub fn rounded_intersection(u: f32, v: f32, radius: f32) -> f32 {
    let (out_u, out_v) = (u.max(0.0), v.max(0.0));
    (out_u * out_u + out_v * out_v).sqrt() + u.max(v).min(0.0) - radius
}

impl Sdf {
    pub fn sphere(&mut self, centre: Vec3, radius: f32) -> &mut Self {
        self.primitive(centre, radius, move |p| p.distance(centre) - radius)
    }

    pub fn ellipsoid(&mut self, centre: Vec3, radii: Vec3) -> &mut Self {
        self.ellipsoid_in(&Frame { origin: centre, ..Frame::WORLD }, Vec3::ZERO, radii)
    }

    /// `centre` is in the coordinates of `frame`.
    pub fn ellipsoid_in(&mut self, frame: &Frame, centre: impl Into<Vec3>, radii: impl Into<Vec3>) -> &mut Self {
        let (centre, radii) = (centre.into(), radii.into());
        let frame = Frame { origin: frame.at(centre.x, centre.y, centre.z), ..*frame };
        self.primitive(frame.origin, radii.max_element(), move |p| {
            // The distance is correct to first order near the surface.
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

    pub fn tube(&mut self, knots: &[Vec4], steps: usize) -> &mut Self {
        let tube = Tube::through(knots, steps);
        for i in 0..tube.pieces() {
            let piece = tube.piece(i);
            self.cone(piece.a, piece.radius_a, piece.b, piece.radius_b);
        }
        self
    }

    pub fn tube_in(&mut self, frame: &Frame, knots: &[Vec4], steps: usize) -> &mut Self {
        let outside = |knot: &Vec4| frame.at(knot.x, knot.y, knot.z).extend(knot.w);
        self.tube(&knots.iter().map(outside).collect::<Vec<_>>(), steps)
    }
}
