//! Blocks of triangles, for triangle tests that accept one triangle per call.

use glam::Vec3;

use crate::simd::{Lanes, indexed};

/// Unused lanes get triangles without area.
pub(super) fn block<B, const N: usize>(triangles: &[[Vec3; 3]], make: impl Fn([Vec3; 3]) -> B) -> [B; N] {
    assert!(triangles.len() <= N, "a block of {N} lanes cannot hold {} triangles", triangles.len());
    std::array::from_fn(|lane| make(triangles.get(lane).copied().unwrap_or_default()))
}

/// Returns one bit per lane and the `t` of each lane. The bit of a lane is set if its `t` is finite
/// and `from` <= `t` <= `to`. The closure `t` must return infinity for a miss.
#[inline(always)]
pub(super) fn candidates<const N: usize, L: Lanes<N>>(from: f32, to: f32, t: impl Fn(usize) -> f32) -> (u32, L) {
    let t = L::load(&indexed(t));
    (L::splat(from).le(t) & t.le(L::splat(to.min(f32::MAX))), t)
}
