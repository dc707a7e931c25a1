//! Decides how many rays and samples each case (one structure on one workload) gets.

use super::tiles::{last_level, level_within, rays_at};
use super::{SamplePlan, Stopwatch, Timed, median};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Rays of the workload, at least 1.
    pub rays: usize,
    /// Picoseconds per ray.
    pub ps: u64,
    /// Cases of one group are timed on equally many rays.
    pub group: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Allotment {
    pub runs: usize,
    /// The [level](super::tiles) of each case.
    pub levels: Vec<usize>,
    /// The time limit for one sample of a case with unknown cost, ns.
    pub share_ns: u64,
}

/// The result does not depend on `plan.epoch` or `plan.seed`.
pub fn allot(cases: &[Cost], plan: &SamplePlan) -> Allotment {
    let mut levels: Vec<usize> = cases.iter().map(|case| level_within(case.rays, plan.most_rays)).collect();
    let cost = |case: usize, level: usize| {
        let Cost { rays, ps, .. } = cases[case];
        // The lead-in, which warms the caches, adds an eighth to the cost.
        (rays_at(rays, level) as u128 * u128::from(ps) * 9 / 8 / 1000) as u64
    };

    let mut runs = plan.runs;
    let middle = loop {
        let costs: Vec<u64> = levels.iter().enumerate().map(|(case, &level)| cost(case, level)).collect();
        let total = costs.iter().fold(0_u64, |total, &ns| total.saturating_add(ns));
        let fits = total.saturating_mul(runs as u64) <= plan.budget_ns;
        let middle = median(&costs.iter().map(|&ns| ns as f64).collect::<Vec<_>>()).unwrap_or(0.0);
        let smaller = (0..costs.len()).filter(|&case| levels[case] < last_level(cases[case].rays));
        let slowest = smaller.max_by_key(|&case| costs[case]);
        match slowest {
            Some(case) if (!fits && runs == 1) || costs[case] as f64 > plan.slowest * middle => {
                let alike = |&other: &usize| cases[other].group == cases[case].group;
                (0..levels.len()).filter(alike).for_each(|other| levels[other] = levels[case].max(levels[other]));
                (0..levels.len()).filter(alike).for_each(|other| levels[other] += 1);
            }
            _ if fits || runs == 1 => break middle,
            _ => runs = (plan.budget_ns / total.max(1)).clamp(1, runs as u64 - 1) as usize,
        }
    };
    let slowest_ns = if middle > 0.0 { (plan.slowest * middle) as u64 } else { u64::MAX };
    let share_ns = slowest_ns.min(plan.budget_ns / (runs * cases.len().max(1)) as u64);
    Allotment { runs, levels, share_ns }
}

/// A pilot is a pass that measures the cost per ray. [`pilot_level`] selects at least this many rays if the workload
/// has enough rays.
const PILOT: usize = 64;

/// A pilot that takes this long measures the cost per ray accurately enough.
const LONG_PILOT_NS: u64 = 5_000_000;

pub fn pilot_level(rays: usize) -> usize {
    (0..=last_level(rays)).rev().find(|&level| rays_at(rays, level) >= PILOT).unwrap_or(0)
}

/// The smallest level number, at least `from`, at which a sample takes at most `most_ns`. If samples take longer at
/// every level, the result is the last level.
pub fn level_by_clock(watch: &Stopwatch, case: &mut dyn Timed, from: usize, most_ns: u64) -> usize {
    let all = case.rays();
    let mut pace = |level: usize| {
        case.choose(&[level], 0);
        case.clear();
        let ns = case.run(watch)[0].max(1);
        (u128::from(ns) * 1000 / rays_at(all, level) as u128).max(1)
    };
    // If the first pilot is too short for a good estimate, a longer pilot follows.
    let few = pilot_level(all).max(from);
    let first = pace(few);
    let rays = u128::from(LONG_PILOT_NS) * 1000 / first;
    let enough = (from..few).rev().find(|&level| rays_at(all, level) as u128 >= rays).unwrap_or(from);
    let ps = if enough < few && rays > rays_at(all, few) as u128 { pace(enough) } else { first };
    // A sample also includes the rays of the next level, because another epoch may use the next level.
    // 19 / 8 = 1 (timed pass) + 1 (warm-up pass) + 1 / 4 (next level) + 1 / 8 (lead-in).
    let fits = |level: &usize| rays_at(all, *level) as u128 * ps * 19 / 8 / 1000 <= u128::from(most_ns);
    let last = last_level(all);
    (from..last).find(fits).unwrap_or(last.max(from))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAN: SamplePlan =
        SamplePlan { runs: 5, budget_ns: 0, slowest: 8.0, most_rays: usize::MAX, seed: 3, epoch: 0 };

    fn cases(ns: &[u64]) -> Vec<Cost> {
        ns.iter().enumerate().map(|(group, ns)| Cost { rays: 65_536, ps: 1000 * ns, group }).collect()
    }

    fn rays(cases: &[Cost], plan: &SamplePlan) -> (usize, Vec<usize>) {
        let Allotment { runs, levels, .. } = allot(cases, plan);
        (runs, levels.iter().map(|&level| rays_at(65_536, level)).collect())
    }

    #[test]
    fn the_slow_do_with_fewer_rays_then_all_with_fewer_samples_and_then_with_fewer_rays() {
        let of = |budget_ns| rays(&cases(&[10, 15, 10_000]), &SamplePlan { budget_ns, ..PLAN });
        // With all rays and lead-ins, the two fast cases would take 1.84 ms together. With all rays and a lead-in, the
        // slow case would take 737 ms.
        assert_eq!(of(4_000_000_000), (5, vec![65_536, 65_536, 256]));
        assert_eq!(of(24_000_000), (5, vec![65_536, 65_536, 256]));
        assert_eq!(of(12_000_000), (2, vec![65_536, 65_536, 256]));
        assert_eq!(of(2_700_000), (1, vec![65_536, 65_536, 64]));
        assert_eq!(of(1_000_000), (1, vec![16_384, 4096, 64]));
        let patient = SamplePlan { slowest: f64::INFINITY, budget_ns: 1_000_000_000, ..PLAN };
        assert_eq!(rays(&cases(&[10, 15, 10_000]), &patient), (1, vec![65_536; 3]));
        assert_eq!(of(1), (1, vec![rays_at(65_536, last_level(65_536)); 3]));
        assert!(allot(&[], &PLAN).levels.is_empty());
    }

    #[test]
    fn no_more_rays_are_timed_than_asked_for_and_alike_cases_take_as_many() {
        let plan = SamplePlan { most_rays: 20_000, budget_ns: 30_000_000, ..PLAN };
        let mut cases = cases(&[10, 900, 10]);
        assert_eq!(rays(&cases, &plan).1, [16_384, 1024, 16_384]);
        cases[1].group = 0;
        assert_eq!(rays(&cases, &plan).1, [1024, 1024, 16_384]);
    }

    #[test]
    fn what_is_not_known_gets_a_share_of_the_budget_and_no_more_than_the_slowest_may_take() {
        let share =
            |slowest, budget_ns| allot(&cases(&[100, 100]), &SamplePlan { slowest, budget_ns, ..PLAN }).share_ns;
        // At 100 ns per ray, 65,536 rays with a lead-in take 7.37 ms.
        assert_eq!(share(4.0, u64::MAX), 4 * 7_372_800);
        assert_eq!(share(f64::INFINITY, 1_000_000_000), 100_000_000);
        assert_eq!(share(f64::INFINITY, u64::MAX), u64::MAX / 10);
    }
}
