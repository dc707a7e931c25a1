//! Takes interleaved samples of many cases. In `measure`, a case is one structure on one workload.

use super::tiles::{last_level, level_of, rays_at};
use super::{Clock, RandomOrder, Stopwatch};

/// A case that can be timed on all rays of its workload or on subsets.
pub trait Timed {
    /// Rays of the workload, at least 1.
    fn rays(&self) -> usize;

    /// Selects the rays of later passes: the [`tiles`](super::tiles::tiles) of the first of `levels`. The rays of each
    /// further level are a subset of these rays, and the same pass measures their time. Not timed.
    fn choose(&mut self, levels: &[usize], epoch: usize);

    /// Overwrites all results: a pass that does nothing is then detected. Called before every pass. Not timed.
    fn clear(&mut self);

    /// Warms caches and branch predictors for this case. Called before a pass whose time is kept. Not timed.
    fn lead_in(&mut self);

    /// Runs one pass. Returns the nanoseconds of each chosen level.
    fn run(&mut self, watch: &Stopwatch) -> Vec<u64>;

    /// A checksum of all results of the pass. Not timed.
    fn checksum(&self) -> u64;

    /// Whether the pass and its lead-in gave the same rays different results. Not timed.
    fn contradicts_itself(&self) -> bool;
}

/// The plan of an epoch's samples.
#[derive(Clone, Copy, Debug)]
pub struct SamplePlan {
    /// Samples per case and epoch, at least 1; fewer if the budget runs out.
    pub runs: usize,
    /// Time for the samples of all cases in an epoch, ns. If it is too short, fewer samples are taken; if it is too
    /// short for one sample of each case, cases are timed on a subset of their rays, the slowest first.
    pub budget_ns: u64,
    /// A case that takes more than this multiple of the median case is timed on fewer rays, even within the budget;
    /// infinite for no limit.
    pub slowest: f64,
    /// The maximum number of rays of a sample.
    pub most_rays: usize,
    /// Seed of the order.
    pub seed: u64,
    /// The number of the epoch, from 0.
    pub epoch: usize,
}

/// The samples of one case.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Samples {
    /// Rays of a sample: all rays of the workload, or fewer if the case is slow.
    pub rays: usize,
    /// The [`checksum`](Self::checksum) covers the rays of this level in epoch 0; if `None`, the rays of the samples.
    pub checksum_level: Option<usize>,
    /// The checksum of the results; it is the same in all epochs.
    pub checksum: u64,
    /// The checksum of the results on the rays of the samples; these rays differ between epochs unless all rays are
    /// timed.
    pub timed_checksum: u64,
    /// Time of each sample, ns, in the order of the rounds: samples of two cases with the same index are a pair.
    pub ns: Vec<u64>,
    /// The times of the same samples on subsets of their rays, for comparison with slower cases.
    pub parts: Vec<SubsetSamples>,
    /// Whether the same rays had the same results every time.
    pub is_steady: bool,
}

/// The samples of a case on a subset of its rays.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SubsetSamples {
    /// Rays of the subset.
    pub rays: usize,
    /// Time of the subset in each sample, ns.
    pub ns: Vec<u64>,
}

impl Samples {
    /// Empty samples of a case with `all` rays that is timed at `level`. If the level is a subset, its rays differ
    /// between epochs, and so do the results. To make epochs comparable, each epoch also traces a sixteenth of the rays
    /// that epoch 0 times.
    pub fn none(all: usize, level: usize) -> Self {
        let checksum_level = (level > 0).then(|| (level + 2).min(last_level(all)));
        Self { rays: rays_at(all, level), checksum_level, is_steady: true, ..Self::default() }
    }
}

/// Takes the samples of one epoch: `plan.runs` of every case, each case once per round, in random order.
///
/// Cases with the same number in `compared` are compared with each other and follow one another within a round: a long
/// disturbance then affects all of them. `samples` contains the number of rays of each case. A case whose results
/// change is not run again. `progress` receives the number of samples so far, including skipped samples.
///
/// # Panics
/// If `samples` or `compared` differ in length from `cases`, or no level of a case has the number of rays in `samples`.
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

    // Every epoch has its own order.
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

/// The checksum of the results on the rays that `case` has at `level` in epoch 0.
fn checksum_at(watch: &Stopwatch, case: &mut dyn Timed, level: usize) -> u64 {
    case.choose(&[level], 0);
    case.clear();
    case.run(watch);
    case.checksum()
}

#[cfg(test)]
mod tests;
