use glam::Vec3;

use super::filter::{FilterBlock, FilterRay, survivors};
use super::{Corners, MollerTrumboreF64, TriangleTest};
use crate::geometry::Ray;
use crate::simd::Lanes;

/// [`MollerTrumboreF64`] behind a first stage in `f32` that rejects nearly all triangles: the same hits, bit for bit.
///
/// Promises and does not promise what that test does. Costs little more than Möller-Trumbore in `f32`, because only a triangle or two a
/// ray come to the second stage.
#[derive(Clone, Copy, Debug, Default)]
pub struct FilteredF64;

/// Both stages' ray, and its interval.
#[derive(Clone, Copy, Debug)]
pub struct FilteredRay {
    filter: FilterRay,
    ray: Ray,
}

impl TriangleTest for FilteredF64 {
    const NAME: &'static str = "filtered-f64";
    const BATCHED: bool = true;

    type Ray = FilteredRay;
    type Block<const N: usize> = FilterBlock<N>;
    type Depth = f32;

    #[inline(always)]
    fn prepare(ray: &Ray) -> FilteredRay {
        FilteredRay { filter: FilterRay::new(ray), ray: *ray }
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> FilterBlock<N> {
        FilterBlock::new(triangles)
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(ray: &FilteredRay, block: &FilterBlock<N>, _: f32, to: f32) -> (u32, L) {
        survivors(&ray.filter, block, to)
    }

    #[inline(always)]
    fn decide<const N: usize>(ray: &FilteredRay, block: &FilterBlock<N>, lane: usize, _: f32) -> Option<f32> {
        let (t_min, t_max) = ray.ray.interval();
        let triangle = Corners::new(&[block.lane(lane)]);
        MollerTrumboreF64::hit(&MollerTrumboreF64::prepare(&ray.ray), &triangle, t_min, Self::last(t_max))
    }
}
