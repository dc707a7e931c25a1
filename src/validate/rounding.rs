//! Bounds the rounding errors of a triangle test in single precision.

use glam::{DVec3, Vec3};

use crate::geometry::{Mesh, PrimId, Ray};

/// The maximum relative rounding error of one operation in single precision.
const ROUNDOFF: f64 = 1.0 / (1_u64 << 24) as f64;

/// The maximum number of rounding errors that add up in one triangle test. Covers tests that store corners and tests
/// that store planes or transformations.
const OPERATIONS: f64 = 32.0;

/// Intermediate results above this limit may overflow in single precision.
const LARGEST: f64 = (1_u128 << 125) as f64;

/// Intermediate results below this limit may underflow in single precision.
const SMALLEST: f64 = 1.0 / (1_u128 << 102) as f64;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Hits are exact. `t` is rounded to the nearest `f32`.
    Exact,
    /// The test computes with a precision of at least 24 bits, from differences of corners and origin or from stored
    /// planes.
    Single,
}

/// The intersection of a ray and the plane of a triangle, with error bounds.
///
/// A is the largest distance of the corners and the ray origin from (0, 0, 0). L is the length of the longest edge. D
/// is the length of the direction. r is `OPERATIONS` * `ROUNDOFF`. det is the dot product of the direction and the
/// cross product of two edges. The error of a barycentric weight is at most r A L D / |det|. The error of `t` is at
/// most r A L L / |det| + r |t|.
///
/// # References
/// Higham: Accuracy and Stability of Numerical Algorithms, 2nd edition, 2002 (running error of inner products).
pub struct Margin {
    /// The smallest of the three barycentric weights. Negative outside the triangle.
    weight: f64,
    weight_error: f64,
    /// The ray parameter at the plane of the triangle.
    t: f64,
    t_error: f64,
    /// Whether no intermediate result can overflow or underflow in single precision.
    is_in_range: bool,
    precision: Precision,
}

impl Margin {
    pub fn new(ray: &Ray, corners: [Vec3; 3], precision: Precision) -> Self {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let [a, b, c] = corners.map(|corner| corner.as_dvec3() - origin);
        let normal = (b - a).cross(c - a);
        let determinant = direction.dot(normal);
        let volumes = [b.cross(c), c.cross(a), a.cross(b)].map(|area| direction.dot(area));
        let weight = volumes.into_iter().map(|volume| volume / determinant).fold(f64::INFINITY, f64::min);
        let t = a.dot(normal) / determinant;

        let length = direction.length();
        let edge = [b - a, c - b, a - c].map(DVec3::length).into_iter().fold(0.0, f64::max);
        let size = corners.map(|corner| corner.as_dvec3().length()).into_iter().fold(origin.length(), f64::max);
        let rounded = OPERATIONS * ROUNDOFF / determinant.abs();
        let largest = (length.max(edge) * edge * size).max(length * edge * edge).max(t.abs()).max(size / length);
        let smallest = determinant.abs().min(edge * edge * size / length.max(1.0)).min(size / length);
        Self {
            weight,
            weight_error: rounded * size * edge * length,
            t,
            t_error: rounded * size * edge * edge + OPERATIONS * ROUNDOFF * t.abs(),
            is_in_range: largest < LARGEST && smallest > SMALLEST,
            precision,
        }
    }

    /// Whether rounding may turn a hit into a miss.
    pub fn may_miss(&self, ray: &Ray) -> bool {
        let (t_min, _) = ray.interval();
        // The smallest of three weights with sum 1 is at most 1/3. A larger `weight` is a rounding error.
        let is_inside = self.weight.min(1.0 / 3.0) > self.weight_error
            && self.t - self.t_error > f64::from(t_min)
            && self.t + self.t_error < ray.end();
        self.precision == Precision::Single && !(is_inside && self.is_in_range)
    }

    /// Whether rounding may turn a miss into a hit at `t`.
    pub fn may_hit(&self, ray: &Ray, t: f32) -> bool {
        // If the determinant is nearly zero, a test may compute any weight and any `t`.
        let is_along = self.weight_error.is_nan() || self.weight_error >= 1.0;
        let is_near = self.weight >= -self.weight_error && self.may_round_to(t);
        let (t_min, t_max) = ray.interval();
        let is_within = (t_min..=t_max).contains(&t);
        self.precision == Precision::Single && is_within && (is_along || is_near || !self.is_in_range)
    }

    /// Whether rounding may change the ray parameter at the plane to `t`.
    pub fn may_round_to(&self, t: f32) -> bool {
        let is_near = (f64::from(t) - self.t).abs() <= self.t_error || self.t_error.is_nan();
        self.precision == Precision::Single && (is_near || !self.is_in_range)
    }

    /// The largest ray parameter that a test may compute at the plane.
    pub fn latest(&self) -> f64 {
        self.t + if self.precision == Precision::Single { self.t_error } else { 0.0 }
    }
}

/// The nearest triangle that a test in single precision must hit before `limit`, with the `t` of the hit.
pub fn nearest_certain_hit(mesh: &Mesh, ray: &Ray, limit: f64) -> Option<(f64, PrimId)> {
    let margins = mesh.solid().map(|index| (Margin::new(ray, mesh.corners(index), Precision::Single), index));
    let sure = margins.filter(|(margin, _)| margin.latest() < limit && !margin.may_miss(ray));
    let nearest = sure.min_by(|(one, _), (other, _)| one.t.total_cmp(&other.t));
    nearest.map(|(margin, index)| (margin.t, PrimId::new(index)))
}

/// Whether a test in single precision may hit at least one triangle of `mesh`.
pub fn may_be_hit(mesh: &Mesh, ray: &Ray) -> bool {
    (0..mesh.len() as u32).any(|index| {
        let margin = Margin::new(ray, mesh.corners(index), Precision::Single);
        let (t_min, t_max) = ray.interval();
        margin.may_hit(ray, (margin.t as f32).clamp(t_min, t_max))
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::accel::Accel;
    use crate::brute_force::BruteForce;
    use crate::external::obvhs::RtTest;
    use crate::triangle::{BaldwinWeber, Exact, MollerTrumbore, TriangleTest, Watertight};
    use crate::validate::{Reference, Stratum, degenerate_meshes, validate};

    /// Asserts that rounding explains all wrong results of the test `T`.
    fn is_excused<T: TriangleTest>(count: usize) {
        for (name, mesh) in degenerate_meshes() {
            let subject = BruteForce::<T>::build(&mesh, &Default::default()).unwrap();
            let exact = BruteForce::<Exact>::build(&mesh, &Default::default()).unwrap();
            let reference = Reference::structure(Box::new(exact), "own");
            for stratum in Stratum::ALL {
                let found = validate(&subject, &reference, &mesh, &stratum.rays(&mesh, count, 5));
                let worst = found.worst_error().map(ToString::to_string);
                assert_eq!(found.answer_errors, 0, "{} over {name}, {}: {worst:?}", T::NAME, stratum.name());
            }
        }
    }

    /// Plücker's test is missing here, because its error grows with the square of the distance. A bound that covers
    /// this error would also excuse lost leaves of large, fine meshes.
    #[test]
    fn no_test_by_edges_or_planes_rounds_beyond_the_bound() {
        is_excused::<MollerTrumbore>(40);
        is_excused::<Watertight>(40);
        is_excused::<BaldwinWeber>(40);
        is_excused::<RtTest>(40);
    }

    #[test]
    fn a_hit_well_inside_is_sure() {
        let square = |scale: f32| {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0) * scale);
            Arc::new(Mesh::new(corners.into(), vec![[0, 1, 2], [0, 2, 3]]).unwrap())
        };
        let down = |x: f32, y: f32| Ray::new(Vec3::new(x, y, 2.0), Vec3::NEG_Z);
        for (scale, ray, is_certain) in [
            (1.0, down(0.75, 0.25), true),
            // The hit is on an edge.
            (1.0, down(0.5, 0.5), false),
            // The hit is close to an edge.
            (1.0, down(0.5, 0.5000001), false),
            // The hit is at the end of the interval.
            (1.0, down(0.75, 0.25).until(2.0), false),
            // Products underflow.
            (1e-20, down(0.75e-20, 0.25e-20), false),
        ] {
            assert_eq!(nearest_certain_hit(&square(scale), &ray, f64::INFINITY).is_some(), is_certain, "{scale} {ray}");
        }
    }
}
