//! Taking samples of many cases, interleaved.

use super::{Clock, RandomOrder};

/// Something to time: a batch of rays that can be made smaller.
pub trait Timed {
    /// Rays of a whole pass, at least 1.
    fn rays(&self) -> usize;

    /// From now on a pass takes `rays` of them, spread evenly over the whole. Not timed.
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
    /// Samples of every case.
    pub runs: usize,
    /// What one sample may take, nanoseconds. A case that takes longer for all its rays runs on fewer.
    pub sample_budget_ns: u64,
    /// Passes of every case before its first sample, at least one.
    pub warmup: usize,
    /// Seed of the order.
    pub seed: u64,
}

/// The samples of one case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Samples {
    /// Rays of a sample: fewer than the case has when it was slow.
    pub rays: usize,
    /// Of the answers; the same in every sample.
    pub checksum: u64,
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

/// Takes `plan.runs` samples of every case: in each round every case once, in random order, after a warm-up that also finds
/// how many rays fit the budget. `progress` is told the number of samples taken, between them.
///
/// # Errors
/// If a case gives different answers to the same rays.
pub fn take(
    clock: &dyn Clock,
    cases: &mut [Box<dyn Timed + '_>],
    plan: &Plan,
    progress: &mut dyn FnMut(usize),
) -> Result<Vec<Samples>, UnsteadyAnswers> {
    let mut samples: Vec<Samples> = cases
        .iter_mut()
        .map(|case| {
            let rays = fit(clock, case.as_mut(), plan.sample_budget_ns);
            case.restrict(rays);
            pass(clock, case.as_mut());
            Samples { rays, checksum: case.checksum(), ns: Vec::with_capacity(plan.runs) }
        })
        .collect();

    let mut order = RandomOrder::new(plan.seed);
    let mut taken = 0;
    for round in 0..plan.runs + plan.warmup.saturating_sub(1) {
        for i in order.shuffled(cases.len()) {
            let (case, samples) = (cases[i].as_mut(), &mut samples[i]);
            let ns = pass(clock, case);
            if case.checksum() != samples.checksum {
                return Err(UnsteadyAnswers { case: i, pass: round + 2 });
            }
            if round + 1 >= plan.warmup {
                samples.ns.push(ns);
                taken += 1;
                progress(taken);
            }
        }
    }
    Ok(samples)
}

/// The nanoseconds of one pass.
fn pass(clock: &dyn Clock, case: &mut dyn Timed) -> u64 {
    case.clear();
    let start = clock.now_ns();
    case.run();
    clock.now_ns() - start
}

/// How many rays of `case` take about `budget_ns`: found by passes over more and more rays.
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
            return fitting.min(all);
        }
        rays = (rays * 4).min(fitting.max(rays * 2)).min(all);
    }
}

#[cfg(test)]
mod tests {
    use std::cell::{Cell, RefCell};
    use std::rc::Rc;

    use super::*;

    #[derive(Default)]
    struct MockClock(Cell<u64>);

    impl Clock for Rc<MockClock> {
        fn now_ns(&self) -> u64 {
            self.0.get()
        }
    }

    /// A case that takes `ns` a ray on the mock clock and writes its name into a log.
    struct Mock {
        clock: Rc<MockClock>,
        log: Rc<RefCell<Vec<char>>>,
        name: char,
        ns: u64,
        whole: usize,
        restricted: usize,
        answer: u64,
        /// Changes its answer in this pass.
        fickle_at: usize,
        passes: usize,
    }

    impl Timed for Mock {
        fn rays(&self) -> usize {
            self.whole
        }

        fn restrict(&mut self, rays: usize) {
            self.restricted = rays;
        }

        fn clear(&mut self) {
            self.answer = 0;
            // Time that must not be counted.
            self.clock.0.set(self.clock.0.get() + 1_000_000);
        }

        fn run(&mut self) {
            self.passes += 1;
            self.log.borrow_mut().push(self.name);
            self.clock.0.set(self.clock.0.get() + self.ns * self.restricted as u64);
            self.answer = if self.passes == self.fickle_at { 1 } else { 7 };
        }

        fn checksum(&self) -> u64 {
            self.answer
        }
    }

    struct Bench {
        clock: Rc<MockClock>,
        log: Rc<RefCell<Vec<char>>>,
    }

    impl Bench {
        fn new() -> Self {
            Self { clock: Rc::default(), log: Rc::default() }
        }

        fn case(&self, name: char, ns: u64, all: usize, fickle_at: usize) -> Box<dyn Timed> {
            let (clock, log) = (self.clock.clone(), self.log.clone());
            Box::new(Mock { clock, log, name, ns, whole: all, restricted: all, answer: 0, fickle_at, passes: 0 })
        }

        fn take(&self, cases: &mut [Box<dyn Timed>], plan: &Plan) -> Result<Vec<Samples>, UnsteadyAnswers> {
            let mut told = vec![];
            let samples = take(&self.clock, cases, plan, &mut |n| told.push(n))?;
            assert_eq!(told, (1..=plan.runs * cases.len()).collect::<Vec<_>>());
            Ok(samples)
        }
    }

    const PLAN: Plan = Plan { runs: 5, sample_budget_ns: 100_000, warmup: 1, seed: 3 };

    #[test]
    fn only_the_pass_is_timed_and_every_case_has_all_its_samples() {
        let bench = Bench::new();
        let mut cases = [bench.case('a', 10, 1000, 0), bench.case('b', 20, 1000, 0)];
        let samples = bench.take(&mut cases, &PLAN).unwrap();
        assert_eq!(samples[0], Samples { rays: 1000, checksum: 7, ns: vec![10_000; 5] });
        assert_eq!(samples[1], Samples { rays: 1000, checksum: 7, ns: vec![20_000; 5] });
        assert_eq!(samples[1].ns_per_ray(), [20.0; 5]);
    }

    #[test]
    fn a_slow_case_runs_on_the_rays_that_fit() {
        let bench = Bench::new();
        let mut cases = [bench.case('a', 10, 1_000_000, 0), bench.case('b', 50_000, 1_000_000, 0)];
        let samples = bench.take(&mut cases, &PLAN).unwrap();
        assert_eq!((samples[0].rays, samples[1].rays), (10_000, 2));
    }

    #[test]
    fn rounds_are_interleaved_in_changing_order() {
        let bench = Bench::new();
        let mut cases = [bench.case('a', 10, 64, 0), bench.case('b', 10, 64, 0), bench.case('c', 10, 64, 0)];
        let plan = Plan { runs: 12, ..PLAN };
        bench.take(&mut cases, &plan).unwrap();
        let log = bench.log.borrow();
        let rounds: Vec<&[char]> = log[log.len() - 36..].chunks(3).collect();
        for round in &rounds {
            let mut names = round.to_vec();
            names.sort_unstable();
            assert_eq!(names, ['a', 'b', 'c']);
        }
        assert!(rounds.iter().any(|r| *r != rounds[0]), "{rounds:?}");
    }

    #[test]
    fn other_answers_to_the_same_rays_are_no_measurement() {
        let bench = Bench::new();
        // The third pass: after the pilot and the first full one, the first sample.
        let mut cases = [bench.case('a', 10, 64, 3)];
        assert_eq!(bench.take(&mut cases, &PLAN), Err(UnsteadyAnswers { case: 0, pass: 2 }));
    }

    #[test]
    fn warm_up_passes_are_run_and_dropped() {
        let bench = Bench::new();
        let mut cases = [bench.case('a', 10, 64, 0)];
        let samples = bench.take(&mut cases, &Plan { warmup: 4, ..PLAN }).unwrap();
        assert_eq!(samples[0].ns.len(), 5);
        // A pilot, four passes of warm-up, five samples.
        assert_eq!(bench.log.borrow().len(), 10);
    }
}
