//! Triangle tests for all structures.
//!
//! To add a test, implement [`TriangleTest`] in a file of this folder. Then add the test to `offered.rs`,
//! `validate/reference.rs`, `Registry::builtin` and `triangle/tests/every.rs`.

#[macro_use]
pub(crate) mod decided_at_once;

mod baldwin_weber;
mod corners;
mod depth;
mod edge_f64;
mod eight_rays;
mod exact;
mod filter;
mod moller_trumbore;
mod moller_trumbore_f64;
mod plucker;
#[cfg(test)]
pub(crate) mod tests;
mod watertight;

use std::cmp::Ordering;

use glam::Vec3;

pub use baldwin_weber::BaldwinWeber;
pub use corners::Corners;
pub(crate) use depth::last_bits;
pub use depth::{BETWEEN_BOUNDS, DIRECTION, Depth, INPUTS, ORIGIN};
pub use edge_f64::EdgeF64;
pub use eight_rays::{EightHits, EightRays};
pub use exact::Exact;
pub use moller_trumbore::MollerTrumbore;
pub use moller_trumbore_f64::MollerTrumboreF64;
pub use plucker::Plucker;
pub use watertight::Watertight;

use crate::geometry::Ray;
use crate::simd::{EightLanes, Lanes, Portable};

/// The number of triangles in a leaf block.
pub(crate) const BLOCK: usize = 8;

/// Decides whether and where a ray intersects a triangle.
///
/// The first stage tests all triangles of a block at once. The second stage tests the remaining candidates one by one.
/// Results must be bitwise equal for all block sizes.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a triangle test",
    label = "does not implement `TriangleTest` (`sahara_core::triangle::TriangleTest`)",
    note = "use a test of that module, for example `Exact`",
    note = "a private triangle test needs no `TriangleTest`: keep the default `Accel::TRIANGLE_TEST`"
)]
pub trait TriangleTest: Send + Sync + 'static {
    /// The name on the command line and in exports.
    const NAME: &'static str;

    /// A prepared ray.
    type Ray: Copy + Send + Sync;

    /// `N` triangles, prepared for the test.
    type Block<const N: usize>: Copy + Send + Sync;

    /// The intermediate results of the first stage.
    type First<const N: usize, L: Lanes<N>>: Copy;

    /// The values that the first stage passes to the second stage.
    type Values<const N: usize>: Copy;

    /// The position of a hit along the ray.
    type Depth<'a>: Depth;

    /// Prepares a [valid](Ray::is_valid) ray.
    fn prepare(ray: &Ray) -> Self::Ray;

    /// Packs the corners of at most `N` triangles into a block. Rays never hit unused lanes.
    ///
    /// # Panics
    /// If there are more than `N` triangles.
    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> Self::Block<N>;

    /// An upper bound of the `t` of hits, for a valid ray whose interval ends at `t_max`.
    ///
    /// The default is the largest float below `t_max`. The default suits tests that compare a rounded `t`.
    #[inline(always)]
    fn last(t_max: f32) -> f32 {
        // This equals `next_down`, because the `t_max` of a valid ray is positive.
        f32::from_bits(t_max.to_bits().wrapping_sub(1))
    }

    /// The first stage. The bits of the first result mark the lanes that the ray may hit at a `t` in [`from`, `to`].
    ///
    /// The second result is the input of [`values`](Self::values). The second result is meaningless if the first is 0.
    fn candidates<const N: usize, L: Lanes<N>>(
        ray: &Self::Ray,
        block: &Self::Block<N>,
        from: f32,
        to: f32,
    ) -> (u32, Self::First<N, L>);

    /// The values for the second stage.
    fn values<const N: usize, L: Lanes<N>>(first: Self::First<N, L>) -> Self::Values<N>;

    /// The second stage. Returns the depth of a hit within the ray's interval, or `None`.
    ///
    /// The hit may lie beyond the `to` of the first stage.
    fn decide<'a, const N: usize>(
        ray: &Self::Ray,
        block: &'a Self::Block<N>,
        lane: usize,
        values: &Self::Values<N>,
    ) -> Option<Self::Depth<'a>>;

    /// A version of [`decide`](Self::decide) to inline. `None` means that the caller must call `decide`.
    ///
    /// The values must come from [`values`](Self::values), not from [`look_closer`](Self::look_closer).
    #[inline(always)]
    fn decide_at_once<'a, const N: usize>(
        ray: &Self::Ray,
        block: &'a Self::Block<N>,
        lane: usize,
        values: &Self::Values<N>,
    ) -> Option<Option<Self::Depth<'a>>> {
        Self::ONE_STAGE.then(|| Self::decide(ray, block, lane, values))
    }

    /// Refines many candidates at once. Returns the remaining candidates and the values for [`decide`](Self::decide).
    ///
    /// Returns `None` if refining would not save time. May remove candidates beyond `nearest`.
    #[inline(always)]
    fn look_closer(
        _ray: &Self::Ray,
        _block: &Self::Block<8>,
        _candidates: u32,
        _values: &Self::Values<8>,
        _nearest: Option<&Self::Depth<'_>>,
    ) -> Option<(u32, Self::Values<8>)> {
        None
    }

    /// The total order of two hits of `ray`.
    #[inline(always)]
    fn order<'a>(ray: &Self::Ray, one: &Self::Depth<'a>, other: &Self::Depth<'a>) -> Ordering {
        one.order(other).unwrap_or_else(|| Self::order_closely(ray, one, other))
    }

    /// The order of two hits for which [`Depth::order`] returns `None`.
    ///
    /// A test must implement this function if [`Depth::order`] can return `None`.
    fn order_closely(_ray: &Self::Ray, _one: &Self::Depth<'_>, _other: &Self::Depth<'_>) -> Ordering {
        unreachable!("a test whose depths may be unordered implements `order_closely`")
    }

    /// Whether the first stage decides all hits.
    ///
    /// If true, [`decide`](Self::decide) and [`Depth::of`] must never return `None`.
    const ONE_STAGE: bool = false;

    /// Whether structures can trace several rays at once with this test. The code for this takes most of the compile
    /// time.
    const BATCHED: bool = false;

    /// Whether the test implements [`meet_eight`](Self::meet_eight).
    const EIGHT: bool = false;

    /// Runs the first stage for eight rays and the triangle in `lane` of a block.
    ///
    /// Finds hits of the `active` rays at a `t` up to `to`. May return `None` if all `active` rays miss.
    #[inline(always)]
    fn meet_eight<const N: usize, L: EightLanes>(
        _rays: &EightRays<L>,
        _block: &Self::Block<N>,
        _lane: usize,
        _to: L,
        _active: L::Mask,
    ) -> Option<EightHits<L>> {
        unreachable!("a test with `EIGHT` implements `meet_eight`")
    }

    /// The depth of a hit of [`meet_eight`](Self::meet_eight) with a `t` in [`low`, `high`].
    ///
    /// Required if [`EIGHT`](Self::EIGHT) is true and [`Depth::of`] returns `None`.
    #[inline(always)]
    fn depth_between<const N: usize>(_block: &Self::Block<N>, _lane: usize, _low: f32, _high: f32) -> Self::Depth<'_> {
        unreachable!("a test whose `Depth::of` is `None` implements `depth_between`")
    }

    /// Runs both stages for a single triangle.
    #[inline(always)]
    fn hit<'a>(ray: &Self::Ray, triangle: &'a Self::Block<1>, from: f32, to: f32) -> Option<Self::Depth<'a>> {
        let (candidate, first) = Self::candidates::<1, Portable<1>>(ray, triangle, from, to);
        if candidate == 0 { None } else { Self::decide(ray, triangle, 0, &Self::values(first)) }
    }
}

/// The `t` at which `ray` hits the triangle within the ray's interval. Returns `None` for a miss or an invalid ray.
pub fn scalar_hit<T: TriangleTest>(ray: &Ray, corners: [Vec3; 3]) -> Option<f32> {
    let (t_min, t_max) = ray.interval();
    let triangle = T::block(&[corners]);
    let hit = || T::hit(&T::prepare(ray), &triangle, t_min, T::last(t_max));
    ray.is_valid().then(hit)?.map(|depth| depth.t(ray))
}
