//! Intersects one line with one triangle in `f64`, with a proven error bound.
//!
//! # Proof
//! Let u = 2^-53. The inputs are finite `f32` numbers, which `f64` represents exactly.
//!
//! *Range.* All bounds in this paragraph are bounds of magnitudes. A component of a vector is 0 or at least 2^-149. A
//! rounded product of two components is 0 or at least 2^-298. A rounded product has at most 53 bits, so it is a
//! multiple of 2^-350. The difference of two rounded products is also such a multiple, so it is 0 or at least 2^-350.
//! The product of this difference and a third component is 0 or at least 2^-499. All values are below 2^390. So no
//! operation overflows or underflows, and every operation has a relative error of at most u.
//!
//! *Error bound.* A triple product `x . cross(y, z)` is the sum of six terms `x_i y_j z_k`. Rounding multiplies each
//! term by at most eight factors (1 + e) with |e| <= u: three for the subtractions of its components, two for products,
//! three for sums. Let P be the sum of the magnitudes of the terms. Let g = 8u / (1 - 8u). The error of the computed
//! triple product is at most g P (Higham 2002, section 3.1). The computed sum of magnitudes is at least (1 - g) P.
//! Hence the error is at most 16u times the computed sum of magnitudes. The multiplication by 16u is exact, because 16u
//! is a power of two.
//!
//! # References
//! Shewchuk: Adaptive precision floating-point arithmetic and fast robust geometric predicates. 1997 (the idea of the
//! filter). Higham: Accuracy and stability of numerical algorithms. 2nd ed. 2002.

use std::cmp::Ordering;

use glam::{DVec3, Vec3};

use crate::geometry::Ray;

/// The factor 16u of the proof above.
const BOUND: f64 = 16.0 / (1u64 << 53) as f64;

/// The factor 8u that widens a span. The relative error of `ExactT::approximate` is below 8u. `quotient` rounds four
/// times per end of a span, including the widening. The relative errors of these roundings add up to less than 8u.
const OUTWARD: f64 = 8.0 / (1u64 << 53) as f64;

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
    pub fn outward(low: f64, high: f64) -> Self {
        Self { low: low - low.abs() * OUTWARD, high: high + high.abs() * OUTWARD }
    }
}

#[derive(Clone, Copy)]
struct TripleProduct {
    value: f64,
    error: f64,
}

impl TripleProduct {
    fn of(x: DVec3, y: DVec3, z: DVec3) -> Self {
        let value = x.x * (y.y * z.z - y.z * z.y) + x.y * (y.z * z.x - y.x * z.z) + x.z * (y.x * z.y - y.y * z.x);
        let (x, y, z) = (x.abs(), y.abs(), z.abs());
        let size = x.x * (y.y * z.z + y.z * z.y) + x.y * (y.z * z.x + y.x * z.z) + x.z * (y.x * z.y + y.y * z.x);
        Self { value, error: BOUND * size }
    }

    fn sign(self) -> Option<Ordering> {
        // If the error bound is 0, all six terms are exactly 0, because no product underflows.
        let is_known = self.value.abs() > self.error || self.error == 0.0;
        is_known.then(|| self.value.partial_cmp(&0.0))?
    }
}

/// Tests the line of `ray` in `f64`, by the rules of [`exact::hit`](crate::exact::hit). All inputs must be finite.
pub fn classify(ray: &Ray, corners: [Vec3; 3]) -> Proof {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let corners = corners.map(|p| p.as_dvec3());
    let [a, b, c] = corners.map(|p| p - origin);

    let sides = [(c, b), (a, c), (b, a)].map(|(p, q)| TripleProduct::of(direction, p, q).sign());
    if sides.contains(&Some(Ordering::Less)) && sides.contains(&Some(Ordering::Greater)) {
        return Proof::Missed;
    }

    // Subtract the original corners. Differences of `a`, `b` and `c` would be rounded twice; the proof permits once.
    let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
    let whole = TripleProduct::of(direction, e1, e2);
    match whole.sign() {
        Some(Ordering::Equal) => Proof::Missed,
        Some(_) if !sides.contains(&None) => Proof::Hit(quotient(TripleProduct::of(a, e1, e2), whole)),
        _ => Proof::Undecided,
    }
}

/// `denominator.sign()` must be `Some(Less)` or `Some(Greater)`.
fn quotient(numerator: TripleProduct, denominator: TripleProduct) -> Span {
    let sign = denominator.value.signum();
    let (value, denominator) =
        (numerator.value * sign, TripleProduct { value: denominator.value * sign, ..denominator });
    // Each of the four bounds is rounded once. Each quotient is rounded once. The magnitude of a nonzero bound is
    // between 2^-600 and 2^391, so no quotient underflows.
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

    fn is_confirmed(ray: &Ray, corners: [Vec3; 3]) -> Option<bool> {
        let truth = exact::hit(ray, corners);
        match classify(ray, corners) {
            Proof::Missed => assert_eq!(truth, None, "{ray:?} {corners:?}"),
            Proof::Hit(span) => {
                let t = truth.as_ref().expect("the filter has proved it");
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
