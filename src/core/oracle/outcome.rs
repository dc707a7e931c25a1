//! Classifies the differences between the hits of a structure and the exact hits.

use super::Truth;
use crate::geometry::Hit;

/// The tolerance for the depth of a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRule {
    /// The allowed relative error of a hit on one of the nearest primitives.
    right: f64,
    /// The allowed relative error of a hit on any other primitive.
    other: f64,
    /// The absolute error that is always allowed, in multiples of `ulp(t)`.
    ulps: f64,
}

impl DepthRule {
    /// The limits of the relative error are 1 % (nearest primitives) and 0.1 % (other primitives). Larger errors are
    /// visible in a picture.
    pub const COARSE: Self = Self { right: 1e-2, other: 1e-3, ulps: 0.0 };

    /// The limit of the error is the maximum of 4 ulps and `1e-6 * t`.
    pub const STRICT: Self = Self { right: 1e-6, other: 1e-6, ulps: 4.0 };

    /// Whether the depth `found` is within the tolerance. The exact depth `t` must not be negative.
    ///
    /// `right` states whether the hit is on one of the nearest primitives.
    pub fn allows(self, t: f64, found: f32, right: bool) -> bool {
        let allowed = (t * if right { self.right } else { self.other }).max(ulp(t) * self.ulps);
        // The comparison is false if `found` is NaN.
        (f64::from(found) - t).abs() <= allowed
    }
}

/// The outcome of one ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// The structure returns a miss for a ray that misses.
    RightMiss,
    /// A hit on one of the nearest primitives, at a depth within the tolerance.
    Right,
    /// The structure returns a miss for a ray that hits.
    Missed,
    /// The structure returns a hit for a ray that misses.
    FalseHit,
    /// A hit on any primitive, at a depth outside the tolerance.
    WrongDepth,
    /// A hit on a primitive that is not nearest, at a depth within the tolerance.
    WrongPrimitive,
}

/// Compares the hit `answer` of a structure with the exact hit `truth`.
pub fn outcome(truth: Option<&Truth>, answer: Option<Hit>, rule: DepthRule) -> Outcome {
    match (truth, answer) {
        (None, None) => Outcome::RightMiss,
        (Some(_), None) => Outcome::Missed,
        (None, Some(_)) => Outcome::FalseHit,
        (Some(truth), Some(hit)) => {
            let right = truth.names(hit);
            match rule.allows(truth.t.approximate(), hit.t, right) {
                false => Outcome::WrongDepth,
                true if !right => Outcome::WrongPrimitive,
                true => Outcome::Right,
            }
        }
    }
}

/// The distance between neighbouring `f32` numbers at `t`. `t` must not be negative.
pub fn ulp(t: f64) -> f64 {
    let exponent = if t > 0.0 { libm::ilogb(t).clamp(-126, 127) } else { -126 };
    libm::ldexp(1.0, exponent - 23)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use super::*;
    use crate::geometry::{Mesh, Ray};
    use crate::oracle::Oracle;

    fn truths() -> [Option<Truth>; 2] {
        let corners = |z: f32| [Vec3::new(-1.0, -1.0, z), Vec3::new(3.0, -1.0, z), Vec3::new(-1.0, 3.0, z)];
        let positions = [corners(1.0), corners(1.0001)].concat();
        let oracle = Oracle::new(&Arc::new(Mesh::new(positions, vec![[0, 1, 2], [3, 4, 5]]).unwrap()));
        [Vec3::Z, -Vec3::Z].map(|direction| oracle.nearest(&Ray::new(Vec3::ZERO, direction)))
    }

    #[test]
    fn every_answer_has_its_outcome_and_the_rules_draw_their_lines_where_they_say() {
        let [hit, none] = &truths();
        let of = |truth: &Option<Truth>, answer, rule| outcome(truth.as_ref(), answer, rule);
        assert_eq!(of(none, None, DepthRule::STRICT), Outcome::RightMiss);
        assert_eq!(of(none, Some(Hit::new(1.0, 0)), DepthRule::STRICT), Outcome::FalseHit);
        assert_eq!(of(hit, None, DepthRule::STRICT), Outcome::Missed);
        for (t, id, coarse, strict) in [
            (1.0, 0, Outcome::Right, Outcome::Right),
            (1.0, 1, Outcome::WrongPrimitive, Outcome::WrongPrimitive),
            (f32::NAN, 0, Outcome::WrongDepth, Outcome::WrongDepth),
            (1.0 + 8.0 * f32::EPSILON, 0, Outcome::Right, Outcome::Right),
            (1.0 + 9.0 * f32::EPSILON, 0, Outcome::Right, Outcome::WrongDepth),
            (0.991, 0, Outcome::Right, Outcome::WrongDepth),
            (1.011, 0, Outcome::WrongDepth, Outcome::WrongDepth),
            (1.0009, 1, Outcome::WrongPrimitive, Outcome::WrongDepth),
            (1.0011, 1, Outcome::WrongDepth, Outcome::WrongDepth),
        ] {
            let outcomes = [DepthRule::COARSE, DepthRule::STRICT].map(|rule| of(hit, Some(Hit::new(t, id)), rule));
            assert_eq!(outcomes, [coarse, strict], "{t} {id}");
        }
    }

    #[test]
    fn ulps_follow_the_float() {
        for x in [f32::from_bits(1), f32::MIN_POSITIVE, 1.0, 1.999, 2.0, 1e30] {
            assert_eq!(ulp(x.into()), f64::from(x.next_up()) - f64::from(x), "{x}");
        }
        assert_eq!(ulp(0.0), f64::from(f32::from_bits(1)));
        assert_eq!(ulp(1e300), f64::from(f32::MAX) - f64::from(f32::MAX.next_down()));
    }
}
