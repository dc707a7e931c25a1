//! Error rates against the exact oracle.

use rayon::prelude::*;

use crate::accel::DynAccel;
use crate::geometry::Ray;
use crate::oracle::{Oracle, Truth};
use crate::validate::{DepthRule, ErrorCounts, count_errors};

/// Rays, and the exact answers to them.
pub struct Judge<'a> {
    rays: &'a [Ray],
    truths: Vec<Option<Truth>>,
}

/// Rays that are judged at least.
const FEWEST: usize = 64;

/// Rays that a thread hands over at once.
const CHUNK: usize = 1024;

/// What judging a pair may always take.
const SHORT_NS: u64 = 2_000_000_000;

impl<'a> Judge<'a> {
    /// Queries `oracle`, on all threads.
    pub fn new(rays: &'a [Ray], oracle: &Oracle) -> Self {
        let truths = rays.par_iter().map(|ray| oracle.nearest(ray)).collect();
        Self { rays, truths }
    }

    /// Judges the answers of `accel`, on all threads: to all rays, or where one takes so many picoseconds that all would
    /// take longer than the share of one of so many `pairs` in half of `budget_ns`, to as many as fit, evenly spread. How
    /// many that are no clock decides, so that another run judges the same.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;
    use crate::request::RayKind;
    use crate::scene::Builtin;

    #[test]
    fn costs_and_no_clock_decide_how_many_rays_are_judged() {
        let scene = Builtin::find("torus").unwrap().scene(None).unwrap();
        let accel = Registry::builtin().choose("sah-kd").unwrap().build(&scene.mesh).unwrap();
        let rays = RayKind::Uniform.rays(&scene, 400, 1);
        assert_eq!(rays, RayKind::Uniform.rays(&scene, 400, 1));
        let judge = Judge::new(&rays, &Oracle::new(&scene.mesh));
        let judged = |ps, budget_ns, pairs| judge.errors(accel.as_ref(), ps, budget_ns, pairs).rays;
        // Two seconds, of rays that take nothing to speak of, ten milliseconds each, or for ever; then a share of more.
        assert_eq!([1, 10_000_000_000, u64::MAX].map(|ps| judged(ps, 0, 1)), [400, 200, 64]);
        assert_eq!([1, 2, 9].map(|pairs| judged(10_000_000_000, 6_000_000_000, pairs)), [300, 200, 200]);
    }
}
