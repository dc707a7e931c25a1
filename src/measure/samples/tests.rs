use std::cell::{Cell, RefCell};
use std::rc::Rc;

use super::*;
use crate::measure::warm_up::MOST_PASSES;

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
    /// What it answers.
    right: u64,
    /// How many times slower its first pass is; each further one is so by one less.
    cold: u64,
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
        // Cold at first: three times as slow, then twice, then as fast as it gets.
        let cold = self.cold.saturating_sub(self.passes as u64 - 1).max(1);
        self.clock.0.set(self.clock.0.get() + self.ns * self.restricted as u64 * cold);
        self.answer = if self.passes == self.fickle_at { 1 } else { self.right };
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

    fn mock(&self, name: char, ns: u64, all: usize) -> Mock {
        Mock {
            clock: self.clock.clone(),
            log: self.log.clone(),
            name,
            ns,
            whole: all,
            restricted: all,
            answer: 0,
            right: 7,
            cold: 1,
            fickle_at: 0,
            passes: 0,
        }
    }

    fn case(&self, name: char, ns: u64, all: usize, fickle_at: usize) -> Box<dyn Timed> {
        Box::new(Mock { fickle_at, ..self.mock(name, ns, all) })
    }

    /// 64 rays that the first pass over them takes `cold` times as long for.
    fn cold(&self, name: char, cold: u64) -> Box<dyn Timed> {
        Box::new(Mock { cold, ..self.mock(name, 10, 64) })
    }

    fn take(&self, cases: &mut [Box<dyn Timed>], plan: &Plan) -> Result<Vec<Samples>, UnsteadyAnswers> {
        let mut told = vec![];
        let mut samples = begin(&self.clock, cases, plan);
        take(&self.clock, cases, plan, &mut samples, &mut |n| told.push(n))?;
        assert_eq!(told, (1..=plan.runs * cases.len()).collect::<Vec<_>>());
        Ok(samples)
    }
}

/// Five samples of `ns` each.
fn taken(rays: usize, ns: u64) -> Samples {
    Samples { rays, checksum: 7, same_answers: true, unsteady: 0, ns: vec![ns; 5] }
}

const PLAN: Plan = Plan { runs: 5, sample_budget_ns: 100_000, warmup: 1, seed: 3 };

#[test]
fn only_the_pass_is_timed_and_every_case_has_all_its_samples() {
    let bench = Bench::new();
    let mut cases = [bench.case('a', 10, 1000, 0), bench.case('b', 20, 1000, 0)];
    let samples = bench.take(&mut cases, &PLAN).unwrap();
    assert_eq!(samples[0], taken(1000, 10_000));
    assert_eq!(samples[1], taken(1000, 20_000));
    assert_eq!(samples[1].ns_per_ray(), [20.0; 5]);
}

#[test]
fn a_slow_case_runs_on_the_rays_that_fit() {
    let bench = Bench::new();
    let mut cases = [bench.case('a', 10, 1_000_000, 0), bench.case('b', 50_000, 1_000_000, 0)];
    let samples = bench.take(&mut cases, &PLAN).unwrap();
    assert_eq!((samples[0].rays, samples[1].rays), (8192, 2));
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
    // The third pass: after the pilot and the first one of the warm-up. And the fifth: the second sample.
    for (fickle_at, pass) in [(3, 2), (5, 4)] {
        let mut cases = [bench.case('a', 10, 64, fickle_at)];
        assert_eq!(bench.take(&mut cases, &PLAN), Err(UnsteadyAnswers { case: 0, pass }));
    }
}

#[test]
fn a_cold_case_is_warmed_until_it_is_steady() {
    let bench = Bench::new();
    let mut cases = [bench.cold('a', 8)];
    let samples = bench.take(&mut cases, &PLAN).unwrap();
    assert_eq!(samples[0], taken(64, 640));
    // A pilot eight times as slow, six more before the first fast one, that, another as fast, five samples.
    assert_eq!(bench.log.borrow().len(), 1 + 6 + 2 + 5);

    // What gets no steadier is measured all the same, and told.
    let bench = Bench::new();
    let samples = bench.take(&mut [bench.cold('a', MOST_PASSES as u64 + 2)], &PLAN).unwrap();
    assert_eq!((samples[0].ns.len(), samples[0].unsteady), (5, 1));
    assert_eq!(bench.log.borrow().len(), 1 + MOST_PASSES + 5);
}

#[test]
fn at_least_as_many_warm_up_passes_are_run_as_asked_for() {
    let bench = Bench::new();
    let mut cases = [bench.case('a', 10, 64, 0)];
    let samples = bench.take(&mut cases, &Plan { warmup: 4, ..PLAN }).unwrap();
    assert_eq!(samples[0].ns.len(), 5);
    // A pilot, four passes of warm-up, five samples.
    assert_eq!(bench.log.borrow().len(), 10);
}

#[test]
fn another_epoch_takes_the_same_rays_and_tells_other_answers() {
    let bench = Bench::new();
    let mut samples = bench.take(&mut [bench.case('a', 10, 1_000_000, 0)], &PLAN).unwrap();
    // Built again, and slower: the rays stay those of the first epoch.
    let mut again = [bench.case('a', 20, 1_000_000, 0)];
    take(&bench.clock, &mut again, &PLAN, &mut samples, &mut |_| {}).unwrap();
    assert_eq!(samples[0].rays, 8192);
    assert_eq!(samples[0].ns, [[81_920; 5], [163_840; 5]].concat());
    assert!(samples[0].same_answers);

    let mut other = bench.mock('a', 20, 1_000_000);
    other.right = 8;
    take(&bench.clock, &mut [Box::new(other) as _], &PLAN, &mut samples, &mut |_| {}).unwrap();
    assert!(!samples[0].same_answers && samples[0].checksum == 7 && samples[0].ns.len() == 15);
}
