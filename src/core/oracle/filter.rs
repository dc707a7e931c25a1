//! The filter of the oracle: intersects one line with one triangle in `f64`, with a proven error bound.
//!
//! # Proof
//! Let `u` = 2^-53. The inputs are finite `f32`, hence exact in `f64`. Let `a`, `b`, `c` be the corners relative to the
//! ray's origin. Each component is computed by one subtraction, so it is the true value times (1 + e), |e| <= u.
//!
//! *No operation overflows or underflows.* A component of `a`, of an edge or of the direction is 0 or between 2^-149
//! and 2^129 in magnitude. A rounded product of two components is 0 or at least 2^-298, and has 53 bits, so it is a
//! multiple of 2^-350. The difference of two such products is therefore 0 or at least 2^-350. Its product with a third
//! component is 0 or at least 2^-499. All values are below 2^(129 + 129 + 129 + 3) = 2^390. `f64` allows
//! 2^-1022 to 2^1024, so every operation has a relative error of at most `u`. A product is 0 only if a factor is 0.
//!
//! *A triple product* `x . cross(y, z)` is the sum of six terms `x_i y_j z_k`. Rounding multiplies each term by at most
//! eight factors (1 + e): three for the subtractions of its components, two for its products, one for the difference of
//! two products, two for the sum of three. So the error of the computed sum is at most g P, where P is the sum of the
//! magnitudes of the six true terms and g = 8u / (1 - 8u) (Higham 2002, section 3.1). The sum of magnitudes, computed
//! by the same operations, is at least (1 - g) P. Hence the error is at most g / (1 - g) times the *computed* sum of
//! magnitudes, which is less than 16 u times this sum. The multiplication by 16 u, a power of two, is exact.
//!
//! # References
//! Shewchuk: Adaptive precision floating-point arithmetic and fast robust geometric predicates. 1997 (the idea of the
//! filter). Higham: Accuracy and stability of numerical algorithms. 2nd ed. 2002.

use std::cmp::Ordering;

use glam::{DVec3, Vec3};

use crate::geometry::Ray;

/// 16 u, with the u of the proof above.
const BOUND: f64 = 16.0 / (1u64 << 53) as f64;

/// 8 u: more than the relative error of four roundings.
const OUTWARD: f64 = 8.0 / (1u64 << 53) as f64;

/// The result of the filter for a line and a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Proof {
    Missed,
    /// The line meets the closed triangle at a `t` within the span.
    Hit(Span),
    Undecided,
}

/// An interval that contains an exact `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub low: f64,
    pub high: f64,
}

impl Span {
    /// The span between computed ends, widened by more than the relative error of four roundings.
    pub fn outward(low: f64, high: f64) -> Self {
        Self { low: low - low.abs() * OUTWARD, high: high + high.abs() * OUTWARD }
    }
}

/// A triple product and a bound of its error.
#[derive(Clone, Copy)]
struct TripleProduct {
    value: f64,
    error: f64,
}

impl TripleProduct {
    /// `x . cross(y, z)`: see the proof above.
    fn of(x: DVec3, y: DVec3, z: DVec3) -> Self {
        let value = x.x * (y.y * z.z - y.z * z.y) + x.y * (y.z * z.x - y.x * z.z) + x.z * (y.x * z.y - y.y * z.x);
        let (x, y, z) = (x.abs(), y.abs(), z.abs());
        let size = x.x * (y.y * z.z + y.z * z.y) + x.y * (y.z * z.x + y.x * z.z) + x.z * (y.x * z.y + y.y * z.x);
        Self { value, error: BOUND * size }
    }

    /// The sign of the true product, or `None` if the error bound leaves it uncertain.
    fn sign(self) -> Option<Ordering> {
        let is_known = self.value.abs() > self.error || self.error == 0.0;
        is_known.then(|| self.value.partial_cmp(&0.0))?
    }
}

/// Classifies the line of `ray` by the signed volumes of [`exact::hit`](crate::exact::hit). Inputs must be finite.
pub fn classify(ray: &Ray, corners: [Vec3; 3]) -> Proof {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let corners = corners.map(|p| p.as_dvec3());
    let [a, b, c] = corners.map(|p| p - origin);

    let sides = [(c, b), (a, c), (b, a)].map(|(p, q)| TripleProduct::of(direction, p, q).sign());
    if sides.contains(&Some(Ordering::Less)) && sides.contains(&Some(Ordering::Greater)) {
        return Proof::Missed;
    }

    // Compute the edges from the absolute corners, so each component has only one rounding.
    let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
    let whole = TripleProduct::of(direction, e1, e2);
    match whole.sign() {
        Some(Ordering::Equal) => Proof::Missed,
        Some(_) if !sides.contains(&None) => Proof::Hit(quotient(TripleProduct::of(a, e1, e2), whole)),
        _ => Proof::Undecided,
    }
}

/// Encloses `numerator / denominator`. The denominator is known not to be 0.
fn quotient(numerator: TripleProduct, denominator: TripleProduct) -> Span {
    let sign = denominator.value.signum();
    let (value, denominator) =
        (numerator.value * sign, TripleProduct { value: denominator.value * sign, ..denominator });
    // The bounds and quotients have one rounding each. Nothing underflows: bounds are multiples of 2^-600 below 2^391.
    let (top_low, top_high) = (value - numerator.error, value + numerator.error);
    let (small, large) = (denominator.value - denominator.error, denominator.value + denominator.error);
    let low = top_low / if top_low < 0.0 { small } else { large };
    let high = top_high / if top_high < 0.0 { large } else { small };
    Span::outward(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact;
    use crate::oracle::tests::Numbers;

    /// Checks the filter against exact sums. Returns whether the line hits, or `None` if the filter is undecided.
    fn is_confirmed(ray: &Ray, corners: [Vec3; 3]) -> Option<bool> {
        let truth = exact::hit(ray, corners);
        match classify(ray, corners) {
            Proof::Missed => assert_eq!(truth, None, "{ray:?} {corners:?}"),
            Proof::Hit(span) => {
                let t = truth.as_ref().expect("the filter has proved it");
                // The approximation has fewer roundings than `outward` allows.
                let near = Span::outward(t.approximate(), t.approximate());
                assert!(span.low <= near.high && near.low <= span.high, "{span:?} {near:?}");
            }
            Proof::Undecided => return None,
        }
        Some(truth.is_some())
    }

    #[test]
    fn proofs_of_the_filter_are_right() {
        let mut hits = 0;
        for (kind, mut numbers) in Numbers::all().enumerate() {
            let mut decided = 0;
            for _ in 0..4000 {
                let corners = std::array::from_fn(|_| numbers.point());
                let ray = Ray::new(numbers.point(), numbers.point());
                let verdict = is_confirmed(&ray, corners);
                decided += u32::from(verdict.is_some());
                hits += u32::from(verdict == Some(true));
            }
            assert!(decided > 1500, "the numbers of kind {kind} leave nearly all undecided: {decided}");
        }
        assert!(hits > 1500, "{hits}");
    }

    /// Aims rays at a corner or at the middle of an edge. The filter must be right or undecided.
    #[test]
    fn rays_at_edges_are_decided_right_or_not_at_all() {
        let mut undecided = 0;
        for mut numbers in Numbers::all() {
            for round in 0..2000 {
                let [a, b, c] = std::array::from_fn(|_| numbers.point());
                let target = if round % 2 == 0 { a } else { a * 0.5 + b * 0.5 };
                let origin = numbers.point();
                let direction = target - origin;
                if direction.is_finite() {
                    undecided += u32::from(is_confirmed(&Ray::new(origin, direction), [a, b, c]).is_none());
                }
            }
        }
        assert!(undecided > 1000, "{undecided}");
    }
}
