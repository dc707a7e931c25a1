//! Tests the coverage of the intervals with simulated runs.

use super::*;
use crate::measure::{AaNoise, RandomOrder};

const EPOCHS: usize = 5;

#[derive(Clone, Copy, Debug)]
struct Machine {
    /// Standard deviation of ln(time) between epochs.
    placement: f64,
    /// Standard deviation of ln(time) between runs.
    run: f64,
    /// The maximum increase of ln(time) by an interruption.
    tail: f64,
    epochs: usize,
    rounds: usize,
}

impl Default for Machine {
    fn default() -> Self {
        Self { placement: 0.01, run: 0.0, tail: 0.05, epochs: EPOCHS, rounds: 1 }
    }
}

fn noise(random: &mut RandomOrder, tail: f64) -> f64 {
    let interrupted = random.uniform() < 0.125;
    0.01 * random.normal() + if interrupted { tail * random.uniform() } else { 0.0 }
}

impl Machine {
    /// Returns ln(time), indexed by structure, epoch and round.
    fn cell(&self, times: &[f64], random: &mut RandomOrder) -> Vec<Vec<Vec<f64>>> {
        let mut samples = vec![vec![]; times.len()];
        let run: Vec<f64> = times.iter().map(|_| self.run * random.normal()).collect();
        for epoch in 0..self.epochs {
            let placed: Vec<f64> = times.iter().map(|_| self.placement * random.normal()).collect();
            samples.iter_mut().for_each(|structure| structure.push(vec![]));
            for round in 0..self.rounds {
                for (i, time) in times.iter().enumerate() {
                    let done = (epoch * self.rounds + round) as f64 + random.uniform();
                    let drift = 0.2 * done / (self.epochs * self.rounds) as f64;
                    let log = libm::log(*time) + placed[i] + run[i] + drift + noise(random, self.tail);
                    samples[i][epoch].push(log);
                }
            }
        }
        samples
    }

    fn ratio(&self, times: [f64; 2], random: &mut RandomOrder) -> Vec<Vec<f64>> {
        let logs = self.cell(&times, random);
        log_differences(&logs[0], &logs[1])
    }

    fn values(&self, runs: usize, times: [f64; 2], random: &mut RandomOrder) -> Vec<f64> {
        (0..runs).flat_map(|_| epoch_values(&[self.ratio(times, random)]).unwrap()).collect()
    }
}

fn log_differences(one: &[Vec<f64>], other: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let of_epoch = |(one, other): (&Vec<f64>, &Vec<f64>)| one.iter().zip(other).map(|(a, b)| a - b).collect();
    one.iter().zip(other).map(of_epoch).collect()
}

fn machines() -> impl Iterator<Item = Machine> {
    let of = |rounds: usize| [0.0, 0.01, 0.04].map(|placement| Machine { placement, rounds, ..Machine::default() });
    [1, 3].into_iter().flat_map(of)
}

const PAIRS: u64 = 2500;

fn coverage_of(pairs: u64, pair: impl Fn(&mut RandomOrder) -> (Estimate, f64)) -> f64 {
    let holds = |seed: &u64| {
        let (first, second) = pair(&mut RandomOrder::new(*seed));
        first.holds(second)
    };
    (0..pairs).filter(holds).count() as f64 * 100.0 / pairs as f64
}

/// Returns the percentage of pairs in which the interval of the first run contains the second estimate.
fn held(pairs: u64, run: impl Fn(&mut RandomOrder) -> Rerun) -> f64 {
    coverage_of(pairs, |random| (run(random).plain(), run(random).plain().estimate))
}

#[track_caller]
fn as_promised(held: f64, of: &str) {
    assert!((93.0..=97.0).contains(&held), "{held:.1} % of {of}");
}

fn mean_of(cells: &[Vec<Vec<f64>>], noise: Variance) -> Rerun {
    Rerun::of(&epoch_values(cells).unwrap(), noise).unwrap()
}

#[test]
fn the_estimate_of_a_second_run_lies_within_the_interval_of_the_first() {
    for machine in [3, 4, EPOCHS].into_iter().flat_map(|epochs| machines().map(move |m| Machine { epochs, ..m })) {
        let run = |random: &mut RandomOrder| mean_of(&[machine.ratio([3.0, 1.0], random)], Variance::NONE);
        as_promised(held(PAIRS, run), &format!("{machine:?}"));
    }
}

#[test]
fn several_rounds_filter_interruptions_and_one_does_not() {
    let of = |rounds: usize, tail: f64| {
        let machine = Machine { rounds, tail, ..Machine::default() };
        held(PAIRS, |random| mean_of(&[machine.ratio([3.0, 1.0], random)], Variance::NONE))
    };
    as_promised(of(3, 0.1), "three rounds, interruptions of ten standard deviations");
    // Interruptions prolong one sample in eight by up to 35 %.
    let (one, five) = (of(1, 0.3), of(5, 0.3));
    assert!(one < 90.0 && five > one + 4.0, "{one:.1} % of one round, {five:.1} % of five");
}

#[test]
fn changes_lie_within_their_intervals() {
    let machine = Machine { placement: 0.02, ..Machine::default() };
    let changes = coverage_of(PAIRS, |random| {
        let (old, new) = (machine.values(1, [1.0, 1.0], random), machine.values(2, [1.1, 1.0], random));
        (Rerun::change(&old, &new, [Variance::NONE; 2]).unwrap().plain(), libm::log(1.1))
    });
    as_promised(changes, "changes");
    // A confidence interval is too narrow to predict the mean of another run.
    let confidence = held(PAIRS, |random| {
        let of = mean_of(&[Machine::default().ratio([3.0, 1.0], random)], Variance::NONE);
        Rerun { variance: of.variance.map(|variance| variance.times(std::f64::consts::FRAC_1_SQRT_2)), ..of }
    });
    assert!(confidence < 90.0, "{confidence:.1} %");
}

/// Simulates two structures and a second build of the first structure.
fn with_twins(machine: Machine, cells: usize, random: &mut RandomOrder) -> (Vec<Vec<Vec<f64>>>, AaNoise) {
    let [mut ratios, mut twins] = [vec![], vec![]];
    for _ in 0..cells {
        let logs = machine.cell(&[3.0, 1.0, 3.0], random);
        ratios.push(log_differences(&logs[0], &logs[1]));
        twins.push(log_differences(&logs[0], &logs[2]));
    }
    (ratios, AaNoise::new(&twins))
}

#[test]
fn effects_of_whole_runs_are_covered_with_the_aa_noise_and_not_without() {
    for (run, cells) in [(0.0, 1), (0.007, 1), (0.0, 4), (0.0, 8), (0.007, 8), (0.02, 12)] {
        let machine = Machine { run, ..Machine::default() };
        let share = |noise: &dyn Fn(&AaNoise) -> Variance, all: bool| {
            held(2000, |random| {
                let (ratios, twins) = with_twins(machine, cells, random);
                mean_of(if all { &ratios } else { &ratios[..1] }, noise(&twins))
            })
        };
        let of_one = share(&AaNoise::of_ratio, false);
        if (run, cells) == (0.007, 1) {
            // One A/A ratio estimates the A/A noise only roughly.
            assert!((91.0..=97.0).contains(&of_one), "{of_one:.1} %");
            continue;
        }
        as_promised(of_one, &format!("single cells, run effects {run}, {cells} A/A ratios"));
        as_promised(
            share(&|twins| twins.of_mean(cells), true),
            &format!("means, run effects {run}, {cells} A/A ratios"),
        );
        if run > 0.01 {
            let without = share(&|_| Variance::NONE, false);
            assert!(without < 75.0, "{without:.1} % without the A/A noise");
        }
    }
}

#[test]
fn half_widths_are_those_of_students_t() {
    let (spread, none) = ([-0.02, -0.01, 0.0, 0.01, 0.02], [0.0; 5]);
    let deviation = 0.01 * libm::sqrt(2.5);
    let half = |rerun: Option<Rerun>| {
        let Estimate { estimate, interval } = rerun.unwrap().plain();
        interval.unwrap().high - estimate
    };
    let expect = |half: f64, expected: f64| assert!((half - expected).abs() < 1e-4, "{half} {expected}");
    expect(half(Rerun::of(&spread, Variance::NONE)), 2.776 * deviation * libm::sqrt(2.0 / 5.0));
    let change = |old: &[f64], new: &[f64], noise| Rerun::change(old, new, [noise; 2]);
    let noise = Variance { square: 1e-4, freedom: 1e9 };
    expect(half(change(&spread, &spread.map(|x| x + 0.1), Variance::NONE)), 2.306 * deviation * libm::sqrt(2.0 / 5.0));
    expect(half(change(&spread, &none, Variance::NONE)), 2.776 * deviation * libm::sqrt(1.0 / 5.0));
    expect(half(change(&none, &none, noise)), 1.96 * libm::sqrt(2e-4));
    let exact = change(&none, &[0.1; 5], Variance::NONE).unwrap().plain();
    assert!((exact.estimate - 0.1).abs() < 1e-12 && exact.low() == Some(exact.estimate));
}

#[test]
fn cells_of_one_epoch_share_its_placement() {
    // The two cells vary equally between epochs, so the mean of the cells varies as much as one cell.
    let cell = |by: f64| -> Vec<Vec<f64>> { (0..EPOCHS).map(|e| vec![by + 0.01 * e as f64; 3]).collect() };
    let one = mean_of(&[cell(0.0)], Variance::NONE).ratio();
    let two = mean_of(&[cell(0.0), cell(1.0)], Variance::NONE).ratio();
    let width = |x: Estimate| libm::log(x.high().unwrap() / x.low().unwrap());
    assert!((width(one) - width(two)).abs() < 1e-12);
    assert!((two.estimate / one.estimate - libm::exp(0.5)).abs() < 1e-12);
}

#[test]
fn of_one_epoch_there_is_an_estimate_and_no_interval() {
    let cell = vec![[2.0, 2.1, 1.9, 2.0].map(libm::log).to_vec()];
    let one = mean_of(&[cell], Variance { square: 1.0, freedom: 1.0 }).ratio();
    assert!((one.estimate - 2.0).abs() < 1e-12 && one.interval.is_none(), "{one:?}");
    assert_eq!((Rerun::of(&[], Variance::NONE), epoch_values(&[])), (None, None));
    assert_eq!(epoch_values(&[vec![vec![]]]), None);
    assert_eq!(Rerun::change(&[], &[0.0; 5], [Variance::NONE; 2]), None);
    assert_eq!(Rerun::change(&[0.0], &[0.0; 5], [Variance::NONE; 2]).unwrap().plain(), Estimate::alone(0.0));
}
