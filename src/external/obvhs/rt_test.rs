use std::array;

use glam::{Vec3, Vec3A};
use obvhs::ray::Ray as PreparedRay;
use obvhs::rt_triangle::RtTriangle;

use crate::geometry::Ray;
use crate::simd::Lanes;
use crate::triangle::TriangleTest;

/// The triangle test of obvhs: Möller-Trumbore on precomputed edges and normal, 64 bytes a triangle.
///
/// Wrapped as a test of ours, so that brute force over it can be the reference of the BVHs that use it. It tells signs by the
/// sign bit of rounded quotients, and so misses hits exactly on an edge where a coordinate comes out as -0.0, from the back
/// and on the third edge also from the front.
#[derive(Clone, Copy, Debug, Default)]
pub struct RtTest;

impl TriangleTest for RtTest {
    const NAME: &'static str = "rt-triangle";

    type Ray = PreparedRay;
    type Block<const N: usize> = [RtTriangle; N];
    type First<const N: usize, L: Lanes<N>> = L;
    type Values<const N: usize> = [f32; N];
    type Depth<'a> = f32;

    #[inline(always)]
    fn prepare(ray: &Ray) -> PreparedRay {
        // The whole line, so that the interval is the caller's business.
        PreparedRay::new(ray.origin.into(), ray.direction.into(), f32::NEG_INFINITY, f32::MAX)
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> [RtTriangle; N] {
        assert!(triangles.len() <= N, "a block of {N} lanes cannot hold {} triangles", triangles.len());
        array::from_fn(|lane| match triangles.get(lane) {
            Some(corners) => {
                let [a, b, c] = corners.map(Vec3A::from);
                RtTriangle::new(a, b, c)
            }
            None => RtTriangle::new(Vec3A::ZERO, Vec3A::ZERO, Vec3A::ZERO),
        })
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(
        ray: &PreparedRay,
        block: &[RtTriangle; N],
        from: f32,
        to: f32,
    ) -> (u32, L) {
        let t = L::load(&array::from_fn(|lane| block[lane].intersect(ray)));
        (L::splat(from).le(t) & t.le(L::splat(to.min(f32::MAX))), t)
    }

    #[inline(always)]
    fn values<const N: usize, L: Lanes<N>>(t: L) -> [f32; N] {
        t.store()
    }

    #[inline(always)]
    fn decide<const N: usize>(_: &PreparedRay, _: &[RtTriangle; N], lane: usize, t: &[f32; N]) -> Option<f32> {
        Some(t[lane])
    }
}
