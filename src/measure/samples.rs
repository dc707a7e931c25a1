//! Taking samples of many cases, interleaved.

use super::tiles::{last_level, level_of, level_within, rays_at};
use super::{Clock, RandomOrder, Stopwatch, median};

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
    /// Of the answers to these rays; where they are tiles, to a few of those of the first epoch.
    pub checksum: u64,
    /// Whether structures that were built again gave the same answers.
    pub same_answers: bool,
    /// Nanoseconds of each sample, in the order of the rounds: those of two cases with the same index are a pair.
    pub ns: Vec<u64>,
    /// The same samples, for a part of their rays: as many as a slower case with the same rays is timed on.
    pub parts: Vec<Part>,
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
    /// Of a case that is timed on `rays` rays, before the first one is taken.
    pub fn none(rays: usize) -> Self {
        Self { rays, checksum: 0, same_answers: true, ns: vec![], parts: vec![] }
    }

    /// Nanoseconds a ray, of each sample.
    pub fn ns_per_ray(&self) -> Vec<f64> {
        self.ns.iter().map(|&ns| ns.max(1) as f64 / self.rays as f64).collect()
    }
}

/// A sample without an answer is not a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("asked the same rays again, it gave other answers: the structure is not pure")]
pub struct UnsteadyAnswers {
    /// Number of the case.
    pub case: usize,
}

/// The first pass of a case takes so many rays at least, to find out how slow it is.
const PILOT: u64 = 64;

/// A pass that takes so long says enough of the speed.
const LONG_PILOT_NS: u64 = 5_000_000;

/// Finds how many rays of each case and how many samples fit the budget; cases of equal `groups` get as many rays. No
/// sample is taken yet.
pub fn begin(
    clock: &dyn Clock,
    cases: &mut [Box<dyn Timed + '_>],
    groups: &[usize],
    plan: &Plan,
) -> (usize, Vec<Samples>) {
    let watch = Stopwatch::new(clock);
    let paces: Vec<u64> = cases.iter_mut().map(|case| picoseconds(&watch, case.as_mut(), plan)).collect();
    let all: Vec<usize> = cases.iter().map(|case| case.rays()).collect();
    let mut levels: Vec<usize> = all.iter().map(|&rays| level_within(rays, plan.most_rays)).collect();
    let cost = |case: usize, level: usize| {
        // A lead-in is an eighth more.
        (rays_at(all[case], level) as u128 * u128::from(paces[case]) * 9 / 8 / 1000) as u64
    };

    let mut runs = plan.runs;
    loop {
        let costs: Vec<u64> = levels.iter().enumerate().map(|(case, &level)| cost(case, level)).collect();
        let total: u64 = costs.iter().sum();
        let fits = total.saturating_mul(runs as u64) <= plan.budget_ns;
        let middle = median(&costs.iter().map(|&ns| ns as f64).collect::<Vec<_>>()).unwrap_or(0.0);
        let smaller = (0..costs.len()).filter(|&case| levels[case] < last_level(all[case]));
        let slowest = smaller.max_by_key(|&case| costs[case]);
        match slowest {
            Some(case) if (!fits && runs == 1) || costs[case] as f64 > plan.slowest * middle => {
                let alike = |&other: &usize| groups[other] == groups[case];
                (0..levels.len()).filter(alike).for_each(|other| levels[other] = levels[case].max(levels[other]));
                (0..levels.len()).filter(alike).for_each(|other| levels[other] += 1);
            }
            _ if fits || runs == 1 => break,
            _ => runs = (plan.budget_ns / total.max(1)).clamp(1, runs as u64 - 1) as usize,
        }
    }
    (runs, levels.iter().zip(&all).map(|(&level, &all)| Samples::none(rays_at(all, level))).collect())
}

/// An epoch: adds `plan.runs` samples of every case, in each round every case once, in random order, those that are compared
/// one after the other: what disturbs them lasts, and is in all of them. `compared` has a number for each case, the same for
/// those that are compared. `samples` say on how many rays, and hold those of earlier epochs of the same cases, whose structures have been built again.
/// `progress` is told the number of samples taken, between them.
///
/// # Errors
/// If a case gives different answers to the same rays.
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
) -> Result<(), UnsteadyAnswers> {
    assert_eq!([cases.len(); 2], [samples.len(), compared.len()], "samples are of the same cases");
    let watch = Stopwatch::new(clock);
    let mut levels_of = vec![];
    for (i, (case, samples)) in cases.iter_mut().zip(samples.iter_mut()).enumerate() {
        let level_of = |rays: usize| level_of(case.rays(), rays).expect("a part is as large as a level");
        let mut levels = vec![level_of(samples.rays)];
        levels.extend(samples.parts.iter().map(|part| level_of(part.rays)));
        // Each epoch has tiles of its own: some of the first tell whether the answers are the same.
        if levels[0] > 0 {
            let answers = ask_some(&watch, case.as_mut(), levels[0]);
            if plan.epoch == 0 && answers != ask_some(&watch, case.as_mut(), levels[0]) {
                return Err(UnsteadyAnswers { case: i });
            }
            remember(samples, answers, plan.epoch);
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
            case.clear();
            case.lead_in();
            let ns = case.run(&watch);
            let checksum = case.checksum();
            if *checksums[i].get_or_insert(checksum) != checksum || case.contradicts_itself() {
                return Err(UnsteadyAnswers { case: i });
            }
            if samples.rays == case.rays() {
                remember(samples, checksum, plan.epoch);
            }
            samples.ns.push(ns[0]);
            samples.parts.iter_mut().zip(&ns[1..]).for_each(|(part, &ns)| part.ns.push(ns));
            taken += 1;
            progress(taken);
        }
    }
    Ok(())
}

/// Keeps the checksum of the first epoch, and compares those of later ones with it.
fn remember(samples: &mut Samples, checksum: u64, epoch: usize) {
    if epoch == 0 {
        samples.checksum = checksum;
    }
    samples.same_answers &= samples.checksum == checksum;
}

/// The checksum of a sixteenth of the rays that `case` is timed on in the first epoch at `level`.
fn ask_some(watch: &Stopwatch, case: &mut dyn Timed, level: usize) -> u64 {
    case.choose(&[(level + 2).min(last_level(case.rays()))], 0);
    case.clear();
    case.run(watch);
    case.checksum()
}

/// Picoseconds that a ray of `case` takes, about: of a pass over few rays, and of one that is long enough to tell.
fn picoseconds(watch: &Stopwatch, case: &mut dyn Timed, plan: &Plan) -> u64 {
    let all = case.rays();
    let largest = level_within(all, plan.most_rays);
    let with = |rays: u64| {
        let level = (largest..=last_level(all)).rev().find(|&level| rays_at(all, level) as u64 >= rays);
        level.unwrap_or(largest)
    };
    let mut pace = |level: usize| {
        case.choose(&[level], 0);
        case.clear();
        let ns = case.run(watch)[0].max(1);
        (u128::from(ns) * 1000 / rays_at(all, level) as u128).max(1) as u64
    };
    let few = with(PILOT);
    let first = pace(few);
    let enough = with(LONG_PILOT_NS.saturating_mul(1000) / first);
    if enough < few { pace(enough) } else { first }
}

#[cfg(test)]
mod tests;
