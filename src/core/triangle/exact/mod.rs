//! The exact triangle test.

mod enclosure;
mod exact_depth;

use std::cmp::Ordering;

use glam::Vec3;

pub use exact_depth::ExactDepth;

use super::corners::LaneCorners;
use super::filter::{CandidateBounds, Candidates, FilterBlock, FilterRay, filter_block, filter_eight};
use super::{EightHits, EightRays, TriangleTest};
use crate::exact;
use crate::geometry::{Ray, round_down, round_up};
use crate::simd::{Arithmetic, EightLanes, Kernel, LaneVec3, Lanes, Level, Portable, dispatch, each};
use enclosure::{Bounds, look, look_at_corners, place, place_closely, place_in_axis_plane};

/// The exact triangle test, with floating-point filters.
///
/// An `f32` stage with error bounds decides most triangles. An `f64` stage with error bounds decides most of the
/// remaining triangles. Exact arithmetic decides all other triangles.
///
/// A ray in the plane of a triangle misses the triangle. Any other ray hits the triangle if and only if the ray and the
/// closed triangle have a common point. Hits are ordered by exact `t`.
///
/// The returned `t` is the exact `t`, correctly rounded. If the exact `t` is just below `t_max`, the returned `t` may
/// be `t_max`.
///
/// Results may be wrong if the processor treats denormal numbers as zero.
///
/// # References
/// Filters before exact arithmetic: Fortune, Van Wyk: Efficient exact arithmetic for computational geometry. SoCG 1993.
/// Shewchuk: Adaptive precision floating-point arithmetic and fast robust geometric predicates. Discrete &
/// Computational Geometry 18, 1997. The edge test: Segura, Feito, WSCG 2001.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exact;

#[derive(Clone, Copy, Debug)]
pub struct ExactRay {
    filter: FilterRay,
    ray: Ray,
}

impl TriangleTest for Exact {
    const NAME: &'static str = "exact";
    const BATCHED: bool = true;
    const EIGHT: bool = true;

    type Ray = ExactRay;
    type Block<const N: usize> = FilterBlock<N>;
    type First<const N: usize, L: Lanes<N>> = Candidates<L>;
    type Values<const N: usize> = CandidateBounds<N>;
    type Depth<'a> = ExactDepth<'a>;

    #[inline(always)]
    fn prepare(ray: &Ray) -> ExactRay {
        ExactRay { filter: FilterRay::new(ray), ray: *ray }
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> FilterBlock<N> {
        FilterBlock::new(triangles)
    }

    /// Returns `t_max`, because the exact `t` of a hit may lie between the largest float below `t_max` and `t_max`.
    #[inline(always)]
    fn last(t_max: f32) -> f32 {
        t_max
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(
        ray: &ExactRay,
        block: &FilterBlock<N>,
        _: f32,
        to: f32,
    ) -> (u32, Candidates<L>) {
        filter_block::<N, L>(&ray.filter, block, to)
    }

    #[inline(always)]
    fn values<const N: usize, L: Lanes<N>>(first: Candidates<L>) -> CandidateBounds<N> {
        first.bounds()
    }

    #[inline(always)]
    fn decide<'a, const N: usize>(
        ray: &ExactRay,
        block: &'a FilterBlock<N>,
        lane: usize,
        bounds: &CandidateBounds<N>,
    ) -> Option<ExactDepth<'a>> {
        if let Some(decided) = Self::decide_at_once(ray, block, lane, bounds) {
            // `bounds` may come from `look_closer` instead of the filter.
            return decided.map(ExactDepth::without_filter_bounds);
        }
        let (low, high) = in_f64(&ray.ray, block.corners.place(lane), bounds.sure >> lane & 1 == 1)?;
        Some(ExactDepth::new(block.corners.place(lane), low, high).without_filter_bounds())
    }

    #[inline(always)]
    fn decide_at_once<'a, const N: usize>(
        ray: &ExactRay,
        block: &'a FilterBlock<N>,
        lane: usize,
        bounds: &CandidateBounds<N>,
    ) -> Option<Option<ExactDepth<'a>>> {
        if bounds.sure >> lane & 1 == 0 {
            return runs_along(&ray.ray, &block.corners.place(lane).corners()).then_some(None);
        }
        let (low, high, (start, end)) = (bounds.low[lane], bounds.high[lane], ray.ray.interval());
        if start <= low && high < end {
            return Some(Some(ExactDepth::new(block.corners.place(lane), low, high)));
        }
        if high < start || end <= low {
            return Some(None);
        }
        let bounds = place_in_axis_plane(&ray.ray, &block.corners.place(lane).corners())?;
        let inside = within(&ray.ray, bounds)?;
        Some(inside.map(|(low, high)| ExactDepth::new(block.corners.place(lane), low, high).without_filter_bounds()))
    }

    #[inline(always)]
    fn look_closer(
        ray: &ExactRay,
        block: &FilterBlock<8>,
        candidates: u32,
        bounds: &CandidateBounds<8>,
        nearest: Option<&ExactDepth>,
    ) -> Option<(u32, CandidateBounds<8>)> {
        dispatch(Level::current(), Crowd { ray: &ray.ray, block, candidates, bounds, nearest })
    }

    #[inline(always)]
    fn meet_eight<const N: usize, L: EightLanes>(
        rays: &EightRays<L>,
        block: &FilterBlock<N>,
        lane: usize,
        to: L,
        active: L::Mask,
    ) -> Option<EightHits<L>> {
        let (rejected, candidates) = filter_eight(rays, block, lane, to);
        if L::bits(active) & !L::bits(rejected) == 0 {
            return None;
        }
        let ([inside, certain], [low, high]) = candidates.look();
        let sure = L::both(inside[0].cmp_lt(inside[1]), certain[0].cmp_lt(certain[1]));
        let within = L::both(rays.t_min.cmp_le(low), high.cmp_lt(rays.t_max));
        let without = L::either(high.cmp_lt(rays.t_min), rays.t_max.cmp_le(low));
        let missed = L::either(rejected, L::both(sure, without));
        Some(EightHits { met: L::both(sure, within), missed, low, high })
    }

    #[inline(always)]
    fn depth_between<const N: usize>(block: &FilterBlock<N>, lane: usize, low: f32, high: f32) -> ExactDepth<'_> {
        ExactDepth::new(block.corners.place(lane), low, high)
    }

    #[inline(always)]
    fn order_closely(ray: &ExactRay, one: &ExactDepth, other: &ExactDepth) -> Ordering {
        // These copies allow the caller to keep the depths in registers.
        let (one, other) = (*one, *other);
        one.order_closely(&other, &ray.ray)
    }
}

/// Returns bounds of the exact `t`, or `None` for a miss. `met` may be true only if the line meets the triangle.
#[inline(never)]
fn in_f64(ray: &Ray, triangle: LaneCorners, met: bool) -> Option<(f32, f32)> {
    let corners = triangle.corners();
    if !met && runs_along(ray, &corners) {
        return None;
    }
    let bounds = match met {
        true => bounds_of_hit(ray, corners),
        false => look_at_corners(ray, corners).unwrap_or_else(|| look(ray, corners)),
    };
    let met = matches!(bounds, Bounds::Hit { .. });
    within(ray, bounds)
        .or_else(|| met.then(|| within(ray, place_closely(ray, corners)))?)
        .unwrap_or_else(|| exactly(ray, corners))
}

/// Returns `None` if `bounds` prove neither a hit nor a miss.
///
/// Returns `Some(None)` if `bounds` prove that the ray has no hit in the interval.
#[inline(always)]
fn within(ray: &Ray, bounds: Bounds) -> Option<Option<(f32, f32)>> {
    let (start, end) = (f64::from(ray.interval().0), ray.end());
    match bounds {
        Bounds::Miss => Some(None),
        Bounds::Hit { low, high } if start <= low && high < end => Some(Some((round_down(low), round_up(high)))),
        Bounds::Hit { low, high } if high < start || end <= low => Some(None),
        Bounds::Hit { .. } | Bounds::Unclear => None,
    }
}

struct Crowd<'a> {
    ray: &'a Ray,
    block: &'a FilterBlock<8>,
    candidates: u32,
    bounds: &'a CandidateBounds<8>,
    nearest: Option<&'a ExactDepth<'a>>,
}

impl Kernel for Crowd<'_> {
    type Output = Option<(u32, CandidateBounds<8>)>;

    #[inline(always)]
    fn run<L: EightLanes>(self) -> Option<(u32, CandidateBounds<8>)> {
        let Self { ray, block, mut candidates, bounds, nearest } = self;
        let (low, high, start) = (L::load(&bounds.low), L::load(&bounds.high), ray.interval().0);
        let near_start = low.lt(L::splat(start)) & L::splat(start).le(high);
        let unclear = near_start | nearest.map_or(0, |hit| hit.overlaps(low, high));
        if (candidates & bounds.sure & unclear).count_ones() <= 2 {
            return None;
        }
        let last = nearest.map_or(f64::INFINITY, |hit| hit.latest(ray));
        let corners = block.corners.load::<L>();
        let (placed, low, high) = place(LaneVec3::splat(ray.origin), LaneVec3::splat(ray.direction), corners);
        let known = candidates & bounds.sure & placed;
        let splat = L::Double::splat;
        candidates &= !(known & (high.lt(splat(start.into())) | splat(last).lt(low)));
        let (mut bounds, mut left) = (*bounds, candidates & known);
        let (low, high) = (low.store(), high.store());
        while left != 0 {
            let lane = left.trailing_zeros() as usize % 8;
            (bounds.low[lane], bounds.high[lane]) = (round_down(low[lane]), round_up(high[lane]));
            left &= left - 1;
        }
        Some((candidates, bounds))
    }
}

/// Whether the triangle lies in an axis-aligned plane and the ray is parallel to this plane.
#[inline(always)]
fn runs_along(ray: &Ray, [a, b, c]: &[Vec3; 3]) -> bool {
    (a.cmpeq(*b) & a.cmpeq(*c) & ray.direction.cmpeq(Vec3::ZERO)).any()
}

/// Bounds the exact `t`. The line of `ray` must meet the triangle.
#[inline(always)]
fn bounds_of_hit(ray: &Ray, corners: [Vec3; 3]) -> Bounds {
    if let Some(bounds) = place_in_axis_plane(ray, &corners) {
        return bounds;
    }
    let one = LaneVec3::<1, Portable<1>>::splat;
    match place(one(ray.origin), one(ray.direction), each(&corners, |&corner| one(corner))) {
        (0, ..) => Bounds::Unclear,
        (_, low, high) => Bounds::Hit { low: low.store()[0], high: high.store()[0] },
    }
}

#[cold]
fn exactly(ray: &Ray, corners: [Vec3; 3]) -> Option<(f32, f32)> {
    let t = exact::hit(ray, corners).filter(|t| t.is_within(ray))?.round();
    // The exact `t` lies between the two neighbours of the rounded `t`.
    Some((t.next_down(), t.next_up()))
}
