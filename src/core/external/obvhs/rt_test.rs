use glam::{Vec3, Vec3A};
use obvhs::ray::Ray as PreparedRay;
use obvhs::rt_triangle::RtTriangle;

use crate::external::lanes;
use crate::geometry::Ray;
use crate::simd::Lanes;
use crate::triangle::TriangleTest;
use crate::triangle::decided_at_once::decided_at_once;

/// The triangle test of obvhs: Möller-Trumbore on precomputed edges and normal, 64 bytes per triangle.
///
/// Wrapped as a test of this crate, which makes brute force over it a reference for the BVHs that use it. It reads
/// signs from the sign bit of rounded quotients. Therefore it misses hits exactly on an edge if a barycentric
/// coordinate is -0.0: on edges seen from the back, and on the third edge also from the front.
#[derive(Clone, Copy, Debug, Default)]
pub struct RtTest;

impl TriangleTest for RtTest {
    const NAME: &'static str = "rt-triangle";

    type Ray = PreparedRay;
    type Block<const N: usize> = [RtTriangle; N];

    decided_at_once!();

    #[inline(always)]
    fn prepare(ray: &Ray) -> PreparedRay {
        // Use the whole line: the caller checks the interval.
        PreparedRay::new(ray.origin.into(), ray.direction.into(), f32::NEG_INFINITY, f32::MAX)
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> [RtTriangle; N] {
        lanes::block(triangles, |corners| {
            let [a, b, c] = corners.map(Vec3A::from);
            RtTriangle::new(a, b, c)
        })
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(
        ray: &PreparedRay,
        block: &[RtTriangle; N],
        from: f32,
        to: f32,
    ) -> (u32, L) {
        lanes::candidates(from, to, |lane| block[lane].intersect(ray))
    }
}
