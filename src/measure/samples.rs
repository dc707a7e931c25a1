//! Taking samples of many cases, interleaved.

use super::tiles::{last_level, level_of, rays_at};
use super::{Clock, RandomOrder, Stopwatch};

/// Something to time: a workload of which a part can be timed.
pub trait Timed {
    /// Rays of the workload, at least 1.
    fn rays(&self) -> usize;

    /// From now on a pass takes the rays of the first of `levels`; those of the others are a part of them and are timed
    /// along. Which rays these are, [`tiles`](super::tiles::tiles) says. Not timed.
    fn choose(&mut self, levels: &[usize], epoch: usize);

    /// Forgets all answers, so that a pass which does nothing is found out. Called before every pass. Not timed.
    fn clear(&mut self);

    /// Brings caches and predictors into the state that the case leaves them in. Called before a pass whose time is kept.
    /// Not timed.
    fn lead_in(&mut self);

    /// One pass: nanoseconds of each level chosen.
    fn run(&mut self, watch: &Stopwatch) -> Vec<u64>;

    /// A number made of all answers of the pass. Not timed.
    fn checksum(&self) -> u64;

    /// Whether the pass answered otherwise than its lead-in, to the same rays. Not timed.
    fn contradicts_itself(&self) -> bool;
}

/// How samples are taken.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Samples of every case in an epoch, at least 1; at most, where there is not time for them all.
    pub runs: usize,
    /// What the samples of all cases in an epoch may take together, nanoseconds. Where it is not enough, there are
    /// fewer samples, and where one of each case is too much, cases are timed on a part of their rays, the slowest
    /// first.
    pub budget_ns: u64,
    /// A case that takes more than so many times as long as the median case is timed on fewer rays, whatever the
    /// budget; infinite where none is.
    pub slowest: f64,
    /// Rays of a sample, at most.
    pub most_rays: usize,
    /// Seed of the order.
    pub seed: u64,
    /// Counted from 0.
    pub epoch: usize,
}

/// The samples of one case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Samples {
    /// Rays of a sample: fewer than the case has when it was slow.
    pub rays: usize,
    /// The level of the rays of the first epoch whose answers are kept, if they are not those of the samples.
    pub asked: Option<usize>,
    /// Of the answers to these rays: another epoch gives the same.
    pub checksum: u64,
    /// Nanoseconds of each sample, in the order of the rounds: those of two cases with the same index are a pair.
    pub ns: Vec<u64>,
    /// The same samples, for a part of their rays: as many as a slower case with the same rays is timed on.
    pub parts: Vec<Part>,
    /// Whether the same rays had the same answers every time: a sample without an answer is not a measurement.
    pub is_steady: bool,
}

/// A part of the samples of a case.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Rays of it.
    pub rays: usize,
    /// Nanoseconds that they took of each sample.
    pub ns: Vec<u64>,
}

impl Samples {
    /// Of a case with `all` rays that is timed at `level`, before the first one is taken. Each epoch has tiles of its own: a sixteenth
    /// of those of the first tells whether answers are the same.
    pub fn none(all: usize, level: usize) -> Self {
        let asked = (level > 0).then(|| (level + 2).min(last_level(all)));
        Self { rays: rays_at(all, level), asked, checksum: 0, ns: vec![], parts: vec![], is_steady: true }
    }

    /// Nanoseconds a ray, of each sample.
    pub fn ns_per_ray(&self) -> Vec<f64> {
        self.ns.iter().map(|&ns| ns.max(1) as f64 / self.rays as f64).collect()
    }
}

/// An epoch: adds `plan.runs` samples of every case, in each round every case once, in random order, those that are
/// compared one after the other: what disturbs them lasts, and is in all of them. `compared` has a number for each
/// case, the same for those that are compared. `samples` say on how many rays. A case that is not steady is asked no
/// more. `progress` is told the number of samples taken, those left out included, between them.
///
/// # Panics
/// If there are not as many samples or numbers as cases, or the samples are of numbers of rays that are no level's.
pub fn take(
    clock: &dyn Clock,
    cases: &mut [Box<dyn Timed + '_>],
    compared: &[usize],
    plan: &Plan,
    samples: &mut [Samples],
    progress: &mut dyn FnMut(usize),
) {
    assert_eq!([cases.len(); 2], [samples.len(), compared.len()], "samples are of the same cases");
    let watch = Stopwatch::new(clock);
    let mut levels_of = vec![];
    for (case, samples) in cases.iter_mut().zip(samples.iter_mut()) {
        let level_of = |rays: usize| level_of(case.rays(), rays).expect("a part is as large as a level");
        let mut levels = vec![level_of(samples.rays)];
        levels.extend(samples.parts.iter().map(|part| level_of(part.rays)));
        if let Some(level) = samples.asked {
            samples.checksum = ask_some(&watch, case.as_mut(), level);
            samples.is_steady = plan.epoch > 0 || samples.checksum == ask_some(&watch, case.as_mut(), level);
        }
        levels_of.push(levels);
    }
    cases.iter_mut().zip(&levels_of).for_each(|(case, levels)| case.choose(levels, plan.epoch));

    // Every epoch has an order of its own.
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
                if samples.asked.is_none() {
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

/// The checksum of the rays that `case` is timed on in the first epoch at `level`.
fn ask_some(watch: &Stopwatch, case: &mut dyn Timed, level: usize) -> u64 {
    case.choose(&[level], 0);
    case.clear();
    case.run(watch);
    case.checksum()
}

#[cfg(test)]
mod tests;
