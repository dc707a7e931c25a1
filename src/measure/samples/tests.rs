use std::cell::{Cell, RefCell};

use super::*;
use crate::measure::level_by_clock;
use crate::measure::tiles::level_within;

#[derive(Default)]
struct Bench {
    now: Cell<u64>,
    log: RefCell<Vec<char>>,
}

impl Clock for Bench {
    fn now_ns(&self) -> u64 {
        self.now.get()
    }
}

struct Mock<'a> {
    bench: &'a Bench,
    name: char,
    ns: u64,
    all: usize,
    chosen: Vec<usize>,
    epoch: usize,
    checksum: u64,
    /// The checksum in epoch 0.
    right: u64,
    /// The pass in which the checksum changes.
    fickle_at: usize,
    passes: usize,
}

impl Timed for Mock<'_> {
    fn rays(&self) -> usize {
        self.all
    }

    fn choose(&mut self, levels: &[usize], epoch: usize) {
        self.chosen = levels.iter().map(|&level| rays_at(self.all, level)).collect();
        self.epoch = if levels[0] == 0 { 0 } else { epoch };
    }

    fn clear(&mut self) {
        self.checksum = 0;
    }

    fn lead_in(&mut self) {
        self.bench.now.update(|ns| ns + 1_000_000);
    }

    fn run(&mut self, watch: &Stopwatch) -> Vec<u64> {
        self.passes += 1;
        self.bench.log.borrow_mut().push(self.name);
        self.checksum = if self.passes == self.fickle_at { 1 } else { self.right + 100 * self.epoch as u64 };
        let of_level = |&rays: &usize| watch.time(|| self.bench.now.update(|ns| ns + self.ns * rays as u64));
        self.chosen.iter().map(of_level).collect()
    }

    fn checksum(&self) -> u64 {
        self.checksum
    }

    fn contradicts_itself(&self) -> bool {
        self.checksum == 1
    }
}

impl Bench {
    fn mock(&self, name: char, ns: u64, all: usize) -> Mock<'_> {
        Mock { bench: self, name, ns, all, chosen: vec![all], epoch: 0, checksum: 0, right: 7, fickle_at: 0, passes: 0 }
    }

    fn case(&self, name: char, ns: u64, all: usize) -> Box<dyn Timed + '_> {
        Box::new(self.mock(name, ns, all))
    }

    fn take<'a>(&'a self, cases: &mut [Box<dyn Timed + 'a>], plan: &SamplePlan) -> Vec<Samples> {
        let none = |rays: usize| Samples::none(rays, level_within(rays, plan.most_rays));
        let mut samples: Vec<Samples> = cases.iter().map(|case| none(case.rays())).collect();
        let mut progress = vec![];
        take(self, cases, &vec![0; cases.len()], plan, &mut samples, &mut |n| progress.push(n));
        assert_eq!(progress, (1..=plan.runs * cases.len()).collect::<Vec<_>>());
        samples
    }
}

const PLAN: SamplePlan =
    SamplePlan { runs: 5, budget_ns: 1_000_000, slowest: 8.0, most_rays: usize::MAX, seed: 3, epoch: 0 };

#[test]
fn only_the_pass_is_timed_in_rounds_of_changing_order() {
    let bench = Bench::default();
    let mut cases = [('a', 10), ('b', 20), ('c', 30)].map(|(name, ns)| bench.case(name, ns, 1000));
    let samples = bench.take(&mut cases, &SamplePlan { runs: 12, ..PLAN });
    let taken = |ns| Samples { checksum: 7, timed_checksum: 7, ns: vec![ns; 12], ..Samples::none(1000, 0) };
    assert_eq!(samples, [10_000, 20_000, 30_000].map(taken));
    let log = bench.log.borrow();
    let rounds: Vec<&[char]> = log.chunks(3).collect();
    for round in &rounds {
        let mut names = round.to_vec();
        names.sort_unstable();
        assert_eq!(names, ['a', 'b', 'c']);
    }
    assert!(rounds.iter().any(|r| *r != rounds[0]), "{rounds:?}");
}

#[test]
fn a_case_with_changing_results_is_not_steady_and_other_cases_continue() {
    // If `most_rays` is 16, two checksum passes precede the samples. Pass 4 is then the second sample.
    for (runs, most_rays, fickle_at) in [(5, usize::MAX, 2), (5, 16, 4), (1, 16, 2)] {
        let bench = Bench::default();
        let fickle = Mock { fickle_at, ..bench.mock('a', 10, 64) };
        let mut cases: [Box<dyn Timed + '_>; 2] = [Box::new(fickle), bench.case('b', 10, 64)];
        let samples = bench.take(&mut cases, &SamplePlan { runs, most_rays, ..PLAN });
        assert!(!samples[0].is_steady && samples[1].is_steady, "{runs} {most_rays}");
        assert_eq!(samples[1].ns.len(), runs);
        let passes = bench.log.borrow().iter().filter(|&&name| name == 'a').count();
        assert_eq!(passes, fickle_at, "it is not run again");
    }
}

#[test]
fn parts_are_timed_along() {
    let bench = Bench::default();
    let mut samples = [Samples::none(65_536, 0)];
    samples[0].parts = [1024, 64].map(|rays| SubsetSamples { rays, ns: vec![] }).into();
    let mut cases = [bench.case('a', 10, 65_536)];
    take(&bench, &mut cases, &[0], &SamplePlan { runs: 2, ..PLAN }, &mut samples, &mut |_| {});
    assert_eq!(samples[0].ns, [655_360; 2]);
    assert_eq!(samples[0].parts, [(1024, 10_240), (64, 640)].map(|(rays, ns)| SubsetSamples { rays, ns: vec![ns; 2] }));
}

#[test]
fn another_epoch_has_the_checksum_of_the_first_unless_its_results_differ() {
    for (whole, rays, checksum_level) in [(1000, 1000, None), (65_536, 16_384, Some(3))] {
        let bench = Bench::default();
        let checksum = |right: u64, epoch: usize| {
            let mut cases: [Box<dyn Timed + '_>; 1] = [Box::new(Mock { right, ..bench.mock('a', 10, whole) })];
            let samples = bench.take(&mut cases, &SamplePlan { most_rays: 16_384, epoch, ..PLAN });
            assert_eq!((samples[0].rays, samples[0].checksum_level, samples[0].ns.len()), (rays, checksum_level, 5));
            samples[0].checksum
        };
        assert_eq!([(7, 0), (7, 1), (8, 2)].map(|(right, epoch)| checksum(right, epoch)), [7, 7, 8]);
    }
}

#[test]
fn a_case_of_unknown_cost_takes_as_many_rays_as_its_clock_says_that_it_can() {
    let bench = Bench::default();
    // 65,536 rays at 100 ns per ray take 6.55 ms. `level_by_clock` multiplies this time by 19 / 8: 15.6 ms.
    let cases = [
        (100, 0, 16_000_000, 65_536),
        (100, 0, 15_000_000, 16_384),
        (100, 2, 15_000_000, 4096),
        (100_000, 0, 15_000_000, 64),
        (100_000_000, 0, 15_000_000, 64),
    ];
    for (ns, from, most_ns, rays) in cases {
        let level = level_by_clock(&Stopwatch::new(&bench), &mut bench.mock('a', ns, 65_536), from, most_ns);
        assert_eq!(rays_at(65_536, level), rays, "{ns} ns from {from} within {most_ns}");
    }
}
