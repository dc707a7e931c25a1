//! The filter: one ray and one triangle in `f64`, with a proven error bound.
//!
//! # Proof
//! Let `u` = 2^-53. The numbers are finite `f32`, hence exact in `f64`. Write `a`, `b`, `c` for the corners relative to
//! the origin of the ray; each of their components is one subtraction, that is, the true one times (1 + e), |e| <= u.
//!
//! *Nothing overflows, nothing underflows.* A component of `a`, of an edge or of the direction is 0 or between 2^-149
//! and 2^129 in magnitude. Every rounded product of two is a multiple of 2^-350 (it is at least 2^-298, and has 53
//! bits), and so is the difference of two such products, which hence is 0 or at least 2^-350; times a third component,
//! at least 2^-499. Everything is below 2^(129 + 129 + 129 + 3) = 2^390. All of this is far from the ends of `f64`,
//! 2^-1022 and 2^1024, so that every operation has a relative error of at most `u`, and a product is 0 only if a factor
//! is.
//!
//! *A triple product* `x . (y z)` is the sum of six terms `x_i y_j z_k`. On its way into the sum, a term is multiplied
//! by at most eight factors (1 + e): one a component for its subtraction (3), the two products (2), the difference of
//! two (1), the sum of three (2). So the computed sum is off by at most g P, where P is the sum of the magnitudes of
//! the six true terms and g = 8u / (1 - 8u) (Higham 2002, section 3.1). The same sum of magnitudes, computed by the
//! same operations, is at least (1 - g) P. Hence the error is at most g / (1 - g) times the *computed* sum of
//! magnitudes, which is less than 16 u times it. The product by 16 u, a power of two, is exact.
//!
//! # References
//! Shewchuk: Adaptive precision floating-point arithmetic and fast robust geometric predicates. 1997 (the idea of the
//! filter). Higham: Accuracy and stability of numerical algorithms. 2nd ed. 2002.

use glam::{DVec3, Vec3};

use crate::geometry::Ray;

/// 16 u.
const BOUND: f64 = 16.0 / (1u64 << 53) as f64;

/// 8 u, relative: more than four roundings can do.
const OUTWARD: f64 = 8.0 / (1u64 << 53) as f64;

/// What is proven about a ray and a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Proof {
    Missed,
    /// The line meets the closed triangle, at a `t` within the span.
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
    /// From ends that are off by at most four roundings each, relative to themselves.
    pub fn outward(low: f64, high: f64) -> Self {
        Self { low: low - low.abs() * OUTWARD, high: high + high.abs() * OUTWARD }
    }

    /// The `f32` nearest to the `t` inside, if all numbers of the span have the same: rounding is monotonic.
    pub fn rounded(self) -> Option<f32> {
        let (low, high) = (self.low as f32, self.high as f32);
        // Zero is positive, as where exact parameters are rounded.
        (low == high).then_some(low + 0.0)
    }
}

#[derive(Clone, Copy)]
struct Estimate {
    value: f64,
    error: f64,
}

impl Estimate {
    /// `x . (y z)`: see the proof above.
    fn triple(x: DVec3, y: DVec3, z: DVec3) -> Self {
        let value = x.x * (y.y * z.z - y.z * z.y) + x.y * (y.z * z.x - y.x * z.z) + x.z * (y.x * z.y - y.y * z.x);
        let (x, y, z) = (x.abs(), y.abs(), z.abs());
        let size = x.x * (y.y * z.z + y.z * z.y) + x.y * (y.z * z.x + y.x * z.z) + x.z * (y.x * z.y + y.y * z.x);
        Self { value, error: BOUND * size }
    }

    fn is_positive(self) -> bool {
        self.value > self.error
    }

    fn is_negative(self) -> bool {
        -self.value > self.error
    }

    fn is_zero(self) -> bool {
        self.error == 0.0
    }

    fn is_known(self) -> bool {
        self.is_positive() || self.is_negative() || self.is_zero()
    }
}

/// Classifies the whole line of `ray` by the three volumes of [`exact::hit`](crate::exact::hit), and encloses `t`. All
/// numbers must be finite.
pub fn classify(ray: &Ray, corners: [Vec3; 3]) -> Proof {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let corners = corners.map(|p| p.as_dvec3());
    let [a, b, c] = corners.map(|p| p - origin);

    let sides = [(c, b), (a, c), (b, a)].map(|(p, q)| Estimate::triple(direction, p, q));
    if sides.iter().any(|s| s.is_positive()) && sides.iter().any(|s| s.is_negative()) {
        return Proof::Missed;
    }
    let known = sides.iter().all(|s| s.is_known());

    // The edges are taken of the corners themselves: each component is then one rounding away from the true one.
    let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
    let whole = Estimate::triple(direction, e1, e2);
    if whole.is_zero() {
        return Proof::Missed;
    }
    if !known || !whole.is_known() {
        return Proof::Undecided;
    }
    Proof::Hit(quotient(Estimate::triple(a, e1, e2), whole))
}

/// Encloses `numerator / denominator`, whose denominator is known not to be 0.
fn quotient(numerator: Estimate, denominator: Estimate) -> Span {
    let sign = denominator.value.signum();
    let (value, denominator) = (numerator.value * sign, Estimate { value: denominator.value * sign, ..denominator });
    // Each of these is one rounding away from what it should be, each quotient one more: together three. None is 0
    // unless it should be: they are multiples of 2^-700.
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

    /// Checks what the filter proves with exact sums; returns whether it is a hit, or none if nothing is proven.
    fn is_confirmed(ray: &Ray, corners: [Vec3; 3]) -> Option<bool> {
        let truth = exact::hit(ray, corners);
        match classify(ray, corners) {
            Proof::Missed => assert_eq!(truth, None, "{ray:?} {corners:?}"),
            Proof::Hit(span) => {
                let t = truth.as_ref().expect("the filter has proven it");
                // The approximation is two roundings better than the span is wide.
                let near = Span::outward(t.approximate(), t.approximate());
                assert!(span.low <= near.high && near.low <= span.high, "{span:?} {near:?}");
                assert!(span.rounded().is_none_or(|rounded| rounded == t.round()), "{span:?} {t:?}");
            }
            Proof::Undecided => return None,
        }
        Some(truth.is_some())
    }

    #[test]
    fn what_the_filter_proves_is_so() {
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
            assert!(decided > 1500, "the numbers of kind {kind} leave nearly everything undecided: {decided}");
        }
        assert!(hits > 1500, "{hits}");
    }

    /// Rays at a corner or along an edge: what cannot be decided must not be guessed.
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

    #[test]
    fn a_span_that_is_narrow_is_rounded() {
        assert_eq!(Span::outward(0.1, 0.1).rounded(), Some(0.1));
        assert_eq!(Span::outward(-0.0, 0.0).rounded().map(f32::to_bits), Some(0));
        // Half way between two floats.
        let half = 1.0 + f64::from(f32::EPSILON) * 0.5;
        assert_eq!(Span::outward(half, half).rounded(), None);
        assert_eq!(Span::outward(1e39, 1e40).rounded(), Some(f32::INFINITY));
    }
}
