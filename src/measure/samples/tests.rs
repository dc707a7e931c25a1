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
    log: Rc<RefCell<Vec<(char, usize)>>>,
    name: char,
    ns: u64,
    whole: usize,
    chosen: Vec<usize>,
    epoch: usize,
    answer: u64,
    /// What it answers; to the tiles of another epoch it answers something else.
    right: u64,
    /// Changes its answer in this pass.
    fickle_at: usize,
    passes: usize,
}

impl Timed for Mock {
    fn rays(&self) -> usize {
        self.whole
    }

    fn choose(&mut self, levels: &[usize], epoch: usize) {
        self.chosen = levels.iter().map(|&level| rays_at(self.whole, level)).collect();
        self.epoch = if levels[0] == 0 { 0 } else { epoch };
    }

    fn clear(&mut self) {
        self.answer = 0;
    }

    fn lead_in(&mut self) {
        // Time that must not be counted.
        self.clock.0.set(self.clock.0.get() + 1_000_000);
    }

    fn run(&mut self, watch: &Stopwatch) -> Vec<u64> {
        self.passes += 1;
        self.log.borrow_mut().push((self.name, self.chosen[0]));
        self.answer = if self.passes == self.fickle_at { 1 } else { self.right + 100 * self.epoch as u64 };
        let of_level = |&rays: &usize| watch.time(|| self.clock.0.set(self.clock.0.get() + self.ns * rays as u64));
        self.chosen.iter().map(of_level).collect()
    }

    fn checksum(&self) -> u64 {
        self.answer
    }

    fn contradicts_itself(&self) -> bool {
        self.answer == 1
    }
}

struct Bench {
    clock: Rc<MockClock>,
    log: Rc<RefCell<Vec<(char, usize)>>>,
}

impl Bench {
    fn new() -> Self {
        Self { clock: Rc::default(), log: Rc::default() }
    }

    fn mock(&self, name: char, ns: u64, whole: usize) -> Mock {
        let (clock, log) = (self.clock.clone(), self.log.clone());
        let chosen = vec![whole];
        Mock { clock, log, name, ns, whole, chosen, epoch: 0, answer: 0, right: 7, fickle_at: 0, passes: 0 }
    }

    fn case(&self, name: char, ns: u64, all: usize) -> Box<dyn Timed> {
        Box::new(self.mock(name, ns, all))
    }

    fn begin(&self, cases: &mut [Box<dyn Timed>], plan: &Plan) -> (usize, Vec<Samples>) {
        let groups: Vec<usize> = (0..cases.len()).collect();
        begin(&self.clock, cases, &groups, plan)
    }

    fn take(&self, cases: &mut [Box<dyn Timed>], plan: &Plan) -> Result<Vec<Samples>, UnsteadyAnswers> {
        let (runs, mut samples) = self.begin(cases, plan);
        let mut told = vec![];
        take(&self.clock, cases, &vec![0; cases.len()], &Plan { runs, ..*plan }, &mut samples, &mut |n| told.push(n))?;
        assert_eq!(told, (1..=runs * cases.len()).collect::<Vec<_>>());
        Ok(samples)
    }
}

const PLAN: Plan = Plan { runs: 5, budget_ns: 1_000_000, slowest: 8.0, most_rays: usize::MAX, seed: 3, epoch: 0 };

#[test]
fn only_the_pass_is_timed_and_every_case_has_all_its_samples() {
    let bench = Bench::new();
    let mut cases = [bench.case('a', 10, 1000), bench.case('b', 20, 1000)];
    let samples = bench.take(&mut cases, &PLAN).unwrap();
    let taken = |ns| Samples { rays: 1000, checksum: 7, same_answers: true, ns: vec![ns; 5], parts: vec![] };
    assert_eq!(samples, [taken(10_000), taken(20_000)]);
    assert_eq!(samples[1].ns_per_ray(), [20.0; 5]);
}

#[test]
fn the_slow_do_with_fewer_rays_then_all_with_fewer_samples_and_then_with_fewer_rays() {
    let plan = |budget_ns| Plan { budget_ns, ..PLAN };
    let started = |budget_ns| {
        let bench = Bench::new();
        let case = |(name, ns)| bench.case(name, ns, 65_536);
        let (runs, samples) = bench.begin(&mut [('a', 10), ('b', 15), ('c', 10_000)].map(case), &plan(budget_ns));
        (runs, samples.iter().map(|samples| samples.rays).collect::<Vec<_>>())
    };
    // All rays of the two fast ones take 1.84 ms with their lead-ins, those of the slow one 737 ms, and 2.88 ms where it takes no more than
    // eight times as long as the middle one.
    assert_eq!(started(4_000_000_000), (5, vec![65_536, 65_536, 256]));
    assert_eq!(started(24_000_000), (5, vec![65_536, 65_536, 256]));
    assert_eq!(started(12_000_000), (2, vec![65_536, 65_536, 256]));
    assert_eq!(started(2_700_000), (1, vec![65_536, 65_536, 64]));
    assert_eq!(started(1_000_000), (1, vec![16_384, 4096, 64]));
    // Where no case is too slow, samples are left out first, and then all rays are spared.
    let bench = Bench::new();
    let mut cases = [('a', 10), ('b', 15), ('c', 10_000)].map(|(name, ns)| bench.case(name, ns, 65_536));
    let patient = Plan { slowest: f64::INFINITY, ..plan(1_000_000_000) };
    let (runs, samples) = bench.begin(&mut cases, &patient);
    assert_eq!((runs, samples.iter().map(|s| s.rays).collect::<Vec<_>>()), (1, vec![65_536; 3]));
    // There is always a ray.
    assert_eq!(started(1), (1, vec![rays_at(65_536, last_level(65_536)); 3]));
}

#[test]
fn no_more_rays_are_timed_than_asked_for_and_alike_cases_take_as_many() {
    let bench = Bench::new();
    let cases = || [bench.case('a', 10, 65_536), bench.case('a', 900, 65_536), bench.case('b', 10, 65_536)];
    let plan = Plan { most_rays: 20_000, budget_ns: 30_000_000, ..PLAN };
    let rays = |groups: &[usize]| {
        begin(&bench.clock, &mut cases(), groups, &plan).1.iter().map(|s| s.rays).collect::<Vec<_>>()
    };
    assert_eq!(rays(&[0, 1, 2]), [16_384, 1024, 16_384]);
    assert_eq!(rays(&[0, 0, 2]), [1024, 1024, 16_384]);
}

#[test]
fn rounds_are_interleaved_in_changing_order() {
    let bench = Bench::new();
    let mut cases = ['a', 'b', 'c'].map(|name| bench.case(name, 10, 64));
    bench.take(&mut cases, &Plan { runs: 12, ..PLAN }).unwrap();
    let log: Vec<char> = bench.log.borrow().iter().map(|(name, _)| *name).collect();
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
    // A pilot, then five samples: the second of them, or its lead-in, answers otherwise.
    for (runs, most_rays) in [(5, usize::MAX), (5, 16), (1, 16)] {
        let bench = Bench::new();
        let fickle_at = if most_rays == 16 { 3 } else { 2 };
        let mut cases: [Box<dyn Timed>; 1] = [Box::new(Mock { fickle_at, ..bench.mock('a', 10, 64) })];
        let plan = Plan { runs, most_rays, ..PLAN };
        assert_eq!(bench.take(&mut cases, &plan), Err(UnsteadyAnswers { case: 0 }), "{runs} {most_rays}");
    }
}

#[test]
fn parts_are_timed_along() {
    let bench = Bench::new();
    let mut samples = [Samples::none(65_536)];
    samples[0].parts = [1024, 64].map(|rays| Part { rays, ns: vec![] }).into();
    take(&bench.clock, &mut [bench.case('a', 10, 65_536)], &[0], &Plan { runs: 2, ..PLAN }, &mut samples, &mut |_| {})
        .unwrap();
    assert_eq!(samples[0].ns, [655_360; 2]);
    assert_eq!(samples[0].parts, [(1024, 10_240), (64, 640)].map(|(rays, ns)| Part { rays, ns: vec![ns; 2] }));
}

#[test]
fn another_epoch_takes_as_many_rays_and_tells_other_answers() {
    for (whole, rays) in [(1000, 1000), (65_536, 16_384)] {
        let bench = Bench::new();
        let plan = |epoch| Plan { most_rays: 16_384, epoch, ..PLAN };
        let mut samples = bench.take(&mut [bench.case('a', 10, whole)], &plan(0)).unwrap();
        // Built again, and slower: as many rays as in the first epoch.
        let mut again = [bench.case('a', 20, whole)];
        take(&bench.clock, &mut again, &[0], &plan(1), &mut samples, &mut |_| {}).unwrap();
        assert_eq!((samples[0].rays, samples[0].checksum), (rays, 7));
        assert_eq!(samples[0].ns, [[10 * rays as u64; 5], [20 * rays as u64; 5]].concat());
        assert!(samples[0].same_answers);

        let other = Mock { right: 8, ..bench.mock('a', 20, whole) };
        take(&bench.clock, &mut [Box::new(other) as _], &[0], &plan(2), &mut samples, &mut |_| {}).unwrap();
        assert!(!samples[0].same_answers && samples[0].checksum == 7 && samples[0].ns.len() == 15);
    }
}
