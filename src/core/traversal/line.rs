//! Crossings of a ray with axis-aligned planes, with slack against rounding.

use glam::Vec3A;

use crate::geometry::{Aabb, Ray};
use crate::simd::{Lanes, each};

/// The line of a ray, prepared to compute crossings with axis-aligned planes.
///
/// **Slack.** Let o and d be the components of the ray's origin and direction along one axis. The crossing with the
/// plane at s is computed as `(s - o) * (1 / d)`, with three roundings. The relative error is at most 3.01 * 2^-24. If
/// the product underflows, the absolute error is at most 2^-148. [`before`] and [`after`] move a crossing by 8 * 2^-24
/// of its value and by 2^-126. After rounding, more than 6.9 * 2^-24 remain, which is more than twice the error. Hence
/// the slack covers the errors of two compared crossings. The sign of a crossing is exact, because a difference of
/// floats has the exact sign.
///
/// **Undefined crossings.** A ray parallel to a plane and outside it has an infinite crossing, which compares
/// correctly. If the ray lies in a plane, the crossing with this plane is NaN. If `1 / d` overflows or is subnormal,
/// all crossings on this axis are NaN. If any `s - o` may overflow, all crossings are NaN. Traversals treat NaN as a
/// crossing at an unknown `t`.
///
/// **Ends of the interval.** An interval may end at the `t` of a hit. The triangle test may have rounded this `t` down.
/// The relative error of this rounding is at most 2^-24. The slack of [`before`] also covers this error.
///
/// **Overflow.** Let M be the largest float. A crossing is computed as infinity only if its exact value exceeds
/// (1 - 2.6 * 2^-24) M. An infinite entry would be beyond every finite end. Traversals therefore limit entries with
/// [`finite_entry`], or raise ends with [`open_end`] or [`after`], which turn every end above (1 - 7.5 * 2^-24) M into
/// infinity. An infinite exit is correct.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    origin: [f32; 3],
    inverse: [f32; 3],
    backward: [bool; 3],
}

const TINY: f32 = f32::MIN_POSITIVE;
const AFTER: f32 = 1.0 + 4.0 * f32::EPSILON;
const BEFORE: f32 = 1.0 - 4.0 * f32::EPSILON;

/// If the computed crossing `t` is finite and not negative, the result is not after the exact crossing.
#[inline(always)]
pub(crate) fn before(t: f32) -> f32 {
    t * BEFORE - TINY
}

/// If the computed crossing `t` is not negative, the result is not before the exact crossing.
#[inline(always)]
pub(crate) fn after(t: f32) -> f32 {
    t * AFTER + TINY
}

/// The largest finite result of [`before`].
const LATEST: f32 = f32::MAX * BEFORE - TINY;

/// Limits an entry to the largest finite result of [`before`].
#[inline(always)]
pub(crate) fn finite_entry(t: f32) -> f32 {
    if t < LATEST { t } else { LATEST }
}

/// Replaces an end `t` near the largest float by infinity.
#[inline(always)]
pub(crate) fn open_end(t: f32) -> f32 {
    if t < LATEST { t } else { f32::INFINITY }
}

#[inline(always)]
pub(crate) fn lanes_after<L: Lanes<8>>(t: L) -> L {
    t.mul(L::splat(AFTER)).add(L::splat(TINY))
}

/// The result is infinite for an empty box.
pub(crate) fn farthest(bounds: &Aabb) -> Vec3A {
    Vec3A::from(bounds.min.abs().max(bounds.max.abs()))
}

/// Subnormal and overflowed inverses become NaN. The inverse of 0 is infinite.
///
/// `farthest` must be an upper bound of the magnitudes of all plane coordinates. If the difference of a plane and the
/// origin may overflow, all inverses are NaN.
#[inline(always)]
pub(crate) fn inverses(ray: &Ray, farthest: Vec3A) -> [f32; 3] {
    let (origin, direction) = ray.vectors();
    if !(origin.abs() + farthest).is_finite() {
        return [f32::NAN; 3];
    }
    let inverse = direction.recip();
    let size = inverse.abs();
    let is_normal = size.cmpge(Vec3A::splat(f32::MIN_POSITIVE)) & size.cmplt(Vec3A::INFINITY);
    Vec3A::select(is_normal | direction.cmpeq(Vec3A::ZERO), inverse, Vec3A::NAN).to_array()
}

impl Line {
    /// Crossings are valid only with planes that intersect `bounds`.
    #[inline(always)]
    pub fn new(ray: &Ray, bounds: &Aabb) -> Self {
        let backward = each(&ray.direction.to_array(), |x| x.is_sign_negative());
        Self { origin: ray.origin.to_array(), inverse: inverses(ray, farthest(bounds)), backward }
    }

    /// The result is NaN if the crossing is undefined, see [`Line`].
    #[inline(always)]
    pub fn crossing(&self, axis: usize, split: f32) -> f32 {
        (split - self.origin[axis]) * self.inverse[axis]
    }

    #[inline(always)]
    pub fn backward(&self, axis: usize) -> bool {
        self.backward[axis]
    }

    /// Clips [`t0`, `t1`] to the closed box `cell`, with slack. `None` proves that the line misses the box in this
    /// interval.
    ///
    /// `t0` must not be negative. `t1` must be a result of [`open_end`] or [`after`]. A NaN crossing does not change
    /// the interval.
    #[inline(always)]
    pub fn clip(&self, cell: &Aabb, mut t0: f32, mut t1: f32) -> Option<(f32, f32)> {
        for axis in 0..3 {
            let (low, high) = (self.crossing(axis, cell.min[axis]), self.crossing(axis, cell.max[axis]));
            let (near, far) = if self.backward[axis] { (high, low) } else { (low, high) };
            // `before` keeps a negative entry below `t0`. If the computed exit is negative, the exact exit is also
            // negative. Without slack, a ray that leaves a flat floor from just above misses the floor's box.
            let (near, far) = (before(near), if far < 0.0 { far } else { after(far) });
            t0 = if near > t0 { near } else { t0 };
            t1 = if far < t1 { far } else { t1 };
        }
        (t0 <= t1).then_some((t0, t1))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn unit_box() -> Aabb {
        Aabb { min: Vec3::ZERO, max: Vec3::ONE }
    }

    fn clip(origin: [f32; 3], direction: [f32; 3]) -> Option<(f32, f32)> {
        let ray = Ray::new(origin.into(), direction.into());
        Line::new(&ray, &unit_box()).clip(&unit_box(), 0.0, f32::MAX)
    }

    #[test]
    fn rays_in_faces_edges_and_corners_are_inside() {
        for zero in [0.0, -0.0] {
            for y in [0.0, 0.5, 1.0] {
                for z in [0.0, 0.5, 1.0] {
                    let (t0, t1) = clip([-2.0, y, z], [1.0, zero, zero]).expect("the box is closed");
                    assert!(t0 <= 2.0 && t1 >= 3.0, "{y} {z}: {t0} {t1}");
                    assert!(clip([4.0, y, z], [-1.0, zero, zero]).is_some());
                }
            }
            assert_eq!(clip([-2.0, 1.0f32.next_up(), 0.5], [1.0, zero, zero]), None);
            assert_eq!(clip([-2.0, -f32::MIN_POSITIVE, 0.5], [1.0, zero, zero]), None);
        }
        assert!(clip([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]).is_some(), "through the corners");
        assert_eq!(clip([2.0, 0.5, 0.5], [1.0, 0.0, 0.0]), None, "the box lies behind");
        for least in [1e-45, 1e-40, 1e-30] {
            assert_eq!(clip([-least, 0.5, 0.5], [-1.0, 0.0, 0.0]), None, "the box lies {least} behind");
            assert!(clip([-least, 0.5, 0.5], [1.0, 0.0, 0.0]).is_some(), "the box begins {least} ahead");
        }
    }

    #[test]
    fn inverses_are_those_of_each_axis() {
        let numbers =
            [0.0, 1e-45, 2.9e-39, f32::MIN_POSITIVE, 1e-20, 1.0, -3.0, 8.6e37, f32::MAX, f32::INFINITY, f32::NAN];
        let signed: Vec<f32> = numbers.iter().flat_map(|&x| [x, -x]).collect();
        let boxes = [unit_box(), Aabb::EMPTY, Aabb { min: Vec3::splat(-3e38), max: Vec3::ZERO }];
        let naive = |ray: &Ray, bounds: &Aabb| -> [f32; 3] {
            let reach = |axis: usize| ray.origin[axis].abs() + bounds.min[axis].abs().max(bounds.max[axis].abs());
            let known = (0..3).all(|axis| reach(axis).is_finite());
            let inverse = |axis: usize| 1.0 / ray.direction[axis];
            let usable = |axis: usize| inverse(axis).is_normal() || ray.direction[axis] == 0.0;
            [0, 1, 2].map(|axis| if known && usable(axis) { inverse(axis) } else { f32::NAN })
        };
        for (i, &x) in signed.iter().enumerate() {
            for (k, &y) in signed.iter().enumerate() {
                let z = signed[(7 * i + 5 * k) % signed.len()];
                for origin in [Vec3::ZERO, Vec3::new(y, 1.0, -2.0), Vec3::new(1.0, -3e38, 2.0)] {
                    for bounds in &boxes {
                        for ray in [Ray::new(origin, Vec3::new(x, y, z)), Ray::new(origin, Vec3::new(z, y, x))] {
                            let bits = |inverses: [f32; 3]| inverses.map(|i| if i.is_nan() { 0 } else { i.to_bits() });
                            let found = bits(inverses(&ray, farthest(bounds)));
                            assert_eq!(found, bits(naive(&ray, bounds)), "{ray:?} {bounds:?}");
                        }
                    }
                }
            }
        }
    }

    /// `least` is in units of 2^-24.
    #[test]
    fn the_slack_is_more_than_two_crossings_are_off() {
        let mut least = f64::INFINITY;
        for i in 0..200_000_u32 {
            let t = f32::from_bits((1 + i % 253) << 23 | i.wrapping_mul(2_654_435_761) >> 9);
            let units = |moved: f32| (f64::from(moved) / f64::from(t) - 1.0).abs() * f64::from(1 << 24);
            assert!(before(t) < t && t < after(t), "{t:e}");
            least = least.min(units(before(t))).min(units(after(t)));
        }
        assert!(least > 2.0 * 3.01, "{least}");
    }

    #[test]
    fn crossings_that_overflow_are_on_the_right_side() {
        let below = |x: f32, ulps: u32| f32::from_bits(x.to_bits() - ulps);
        let mut infinite = 0;
        for i in 0..40_000_u32 {
            let d = below(2.0_f32.powi(-28), i.wrapping_mul(2_654_435_761) >> 12);
            let exact = f64::from(f32::MAX) * (1.0 - f64::from(i % 100) * 0.1 * 2.0_f64.powi(-24));
            let origin = 1e29 * (i % 7) as f32;
            let split = (f64::from(origin) + exact * f64::from(d)) as f32;
            let exact = (f64::from(split) - f64::from(origin)) / f64::from(d);
            let crossing = (split - origin) * (1.0 / d);
            infinite += u32::from(crossing == f32::INFINITY);
            assert!(f64::from(finite_entry(before(crossing))) < exact && f64::from(after(crossing)) > exact);
            let end = exact as f32;
            for end in [end, end.next_down()].into_iter().filter(|&end| end < f32::INFINITY) {
                assert!(before(crossing) <= open_end(end) && before(crossing) <= after(end), "{exact:e} {crossing:e}");
            }
        }
        assert!(infinite > 500, "{infinite}");
        assert_eq!((before(f32::MAX), open_end(below(LATEST, 1))), (LATEST, below(LATEST, 1)));
    }

    #[test]
    fn undefined_crossings_keep_the_interval() {
        assert_eq!(clip([-2.0, 0.5, 0.5], [1e-40, 0.0, 0.0]), Some((0.0, f32::MAX)));
        assert!(clip([0.5, 0.5, 0.5], [1e-40, 1e-42, -1e-41]).is_some());
        let large = Aabb { min: Vec3::splat(-3e37), max: Vec3::splat(3e37) };
        let ray = Ray::new(Vec3::new(-3.39e38, 0.0, 0.0), Vec3::new(1e38, 0.0, 0.0));
        assert_eq!(Line::new(&ray, &large).clip(&large, 0.0, f32::MAX), Some((0.0, f32::MAX)));
        assert_eq!(clip([-2.0, 0.5, 0.5], [3e38, 0.0, 0.0]), Some((0.0, f32::MAX)));
    }
}
