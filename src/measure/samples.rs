//! Taking samples of many cases, interleaved.

use super::warm_up::WarmUp;
use super::{Clock, RandomOrder};

/// Something to time: a batch of rays that can be made smaller.
pub trait Timed {
    /// Rays of a whole pass, at least 1.
    fn rays(&self) -> usize;

    /// From now on a pass takes `rays` of them, spread over the whole. Not timed.
    fn restrict(&mut self, rays: usize);

    /// Forgets all answers, so that a pass which does nothing is found out, and gets ready. Called before every pass. Not timed.
    fn clear(&mut self);

    /// One pass. The only call that is timed.
    fn run(&mut self);

    /// A number made of all answers of the pass. Not timed.
    fn checksum(&self) -> u64;
}

/// How samples are taken.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Samples of every case, in each epoch.
    pub runs: usize,
    /// What one sample may take, nanoseconds. A case that takes longer for all its rays runs on fewer.
    pub sample_budget_ns: u64,
    /// Passes of every case before its first sample, at least. More are run until they are [steady](WarmUp).
    pub warmup: usize,
    /// Seed of the order.
    pub seed: u64,
}

/// The samples of one case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Samples {
    /// Rays of a sample: fewer than the case has when it was slow.
    pub rays: usize,
    /// Of the answers of the first epoch; the same in every sample of it.
    pub checksum: u64,
    /// Whether structures that were built again gave the same answers.
    pub same_answers: bool,
    /// Epochs in which the case did not become steady before its samples.
    pub unsteady: usize,
    /// Nanoseconds of each sample, in the order of the rounds: those of two cases with the same index are a pair.
    pub ns: Vec<u64>,
}

impl Samples {
    /// Nanoseconds a ray, of each sample.
    pub fn ns_per_ray(&self) -> Vec<f64> {
        self.ns.iter().map(|&ns| ns.max(1) as f64 / self.rays as f64).collect()
    }
}

/// A sample without an answer is not a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("pass {pass} over the same rays gave other answers than the first one: the structure is not pure")]
pub struct UnsteadyAnswers {
    /// Number of the case.
    pub case: usize,
    /// Number of its pass, counted from 1 with the warm-up.
    pub pass: usize,
}

/// The first pass of a case takes so many rays, to find out how slow it is.
const PILOT: usize = 64;

/// Finds how many rays of each case fit `plan.sample_budget_ns`. No sample is taken yet; the numbers of rays may be changed before.
pub fn begin(clock: &dyn Clock, cases: &mut [Box<dyn Timed + '_>], plan: &Plan) -> Vec<Samples> {
    let none = |case: &mut Box<dyn Timed + '_>| {
        let rays = fit(clock, case.as_mut(), plan.sample_budget_ns);
        Samples { rays, checksum: 0, same_answers: true, unsteady: 0, ns: Vec::with_capacity(plan.runs) }
    };
    cases.iter_mut().map(none).collect()
}

/// An epoch: adds `plan.runs` samples of every case, in each round every case once, in random order, after a warm-up. `samples` are what
/// [`begin`] found, or those of earlier epochs of the same cases, whose structures have been built again. `progress` is
/// told the number of samples taken, between them.
///
/// # Errors
/// If a case gives different answers to the same rays.
///
/// # Panics
/// If there are not as many samples as cases.
pub fn take(
    clock: &dyn Clock,
    cases: &mut [Box<dyn Timed + '_>],
    plan: &Plan,
    samples: &mut [Samples],
    progress: &mut dyn FnMut(usize),
) -> Result<(), UnsteadyAnswers> {
    assert_eq!(cases.len(), samples.len(), "samples are of the same cases");
    let mut checksums = vec![];
    let mut passes = vec![];
    for (i, (case, samples)) in cases.iter_mut().zip(samples.iter_mut()).enumerate() {
        case.restrict(samples.rays);
        let mut warm_up = WarmUp::default();
        warm_up.pass(pass(clock, case.as_mut()));
        let checksum = case.checksum();
        while !warm_up.is_over(plan.warmup) {
            warm_up.pass(pass(clock, case.as_mut()));
            if case.checksum() != checksum {
                return Err(UnsteadyAnswers { case: i, pass: warm_up.passes() });
            }
        }
        if samples.ns.is_empty() {
            samples.checksum = checksum;
        }
        samples.same_answers &= samples.checksum == checksum;
        samples.unsteady += usize::from(!warm_up.is_steady());
        checksums.push(checksum);
        passes.push(warm_up.passes());
    }

    // Every epoch has an order of its own.
    let before = samples.first().map_or(0, |samples| samples.ns.len());
    let mut order = RandomOrder::new(plan.seed.wrapping_add(before as u64));
    let mut taken = 0;
    for round in 0..plan.runs {
        for i in order.shuffled(cases.len()) {
            let ns = pass(clock, cases[i].as_mut());
            if cases[i].checksum() != checksums[i] {
                return Err(UnsteadyAnswers { case: i, pass: passes[i] + round + 1 });
            }
            samples[i].ns.push(ns);
            taken += 1;
            progress(taken);
        }
    }
    Ok(())
}

/// The nanoseconds of one pass.
fn pass(clock: &dyn Clock, case: &mut dyn Timed) -> u64 {
    case.clear();
    let start = clock.now_ns();
    case.run();
    clock.now_ns() - start
}

/// How many rays of `case` take about `budget_ns`, or half of it: found by passes over more and more rays.
fn fit(clock: &dyn Clock, case: &mut dyn Timed, budget_ns: u64) -> usize {
    let all = case.rays();
    let mut rays = PILOT.min(all);
    loop {
        case.restrict(rays);
        let mut ns = pass(clock, case).max(1);
        // What seems slow may have been interrupted, or found cold caches: look again, twice.
        if rays as u128 * u128::from(budget_ns) < all as u128 * u128::from(ns) {
            ns = ns.min(pass(clock, case)).min(pass(clock, case)).max(1);
        }
        let fitting = (rays as u128 * u128::from(budget_ns) / u128::from(ns)).max(1) as usize;
        // Few rays say little of many: trust only a pass that takes a fair share of the budget.
        if rays == all || ns >= budget_ns / 4 {
            // A power of two: another run, a little faster or slower, takes the same rays.
            return if fitting >= all { all } else { 1 << fitting.ilog2() };
        }
        rays = (rays * 4).min(fitting.max(rays * 2)).min(all);
    }
}

#[cfg(test)]
mod tests;
