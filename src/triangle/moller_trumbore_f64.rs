use glam::Vec3;

use super::moller_trumbore::solve;
use super::{Corners, TriangleTest};
use crate::geometry::Ray;
use crate::simd::{Arithmetic, LaneVec3, Lanes};

/// [`MollerTrumbore`](super::MollerTrumbore) in `f64` over corners in `f32`; `t` is rounded to `f32` at the end.
///
/// Promises: `t` within half an ulp except for rays that graze by less than 1e-9; no sign is wrong unless the ray passes an edge
/// within some 1e-15 of the scene's size, at any scale of `f32`. Does not promise closed meshes to be closed: a ray exactly through
/// an edge may be lost. Costs about twice the `f32` test in blocks.
///
/// # References
/// As [`MollerTrumbore`](super::MollerTrumbore).
#[derive(Clone, Copy, Debug, Default)]
pub struct MollerTrumboreF64;

impl TriangleTest for MollerTrumboreF64 {
    const NAME: &'static str = "moller-trumbore-f64";

    type Ray = (Vec3, Vec3);
    type Block<const N: usize> = Corners<N>;
    type Depth = f32;

    #[inline(always)]
    fn prepare(ray: &Ray) -> Self::Ray {
        (ray.origin, ray.direction)
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> Corners<N> {
        Corners::new(triangles)
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(
        &(origin, direction): &Self::Ray,
        block: &Corners<N>,
        from: f32,
        to: f32,
    ) -> (u32, L) {
        let [a, b, c] = block.load::<L>().map(LaneVec3::widen);
        let wide = |v| LaneVec3::<N, L>::splat(v).widen();
        let (inside, t) = solve(wide(direction), wide(origin) - a, [b - a, c - a]);
        // The beginning before rounding, which may make a zero of what lies behind.
        let inside = inside & L::splat(from).widen().le(t);
        let t = L::narrow(t);
        (inside & t.le(L::splat(to)), t)
    }

    #[inline(always)]
    fn decide<const N: usize>(_: &Self::Ray, _: &Self::Block<N>, _: usize, t: f32) -> Option<f32> {
        Some(t)
    }
}
