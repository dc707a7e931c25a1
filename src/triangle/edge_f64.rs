use glam::Vec3;

use super::plucker::solve;
use super::{Corners, TriangleTest};
use crate::geometry::Ray;
use crate::simd::{Arithmetic, LaneVec3, Lanes};

/// The edge test of [`Plucker`](super::Plucker) in `f64` over corners in `f32`: scalar triple products for the sides, `t` from the
/// plane equation relative to the origin, rounded to `f32` at the end.
///
/// Promises what [`Plucker`](super::Plucker) does, closed edges included, at every scale of `f32`, and `t` within half an ulp except
/// for rays that graze by less than 1e-9. Does not promise: a ray exactly through a vertex may be lost. Costs about 2.5 times
/// Möller-Trumbore in `f32`.
///
/// # References
/// As [`Plucker`](super::Plucker).
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeF64;

impl TriangleTest for EdgeF64 {
    const NAME: &'static str = "edge-f64";

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
        let wide = |v| LaneVec3::<N, L>::splat(v).widen();
        let (inside, t) = solve(wide(origin), wide(direction), block.load::<L>().map(LaneVec3::widen));
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
