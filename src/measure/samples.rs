//! Takes interleaved samples of many cases. A case is one structure on one workload.

use super::tiles::{last_level, level_of, rays_at};
use super::{Clock, RandomOrder, Stopwatch};

/// Only [`run`](Self::run) is timed.
pub trait Timed {
    /// Rays of the workload, at least 1.
    fn rays(&self) -> usize;

    /// Later passes trace the [`tiles`](super::tiles::tiles) of `levels[0]`. The rays of every further level must be a
    /// subset of the rays of `levels[0]`.
    fn choose(&mut self, levels: &[usize], epoch: usize);

    /// Discards the results of the previous pass, to detect a pass that writes no results. Called before every pass.
    fn clear(&mut self);

    /// Warms caches and branch predictors before a timed pass.
    fn lead_in(&mut self);

    /// Runs one pass. Returns the nanoseconds of each chosen level.
    fn run(&mut self, watch: &Stopwatch) -> Vec<u64>;

    fn checksum(&self) -> u64;

    /// Whether a ray had one result in the lead-in and another result in the pass.
    fn contradicts_itself(&self) -> bool;
}

#[derive(Clone, Copy, Debug)]
pub struct SamplePlan {
    /// The maximum number of samples per case and epoch, at least 1.
    pub runs: usize,
    /// Time for the samples of all cases in one epoch, ns. One sample per case with the fewest rays may take longer.
    pub budget_ns: u64,
    /// The maximum ratio of the time of a case to the median time. Slower cases are timed on fewer rays, even within
    /// the budget. Infinite for no limit.
    pub slowest: f64,
    pub most_rays: usize,
    pub seed: u64,
    /// The number of the epoch, from 0.
    pub epoch: usize,
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Samples {
    pub rays: usize,
    /// The [`checksum`](Self::checksum) covers the rays that epoch 0 selects at this level. `None` if the checksum
    /// covers the timed rays.
    pub checksum_level: Option<usize>,
    /// This checksum covers the same rays in every epoch.
    pub checksum: u64,
    /// This checksum covers the timed rays.
    pub timed_checksum: u64,
    /// Entry `i` of every case was measured in round `i`.
    pub ns: Vec<u64>,
    /// The times of the same samples on subsets of their rays, for comparison with slower cases.
    pub parts: Vec<SubsetSamples>,
    /// `false` if repeated passes over the same rays had different results.
    pub is_steady: bool,
}

#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SubsetSamples {
    pub rays: usize,
    pub ns: Vec<u64>,
}

impl Samples {
    /// Empty samples of a case. `all` is the number of rays of the workload.
    ///
    /// A subset differs between epochs. Every epoch therefore also traces about a sixteenth of the subset of epoch 0,
    /// for the checksum.
    pub fn none(all: usize, level: usize) -> Self {
        let checksum_level = (level > 0).then(|| (level + 2).min(last_level(all)));
        Self { rays: rays_at(all, level), checksum_level, is_steady: true, ..Self::default() }
    }
}

/// Each round takes one sample of every case, in random order.
///
/// Within a round, cases with equal numbers in `compared` are consecutive, so a long disturbance affects all of them. A
/// case whose results change is not run again. `progress` receives the number of samples so far, including skipped
/// samples.
///
/// # Panics
/// If `samples` or `compared` differ in length from `cases`. If `samples` contains a number of rays that no level has.
pub fn take(
    clock: &dyn Clock,
    cases: &mut [Box<dyn Timed + '_>],
    compared: &[usize],
    plan: &SamplePlan,
    samples: &mut [Samples],
    progress: &mut dyn FnMut(usize),
) {
    assert_eq!([cases.len(); 2], [samples.len(), compared.len()], "one entry of each per case");
    let watch = Stopwatch::new(clock);
    let mut levels_of = vec![];
    for (case, samples) in cases.iter_mut().zip(samples.iter_mut()) {
        let level_of = |rays: usize| level_of(case.rays(), rays).expect("the rays of a level");
        let mut levels = vec![level_of(samples.rays)];
        levels.extend(samples.parts.iter().map(|part| level_of(part.rays)));
        if let Some(level) = samples.checksum_level {
            samples.checksum = checksum_at(&watch, case.as_mut(), level);
            samples.is_steady = plan.epoch > 0 || samples.checksum == checksum_at(&watch, case.as_mut(), level);
        }
        levels_of.push(levels);
    }
    cases.iter_mut().zip(&levels_of).for_each(|(case, levels)| case.choose(levels, plan.epoch));

    let mut order = RandomOrder::new(plan.seed.wrapping_add(plan.epoch as u64));
    let mut checksums = vec![None; cases.len()];
    let mut taken = 0;
    for _ in 0..plan.runs {
        for i in order.shuffled_by_group(compared) {
            let (case, samples) = (&mut cases[i], &mut samples[i]);
            if samples.is_steady {
                case.clear();
                case.lead_in();
                let ns = case.run(&watch);
                let checksum = case.checksum();
                samples.is_steady = *checksums[i].get_or_insert(checksum) == checksum && !case.contradicts_itself();
                samples.timed_checksum = checksum;
                if samples.checksum_level.is_none() {
                    samples.checksum = checksum;
                }
                samples.ns.push(ns[0]);
                samples.parts.iter_mut().zip(&ns[1..]).for_each(|(part, &ns)| part.ns.push(ns));
            }
            taken += 1;
            progress(taken);
        }
    }
}

fn checksum_at(watch: &Stopwatch, case: &mut dyn Timed, level: usize) -> u64 {
    case.choose(&[level], 0);
    case.clear();
    case.run(watch);
    case.checksum()
}

#[cfg(test)]
mod tests;
