use std::cmp::Ordering;

use crate::simd::EightLanes;

/// Where along a ray a hit is, as exactly as its triangle test knows.
pub trait Depth: Copy {
    /// The order along the ray. Those of one ray are totally ordered.
    fn order(&self, other: &Self) -> Ordering;

    /// The depth of a hit at `t`, if that is all there is to know of it.
    fn of(t: f32) -> Option<Self>;

    /// As reported: the nearest float.
    fn t(&self) -> f32;

    /// The same of eight at once.
    #[inline(always)]
    fn ts<L: EightLanes>(depths: [&Self; 8]) -> [f32; 8] {
        depths.map(Self::t)
    }

    /// A float that is not before the hit. What lies beyond it along the ray need not be looked at.
    fn bound(&self) -> f32;
}

/// What an `f32` test computes, which is never NaN.
impl Depth for f32 {
    #[inline(always)]
    fn of(t: f32) -> Option<f32> {
        Some(t)
    }

    #[inline(always)]
    fn order(&self, other: &Self) -> Ordering {
        self.partial_cmp(other).unwrap_or(Ordering::Equal)
    }

    #[inline(always)]
    fn t(&self) -> f32 {
        *self
    }

    #[inline(always)]
    fn bound(&self) -> f32 {
        *self
    }
}
