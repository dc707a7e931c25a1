use std::marker::PhantomData;

use glam::{Vec3, Vec3A};
use obvhs::ray::Ray as PreparedRay;
use obvhs::rt_triangle::RtTriangle;

use super::RtTest;
use crate::geometry::Ray;
use crate::triangle::{Depth, TriangleTest};

/// A triangle test in the format of obvhs: infinity for a miss. The test also enforces the start of the interval, which
/// obvhs' own traversals do not check.
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

    /// The `tmax` to give to obvhs for a ray with the exclusive end `t_max`: obvhs rejects hits whose rounded `t`
    /// equals its `tmax`.
    #[inline(always)]
    fn end(t_max: f32) -> f32 {
        t_max
    }

    /// The `t` of a hit, infinity for a miss.
    fn test(triangle: &Self::Triangle, ray: &PreparedRay, prepared: &Self::Ray) -> f32;
}

/// A triangle test of this crate.
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

    /// Behind the last `t`: a test that decides exactly may round a `t` before `t_max` to `t_max`.
    #[inline(always)]
    fn end(t_max: f32) -> f32 {
        T::last(t_max).next_up()
    }

    #[inline(always)]
    fn test(triangle: &T::Block<1>, ray: &PreparedRay, (asked, prepared): &Self::Ray) -> f32 {
        T::hit(prepared, triangle, ray.tmin, ray.tmax).map_or(f32::INFINITY, |depth| depth.t(asked))
    }
}

/// obvhs' own test on its precomputed triangle, called as in its documentation: its fastest configuration.
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
