//! Compares hits with the exact oracle, for the study `accuracy`.

use std::hint::black_box;
use std::slice;

use rayon::prelude::*;

use crate::accel::DynAccel;
use crate::geometry::Ray;
use crate::measure::Clock;
use crate::oracle::DepthRule;
use crate::oracle::{Oracle, Truth};
use crate::validate::{ErrorCounts, count_errors};

pub struct Judge<'a> {
    rays: &'a [Ray],
    truths: Vec<Option<Truth>>,
}

/// The minimum number of judged rays.
const FEWEST: usize = 64;

/// Rays per task of the thread pool.
const CHUNK: usize = 1024;

/// The minimum time budget for judging one structure on one workload.
const SHORT_NS: u64 = 2_000_000_000;

impl<'a> Judge<'a> {
    pub fn new(rays: &'a [Ray], oracle: &Oracle) -> Self {
        let truths = rays.par_iter().map(|ray| oracle.nearest(ray)).collect();
        Self { rays, truths }
    }

    /// `ps` is the predicted time per ray in picoseconds. `pairs` is the number of pairs of structure and workload. The
    /// pairs share half of `budget_ns`. The number of rays depends on no clock, so every run judges the same rays.
    pub fn errors(&self, accel: &dyn DynAccel, ps: u64, budget_ns: u64, pairs: usize) -> ErrorCounts {
        let share_ns = (budget_ns / 2 / pairs.max(1) as u64).max(SHORT_NS);
        let all = self.rays.len();
        let affordable = u128::from(share_ns) * 1000 / u128::from(ps.max(1));
        let count = affordable.clamp(FEWEST.min(all) as u128, all as u128) as usize;
        let some: Vec<usize> = (0..count).map(|i| (i as u128 * all as u128 / count as u128) as usize).collect();
        let rays: Vec<Ray> = some.iter().map(|&i| self.rays[i]).collect();
        let answers = accel.closest_by_chunks(&rays, CHUNK);
        let truths: Vec<Option<Truth>> = some.iter().map(|&i| self.truths[i].clone()).collect();
        count_errors(&truths, &answers, DepthRule::STRICT)
    }
}

/// The number of timings per ray. The minimum is used, because a disturbance rarely slows every timing.
const PASSES: usize = 3;

/// The time of the slowest ray, ns.
pub fn slowest(accel: &dyn DynAccel, rays: &[Ray], clock: &dyn Clock) -> u64 {
    let mut least = vec![u64::MAX; rays.len()];
    for _ in 0..PASSES {
        for (ray, least) in rays.iter().zip(&mut least) {
            let start = clock.now_ns();
            black_box(accel.closest(slice::from_ref(ray)));
            *least = (*least).min(clock.now_ns() - start);
        }
    }
    least.into_iter().max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin::Builtin;
    use crate::registry::Registry;
    use crate::request::RayKind;

    #[test]
    fn costs_and_no_clock_decide_how_many_rays_are_judged() {
        let scene = Builtin::find("torus").unwrap().scene(None).unwrap();
        let accel = Registry::builtin().choose("sah-kd").unwrap().build(&scene.mesh).unwrap();
        let rays = RayKind::Uniform.rays(&scene, 400, 1);
        assert_eq!(rays, RayKind::Uniform.rays(&scene, 400, 1));
        let judge = Judge::new(&rays, &Oracle::new(&scene.mesh));
        let judged = |ps, budget_ns, pairs| judge.errors(accel.as_ref(), ps, budget_ns, pairs).rays;
        // The budget of a pair is at least 2 s.
        assert_eq!([1, 10_000_000_000, u64::MAX].map(|ps| judged(ps, 0, 1)), [400, 200, 64]);
        assert_eq!([1, 2, 9].map(|pairs| judged(10_000_000_000, 6_000_000_000, pairs)), [300, 200, 200]);
    }
}
