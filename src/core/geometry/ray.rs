//! Rays and hits.

use std::num::NonZeroU32;

use glam::{Vec3, Vec3A, Vec4};

/// The points `origin + t * direction` with `t_min <= t < t_max`.
///
/// `t` is measured in lengths of `direction`. A negative `t_min` counts as 0. A point whose exact `t` rounds to an
/// infinite `f32` is not on the ray.
///
/// A ray hits nothing in each of these cases:
/// - The origin or the direction is not finite.
/// - The direction is zero.
/// - The interval is empty.
/// - `t_min` or `t_max` is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct Ray {
    /// The point at `t` = 0.
    pub origin: Vec3,
    /// Start of the interval, inclusive.
    pub t_min: f32,
    /// The direction, of any length except 0.
    pub direction: Vec3,
    /// End of the interval, exclusive.
    pub t_max: f32,
}

const _: () = assert!(size_of::<Ray>() == 32);

/// 2^128 - 2^103, the smallest number that rounds to an infinite `f32`.
const UNREPRESENTABLE: f64 = f32::MAX as f64 + (1_u128 << 103) as f64;

impl Ray {
    /// A ray with the interval [0, infinity).
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, t_min: 0.0, direction, t_max: f32::INFINITY }
    }

    /// Replaces `t_max`.
    pub fn until(self, t_max: f32) -> Self {
        Self { t_max, ..self }
    }

    /// The start and the end of the interval that queries search. A negative `t_min` counts as 0.
    #[inline(always)]
    pub fn interval(&self) -> (f32, f32) {
        (if self.t_min > 0.0 { self.t_min } else { 0.0 }, self.t_max)
    }

    /// The exclusive upper limit of the exact `t`.
    ///
    /// If `t_max` is infinite, the limit is 2^128 - 2^103, the smallest number that rounds to an infinite `f32`.
    #[inline(always)]
    pub fn end(&self) -> f64 {
        f64::from(self.t_max).min(UNREPRESENTABLE)
    }

    /// Whether the ray can hit anything. Every structure returns a miss for an invalid ray.
    #[inline(always)]
    pub fn is_valid(&self) -> bool {
        let (origin, direction) = self.vectors();
        let finite = (origin.is_finite_mask() & direction.is_finite_mask()).all();
        // `lasts` is false if `t_min` or `t_max` is NaN.
        let lasts = (0.0 < self.t_max) & (self.t_min < self.t_max);
        finite & direction.cmpne(Vec3A::ZERO).any() & lasts
    }

    /// Returns the origin and the direction.
    ///
    /// Four adjacent fields are loaded with one instruction. A conversion from `Vec3` to `Vec3A` would need several
    /// instructions.
    #[inline(always)]
    pub(crate) fn vectors(&self) -> (Vec3A, Vec3A) {
        let Self { origin: o, t_min, direction: d, t_max } = *self;
        (Vec3A::from_vec4(Vec4::new(o.x, o.y, o.z, t_min)), Vec3A::from_vec4(Vec4::new(d.x, d.y, d.z, t_max)))
    }

    /// The rounded point at `t`.
    #[inline(always)]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// The index of a triangle in its mesh.
///
/// The field stores `!index`, which is never 0. An `Option<Hit>` therefore takes 8 bytes.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct PrimId(NonZeroU32);

impl PrimId {
    /// # Panics
    /// If `index` is `u32::MAX`.
    #[inline(always)]
    pub fn new(index: u32) -> Self {
        Self(NonZeroU32::new(!index).expect("a primitive number is below u32::MAX"))
    }

    /// The index, below `u32::MAX`.
    #[inline(always)]
    pub fn index(self) -> u32 {
        !self.0.get()
    }
}

impl std::fmt::Debug for PrimId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{}", self.index())
    }
}

/// The triangle that a ray hits, and the ray parameter of the hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter, in lengths of the ray's direction.
    pub t: f32,
    /// The triangle that the ray hits.
    pub prim: PrimId,
}

const _: () = assert!(size_of::<Option<Hit>>() == 8);

impl Hit {
    /// A hit of triangle `index` at `t`.
    ///
    /// # Panics
    /// If `index` is `u32::MAX`.
    #[inline(always)]
    pub fn new(t: f32, index: u32) -> Self {
        Self { t, prim: PrimId::new(index) }
    }

    /// Whether both hits have the same primitive and the same `t`, bit for bit.
    pub fn same_bits(self, other: Hit) -> bool {
        self.t.to_bits() == other.t.to_bits() && self.prim == other.prim
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_is_valid_when_all_its_numbers_are() {
        let numbers = [0.0, -0.0, 1e-45, -1.0, 2.0, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        let mut valid = 0;
        for case in 0..9usize.pow(4) {
            let pick = |place: u32| numbers[case / 9usize.pow(place) % 9];
            let (a, b, c, d) = (pick(0), pick(1), pick(2), pick(3));
            let rays = [
                ([a, b, 1.0], 0.0, [c, 1.0, d], 1.0),
                ([1.0, c, d], -1.0, [a, b, 0.0], f32::INFINITY),
                ([0.0; 3], 0.0, [a, b, c], d),
                ([a, 0.0, 0.0], b, [0.0, c, 0.0], d),
            ];
            for (origin, t_min, direction, t_max) in rays {
                let ray = Ray { origin: origin.into(), t_min, direction: direction.into(), t_max };
                let finite = origin.iter().chain(&direction).all(|x| x.is_finite());
                let moves = direction.iter().any(|&x| x != 0.0);
                let expected = finite && moves && !t_min.is_nan() && t_min.max(0.0) < t_max;
                assert_eq!(ray.is_valid(), expected, "{ray:?}");
                valid += u32::from(expected);
            }
        }
        assert!(valid > 1000, "{valid}");
    }
}
