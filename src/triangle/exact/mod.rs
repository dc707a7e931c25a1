//! The exact test.

mod enclosure;
mod exact_depth;

use glam::Vec3;

pub use exact_depth::ExactDepth;

use super::TriangleTest;
use super::filter::{FilterBlock, FilterRay, survivors};
use crate::exact;
use crate::geometry::Ray;
use crate::simd::Lanes;
use enclosure::{Sight, look, place};

/// Exact answers at the price of a filter: what the `f32` stage cannot reject is decided in `f64` with a bound on its error, and what
/// that cannot decide in exact sums of floats.
///
/// Promises: a triangle is hit if and only if the ray as given meets the closed triangle as given; hits are ordered by their exact
/// `t`, at equal `t` by number; the `t` returned is the exact one, correctly rounded (so that one just before an open end `t_max` may be
/// returned as `t_max`). In a structure that loses nothing the answer to every ray is the mathematical one. Does not promise:
/// speed where many rays pass exactly through edges; each such triangle costs a microsecond.
///
/// # References
/// Filters before exact arithmetic: Fortune, Van Wyk: Efficient exact arithmetic for computational geometry. SoCG 1993. Shewchuk:
/// Adaptive precision floating-point arithmetic and fast robust geometric predicates. Discrete & Computational Geometry 18,
/// 1997. The edge test: Segura, Feito, WSCG 2001.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exact;

/// The ray of both stages.
#[derive(Clone, Copy, Debug)]
pub struct ExactRay {
    filter: FilterRay,
    ray: Ray,
}

impl TriangleTest for Exact {
    const NAME: &'static str = "exact";
    const BATCHED: bool = true;

    type Ray = ExactRay;
    type Block<const N: usize> = FilterBlock<N>;
    type Depth = ExactDepth;

    #[inline(always)]
    fn prepare(ray: &Ray) -> ExactRay {
        ExactRay { filter: FilterRay::new(ray), ray: *ray }
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> FilterBlock<N> {
        FilterBlock::new(triangles)
    }

    /// Hits just before `t_max` may lie beyond the last float before it.
    #[inline(always)]
    fn last(t_max: f32) -> f32 {
        t_max
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(ray: &ExactRay, block: &FilterBlock<N>, _: f32, to: f32) -> (u32, L) {
        survivors(&ray.filter, block, to)
    }

    #[inline(always)]
    fn decide<const N: usize>(ray: &ExactRay, block: &FilterBlock<N>, lane: usize, inside: f32) -> Option<ExactDepth> {
        let (ray, corners) = (&ray.ray, block.lane(lane));
        let (start, end) = (f64::from(ray.interval().0), ray.end());
        let sight = if inside > 0.0 { place(ray, corners) } else { look(ray, corners) };
        match sight {
            Sight::Miss => None,
            Sight::Hit { low, high } if start <= low && high < end => Some(ExactDepth::new(ray, corners, low, high)),
            Sight::Hit { low, high } if high < start || end <= low => None,
            Sight::Hit { .. } | Sight::Unclear => exactly(ray, corners),
        }
    }
}

/// The hit of one triangle, whatever it takes.
#[cold]
fn exactly(ray: &Ray, corners: [Vec3; 3]) -> Option<ExactDepth> {
    let t = exact::hit(ray, corners).filter(|t| t.is_within(ray))?.round();
    // Rounding is off by at most the distance to the next float.
    let (low, high) = (t.next_down(), t.next_up());
    Some(ExactDepth::new(ray, corners, low.into(), high.into()))
}
