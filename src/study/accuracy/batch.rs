use rayon::prelude::*;

use crate::accel::DynAccel;
use crate::geometry::Ray;
use crate::measure::Clock;
use crate::oracle::{Oracle, Truth};
use crate::validate::{DepthRule, ErrorCounts, count_errors};

/// Rays and the truth about them.
pub struct Batch {
    pub rays: Vec<Ray>,
    truths: Vec<Option<Truth>>,
}

/// Rays from which the speed of a structure is learnt, and the fewest that are judged.
const PILOT: usize = 64;

/// Rays that a thread hands over at once.
const CHUNK: usize = 1024;

impl Batch {
    /// Asks `oracle`, on all threads.
    pub fn new(rays: Vec<Ray>, oracle: &Oracle) -> Self {
        let truths = rays.par_iter().map(|ray| oracle.nearest(ray)).collect();
        Self { rays, truths }
    }

    /// Judges the answers of `accel`, on all threads: to all rays, or where that would take longer than `budget_ns` to
    /// as many as fit, evenly spread.
    pub fn judge(&self, accel: &dyn DynAccel, clock: &dyn Clock, budget_ns: u64) -> ErrorCounts {
        let all = self.rays.len();
        let pilot = PILOT.min(all);
        let start = clock.now_ns();
        let judged = self.judge_some(accel, pilot);
        let ns = (clock.now_ns() - start).max(1);
        let affordable = (pilot as u128 * u128::from(budget_ns) / u128::from(ns)).min(all as u128) as usize;
        if affordable <= pilot { judged } else { self.judge_some(accel, affordable) }
    }

    fn judge_some(&self, accel: &dyn DynAccel, count: usize) -> ErrorCounts {
        let some: Vec<usize> =
            (0..count).map(|i| (i as u128 * self.rays.len() as u128 / count as u128) as usize).collect();
        let rays: Vec<Ray> = some.iter().map(|&i| self.rays[i]).collect();
        let answers = accel.closest_by_chunks(&rays, CHUNK);
        let truths: Vec<Option<Truth>> = some.iter().map(|&i| self.truths[i].clone()).collect();
        count_errors(&truths, &answers, DepthRule::STRICT)
    }
}
