//! Generates rays that are likely to expose errors of traversals.
//!
//! A seed gives the same rays on every machine.

use glam::Vec3;

use super::Sampler;
use crate::exact::{self, ExactT};
use crate::geometry::{Aabb, Mesh, Ray};
use crate::names::named_enum;
use crate::triangle::{MollerTrumbore, scalar_hit};

named_enum! {
    /// A group of adversarial rays.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Stratum {
        /// Random rays towards points in the box of the mesh.
        Random = "random",
        /// Through a vertex.
        Vertices = "vertices",
        /// Through a point on an edge.
        Edges = "edges",
        /// Axis-parallel directions. Each zero is +0.0 or -0.0.
        AxisParallel = "axis-parallel",
        /// In the plane of a box face. The box bounds the mesh or one triangle.
        FacePlanes = "face-planes",
        /// From a vertex.
        FromVertices = "from-vertices",
        /// From a point on a triangle.
        FromSurface = "from-surface",
        /// From a point with coordinates at which a builder may split.
        FromSplits = "from-splits",
        /// Nearly in the plane of a triangle.
        Grazing = "grazing",
        /// Along diagonals. One component of the direction may be +0.0 or -0.0.
        Diagonals = "diagonals",
        /// Two components of the direction are nearly zero.
        NearlyAxis = "nearly-axis",
        /// Directions with lengths from 1e-30 to 1e30.
        Lengths = "lengths",
        /// Origins at a distance of 1e3 to 1e8 box sizes from a triangle.
        FarOrigins = "far-origins",
        /// From a point near a triangle.
        NearSurface = "near-surface",
        /// Most intervals begin or end within one ulp of the `t` of a hit.
        Windows = "windows",
        /// Rays with NaN, infinity, a zero direction or an empty interval. Every ray must miss.
        Invalid = "invalid",
        /// The interval ends or begins at the exact `t` of a hit, rounded to a float. For half of the rays, this `t` is
        /// near the largest float.
        RoundedEnds = "rounded-ends",
    }
}

impl Stratum {
    /// An empty mesh is replaced by one triangle of unit size.
    pub fn rays(self, mesh: &Mesh, count: usize, seed: u64) -> Vec<Ray> {
        let mut generator = Generator::new(mesh, seed ^ (self as u64) << 32);
        (0..count).map(|_| generator.ray(self)).collect()
    }
}

struct Generator<'a> {
    mesh: &'a Mesh,
    bounds: Aabb,
    /// The longest side of `bounds`, or 1 for a point.
    size: f32,
    sampler: Sampler,
}

impl<'a> Generator<'a> {
    fn new(mesh: &'a Mesh, seed: u64) -> Self {
        let bounds = if mesh.is_empty() { Aabb::of_points(Self::UNIT) } else { mesh.bounds() };
        let size = bounds.extent().max_element();
        let size = if size > 0.0 { size.min(f32::MAX) } else { 1.0 };
        Self { mesh, bounds, size, sampler: Sampler::new(seed) }
    }

    const UNIT: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

    fn ray(&mut self, stratum: Stratum) -> Ray {
        match stratum {
            Stratum::Random => self.random(),
            Stratum::Vertices => self.towards(Self::vertex),
            Stratum::Edges => self.towards(Self::on_edge),
            Stratum::AxisParallel => self.axis_parallel(),
            Stratum::FacePlanes => self.face_plane(),
            Stratum::FromVertices => self.from(Self::vertex),
            Stratum::FromSurface => self.from(Self::on_surface),
            Stratum::FromSplits => self.from(Self::on_splits),
            Stratum::Grazing => self.grazing(),
            Stratum::Diagonals => {
                let direction = self.diagonal();
                self.through(direction)
            }
            Stratum::NearlyAxis => {
                let (axis, tiny) = (self.sampler.below(3), self.sampler.pick(&[1e-9, 1e-30, 1e-40]));
                let mut direction = self.sampler.cube() * tiny;
                direction[axis] = self.sampler.sign();
                self.through(direction)
            }
            Stratum::Lengths => {
                let ray = self.random();
                let length = self.sampler.pick(&[1e-30, 1e-20, 1e-10, 1e-6, 1e-3, 1e3, 1e6, 1e15, 1e30]);
                Ray { direction: ray.direction.normalize_or(Vec3::X) * length, ..ray }
            }
            Stratum::FarOrigins => {
                let (target, away) = (self.on_surface(), self.sampler.pick(&[1e3, 1e4, 1e5, 1e6, 1e7, 1e8]));
                let direction = self.direction_or_axis();
                Ray::new(target - direction * (self.size * away), direction)
            }
            Stratum::NearSurface => {
                let (target, away) =
                    (self.on_surface(), self.sampler.pick(&[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7]));
                let direction = self.sampler.direction();
                Ray::new(target - direction * (self.size * away), direction)
            }
            Stratum::Windows => self.window(),
            Stratum::Invalid => self.invalid(),
            Stratum::RoundedEnds => self.rounded_end(),
        }
    }

    fn corners(&mut self) -> [Vec3; 3] {
        match self.mesh.len() {
            0 => Self::UNIT,
            n => self.mesh.corners(self.sampler.below(n) as u32),
        }
    }

    fn vertex(&mut self) -> Vec3 {
        let corners = self.corners();
        self.sampler.pick(&corners)
    }

    fn on_edge(&mut self) -> Vec3 {
        let [a, b, _] = self.rotated();
        let s = if self.sampler.coin() { self.sampler.unit() } else { self.sampler.pick(&[0.25, 0.5, 0.75]) };
        a * (1.0 - s) + b * s
    }

    fn on_surface(&mut self) -> Vec3 {
        let corners = self.corners();
        self.sampler.point_of(corners)
    }

    fn rotated(&mut self) -> [Vec3; 3] {
        let mut corners = self.corners();
        corners.rotate_left(self.sampler.below(3));
        corners
    }

    fn origin(&mut self) -> Vec3 {
        let reach = if self.sampler.coin() { 0.5 } else { 2.0 };
        self.bounds.centre() + self.sampler.cube() * (self.size * reach)
    }

    /// A coordinate at which a builder may split.
    fn split(&mut self, axis: usize) -> f32 {
        let (low, high) = (self.bounds.min[axis], self.bounds.max[axis]);
        let [a, b, c] = self.corners().map(|p| p[axis]);
        match self.sampler.below(4) {
            0 => low + (high - low) * (self.sampler.below(9) as f32 / 8.0),
            1 => 0.5 * (a.min(b).min(c) + a.max(b).max(c)),
            2 => (a + b + c) / 3.0,
            _ => a,
        }
    }

    fn on_splits(&mut self) -> Vec3 {
        Vec3::from_array(std::array::from_fn(|axis| self.split(axis)))
    }

    fn random(&mut self) -> Ray {
        self.towards(|own| own.bounds.centre() + own.sampler.cube() * (own.bounds.extent() * 0.5))
    }

    fn towards(&mut self, target: impl Fn(&mut Self) -> Vec3) -> Ray {
        let (target, origin) = (target(self), self.origin());
        Ray::new(origin, target - origin)
    }

    fn from(&mut self, origin: impl Fn(&mut Self) -> Vec3) -> Ray {
        let origin = origin(self);
        Ray::new(origin, self.any_direction(origin))
    }

    fn through(&mut self, direction: Vec3) -> Ray {
        let target = match self.sampler.below(3) {
            0 => self.vertex(),
            1 => self.on_edge(),
            _ => self.on_splits(),
        };
        let away = self.sampler.pick(&[0.0, 0.25, 1.0, 2.0, 10.0]);
        Ray::new(target - direction * (self.size * away), direction)
    }

    fn axis_of(&mut self, direction: Vec3) -> Vec3 {
        let axis = self.sampler.below(3);
        let mut along = Vec3::new(self.sampler.zero(), self.sampler.zero(), self.sampler.zero());
        along[axis] = 1.0_f32.copysign(direction[axis]);
        along
    }

    fn direction_or_axis(&mut self) -> Vec3 {
        let direction = self.sampler.direction();
        if self.sampler.coin() { self.axis_of(direction) } else { direction }
    }

    fn any_direction(&mut self, origin: Vec3) -> Vec3 {
        let direction = self.sampler.direction();
        match self.sampler.below(4) {
            0 => self.axis_of(direction),
            1 => self.diagonal(),
            2 => self.vertex() - origin,
            _ => direction,
        }
    }

    fn axis_parallel(&mut self) -> Ray {
        let direction = self.sampler.direction();
        let direction = self.axis_of(direction);
        let mut ray = self.through(direction);
        if self.sampler.coin() {
            // The coordinates of vertices may put the ray on an edge of a box.
            let axis = direction.abs().max_position();
            for other in [(axis + 1) % 3, (axis + 2) % 3] {
                ray.origin[other] = self.vertex()[other];
            }
        }
        ray
    }

    fn face_plane(&mut self) -> Ray {
        let bounds = if self.sampler.coin() { self.bounds } else { Aabb::of_points(self.corners()) };
        let axis = self.sampler.below(3);
        let direction = self.direction_or_axis();
        let mut ray = Ray::new(self.origin(), direction);
        ray.origin[axis] = if self.sampler.coin() { bounds.min[axis] } else { bounds.max[axis] };
        ray.direction[axis] = self.sampler.zero();
        if self.sampler.coin() {
            let other = (axis + 1) % 3;
            ray.origin[other] = if self.sampler.coin() { bounds.min[other] } else { bounds.max[other] };
        }
        if self.sampler.coin() {
            let target = self.on_surface();
            let mut aimed = target - ray.origin;
            aimed[axis] = ray.direction[axis];
            ray.direction = aimed;
        }
        ray
    }

    fn diagonal(&mut self) -> Vec3 {
        let mut direction = Vec3::new(self.sampler.sign(), self.sampler.sign(), self.sampler.sign());
        let axis = self.sampler.below(4);
        if axis < 3 {
            direction[axis] = self.sampler.zero();
        }
        direction
    }

    fn grazing(&mut self) -> Ray {
        let [a, b, c] = self.rotated();
        let target = self.sampler.point_of([a, b, c]);
        let along = (b - a) * self.sampler.signed() + (c - a) * self.sampler.signed();
        let along = if along == Vec3::ZERO { self.sampler.direction() } else { along };
        let slope = self.sampler.pick(&[0.0, 1e-3, 1e-5, 1e-6, 1e-7]);
        let up = (b - a).cross(c - a).normalize_or_zero() * (along.length() * slope);
        let direction = along + up * self.sampler.sign();
        Ray::new(target - direction * self.sampler.pick(&[0.0, 1.0, 4.0]), direction)
    }

    fn window(&mut self) -> Ray {
        let corners = self.corners();
        let ray = self.towards(|own| own.sampler.point_of(corners));
        let t = scalar_hit::<MollerTrumbore>(&ray, corners).unwrap_or(1.0);
        let (t_min, t_max) = match self.sampler.below(7) {
            0 => (0.0, t),
            1 => (0.0, t.next_up()),
            2 => (0.0, t.next_down()),
            3 => (t, f32::INFINITY),
            4 => (t.next_up(), f32::INFINITY),
            5 => (t, t.next_up()),
            _ => (t * 0.5, t * 2.0),
        };
        Ray { t_min, t_max, ..ray }
    }

    fn invalid(&mut self) -> Ray {
        let mut ray = self.random();
        let axis = self.sampler.below(3);
        let bad = self.sampler.pick(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
        match self.sampler.below(7) {
            0 => ray.origin[axis] = bad,
            1 => ray.direction[axis] = bad,
            2 => ray.direction = Vec3::new(self.sampler.zero(), self.sampler.zero(), self.sampler.zero()),
            3 => (ray.t_min, ray.t_max) = (1.0, 0.5),
            4 => (ray.t_min, ray.t_max) = (1.0, 1.0),
            5 => ray.t_min = f32::NAN,
            _ => ray.t_max = self.sampler.pick(&[f32::NAN, 0.0, -0.0, -1.0, f32::NEG_INFINITY]),
        }
        ray
    }

    fn rounded_end(&mut self) -> Ray {
        let corners = self.corners();
        let (target, away) = (self.sampler.point_of(corners), self.sampler.pick(&[1.0, 30.0, 1e3]));
        // If the origin is far from the target, `near_the_largest_t` produces fewer denormal direction components.
        let back = (self.origin() - target) * away;
        let mut ray = Ray::new(target + back, -back * (0.5 + self.sampler.unit()));
        let (is_far, end) = (self.sampler.coin(), self.sampler.below(3) / 2);
        if is_far {
            ray = exact::hit(&ray, corners).map_or(ray, |t| near_the_largest_t(&ray, t.approximate()));
        }
        exact::hit(&ray, corners).map_or(ray.until(f32::MAX), |t| rounded_ends(&ray, &t)[end])
    }
}

/// Let `end` be `t`, rounded to a float. The interval of the first ray ends at `end`. The interval of the second ray
/// begins at `end`. If the exact `t` is below `end`, a hit at `t` belongs only to the first interval.
pub fn rounded_ends(ray: &Ray, t: &ExactT) -> [Ray; 2] {
    let end = t.round();
    [ray.until(end), Ray { t_min: end, ..*ray }]
}

/// Scales the direction of `ray` to move the hit from `t` to about the largest float.
pub fn near_the_largest_t(ray: &Ray, t: f64) -> Ray {
    Ray { direction: (ray.direction.as_dvec3() * (t / f64::from(f32::MAX))).as_vec3(), ..*ray }
}

#[cfg(test)]
mod tests;
