use std::marker::PhantomData;

use glam::{Vec3, Vec3A};
use obvhs::ray::Ray as PreparedRay;
use obvhs::rt_triangle::RtTriangle;

use crate::external::lanes;
use crate::geometry::Ray;
use crate::simd::Lanes;
use crate::triangle::decided_at_once::decided_at_once;
use crate::triangle::{Depth, TriangleTest};

/// A triangle test for the trees of obvhs.
pub trait LeafTest: Send + Sync + 'static {
    /// The name of the triangle test.
    const NAME: &'static str;
    /// A triangle in the format of the test.
    type Triangle: Copy + Send + Sync;
    /// The data that the test prepares once per ray.
    type Ray: Copy + Send + Sync;

    /// Prepares a triangle.
    fn triangle(corners: [Vec3; 3]) -> Self::Triangle;

    /// Prepares a ray.
    fn prepare(ray: &Ray) -> Self::Ray;

    /// Returns `tmax`, the end of the ray in the format of obvhs. `t_max` and `tmax` are exclusive.
    #[inline(always)]
    fn end(t_max: f32) -> f32 {
        t_max
    }

    /// The `t` of a hit. The result is infinity for a miss and for a hit before the interval.
    fn test(triangle: &Self::Triangle, ray: &PreparedRay, prepared: &Self::Ray) -> f32;
}

/// The triangle test `T` of this crate as a [`LeafTest`].
pub struct Over<T>(PhantomData<T>);

impl<T: TriangleTest> LeafTest for Over<T> {
    const NAME: &'static str = T::NAME;
    type Triangle = T::Block<1>;
    type Ray = (Ray, T::Ray);

    fn triangle(corners: [Vec3; 3]) -> T::Block<1> {
        T::block(&[corners])
    }

    #[inline(always)]
    fn prepare(ray: &Ray) -> Self::Ray {
        (*ray, T::prepare(ray))
    }

    /// The `t` of a hit may equal `T::last(t_max)`.
    #[inline(always)]
    fn end(t_max: f32) -> f32 {
        T::last(t_max).next_up()
    }

    #[inline(always)]
    fn test(triangle: &T::Block<1>, ray: &PreparedRay, (original, prepared): &Self::Ray) -> f32 {
        T::hit(prepared, triangle, ray.tmin, ray.tmax).map_or(f32::INFINITY, |depth| depth.t(original))
    }
}

/// The triangle test of obvhs as a [`LeafTest`].
pub struct Native;

impl LeafTest for Native {
    const NAME: &'static str = <RtTest as TriangleTest>::NAME;
    type Triangle = RtTriangle;
    type Ray = ();

    fn triangle(corners: [Vec3; 3]) -> RtTriangle {
        let [a, b, c] = corners.map(Vec3A::from);
        RtTriangle::new(a, b, c)
    }

    #[inline(always)]
    fn prepare(_: &Ray) {}

    #[inline(always)]
    fn test(triangle: &RtTriangle, ray: &PreparedRay, (): &()) -> f32 {
        triangle.intersect(ray)
    }
}

/// The triangle test of obvhs: Möller-Trumbore on precomputed edges and normal.
///
/// A barycentric coordinate of -0.0 counts as negative. Therefore the test misses some hits exactly on an edge.
#[derive(Clone, Copy, Debug, Default)]
pub struct RtTest;

impl TriangleTest for RtTest {
    const NAME: &'static str = "rt-triangle";

    type Ray = PreparedRay;
    type Block<const N: usize> = [RtTriangle; N];

    decided_at_once!();

    #[inline(always)]
    fn prepare(ray: &Ray) -> PreparedRay {
        // `candidates` checks the interval of the ray.
        PreparedRay::new(ray.origin.into(), ray.direction.into(), f32::NEG_INFINITY, f32::MAX)
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> [RtTriangle; N] {
        lanes::block(triangles, Native::triangle)
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
