//! Runs of a machine that is simulated, so that what an interval claims can be counted.

use super::*;
use crate::measure::NoiseFloor;

/// One ratio, as [`replication`] over a single cell.
fn replicated_ratio(a: &[f64], b: &[f64], epochs: usize, floor: f64, seed: u64) -> Option<Interval> {
    replication(&[log_ratios(a, b, epochs)], floor, seed)
}

/// What this module says is too narrow: the median of the ratios of all rounds, with a percentile bootstrap over them.
fn plain(a: &[f64], b: &[f64], seed: u64) -> Interval {
    let ratios: Vec<f64> = a.iter().zip(b).map(|(a, b)| a / b).collect();
    let mut random = RandomOrder::new(seed);
    let draw = |_| middle_of(&ratios.iter().map(|_| ratios[random.below(ratios.len())]).collect::<Vec<_>>());
    let mut draws: Vec<f64> = (0..RESAMPLES).map(draw).collect();
    draws.sort_unstable_by(f64::total_cmp);
    let tail = RESAMPLES / 40;
    Interval { estimate: middle_of(&ratios), low: draws[tail], high: draws[RESAMPLES - 1 - tail] }
}

const EPOCHS: usize = 5;
const ROUNDS: usize = 3;

/// A machine with everything that makes times hard to compare.
struct Machine {
    random: RandomOrder,
    /// Standard deviation of what an epoch's placement does to ln time.
    placement: f64,
    /// That of what a process does to the ln ratio of its two cases.
    process: f64,
}

impl Machine {
    fn new(seed: u64, placement: f64) -> Self {
        Self { random: RandomOrder::new(seed), placement, process: 0.0 }
    }

    fn uniform(&mut self) -> f64 {
        self.random.below(1 << 30) as f64 / f64::from(1 << 30)
    }

    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    /// Noise of one sample: one in eight is interrupted and takes up to a third longer.
    fn noise(&mut self) -> f64 {
        let interrupted = self.uniform() < 0.125;
        0.01 * self.normal() + if interrupted { 0.3 * self.uniform() } else { 0.0 }
    }

    /// Samples of `times.len()` cases, in `epochs` epochs; the machine grows slower by a fifth over the run.
    fn run(&mut self, times: &[f64], epochs: usize) -> Vec<Vec<f64>> {
        let mut samples = vec![vec![]; times.len()];
        let process: Vec<f64> = times.iter().map(|_| self.process * self.normal()).collect();
        for epoch in 0..epochs {
            let placed: Vec<f64> = times.iter().map(|_| self.placement * self.normal()).collect();
            for round in 0..ROUNDS {
                for i in self.random.shuffled(times.len()) {
                    let done = (epoch * ROUNDS + round) as f64 + self.uniform();
                    let drift = 0.2 * done / (epochs * ROUNDS) as f64;
                    let log = placed[i] + process[i] + drift + self.noise();
                    samples[i].push(times[i] * libm::exp(log));
                }
            }
        }
        samples
    }
}

/// In how many of `pairs` pairs of runs the second's estimate lies within the first's interval.
fn held(pairs: u64, placement: f64, interval: impl Fn(&[f64], &[f64], u64) -> Interval) -> usize {
    let once = |pair: u64| {
        let mut machine = Machine::new(pair, placement);
        let [first, second] = [(); 2].map(|()| {
            let run = machine.run(&[3.0, 1.0], EPOCHS);
            interval(&run[0], &run[1], pair)
        });
        first.low <= second.estimate && second.estimate <= first.high
    };
    (0..pairs).filter(|&pair| once(pair)).count()
}

const PAIRS: u64 = 300;

/// The fewest that may be held when 95 % are: two standard deviations of a count below.
const ENOUGH: usize = 277;

#[test]
fn the_estimate_of_a_second_run_lies_within_the_interval_of_the_first() {
    for placement in [0.0, 0.01, 0.04] {
        let n = held(PAIRS, placement, |a, b, seed| replicated_ratio(a, b, EPOCHS, 0.0, seed).unwrap());
        assert!(n >= ENOUGH, "{n} of {PAIRS} with placement {placement}");
        // An interval that holds everything says nothing.
        assert!(n <= 298, "{n} of {PAIRS} with placement {placement}");
    }
}

#[test]
fn a_plain_interval_does_not_hold_it() {
    let n = held(PAIRS, 0.01, plain);
    assert!(n < ENOUGH, "{n} of {PAIRS}: rounds taken for independent");
    // Nor does the confidence interval of the mean over epochs.
    let confidence = |a: &[f64], b: &[f64], _: u64| {
        let values = epoch_values(&[log_ratios(a, b, EPOCHS)]).unwrap();
        let (centre, half) = (mean(&values), factor(4.0, LEVEL) * standard_error(&values).unwrap());
        let end = |x| libm::exp(x);
        Interval { estimate: end(centre), low: end(centre - half), high: end(centre + half) }
    };
    let n = held(PAIRS, 0.01, confidence);
    assert!(n < ENOUGH, "{n} of {PAIRS}: for the mean, not for another run");
}

#[test]
fn what_only_processes_differ_in_is_held_by_the_floor() {
    let run = |seed: u64| {
        let mut machine = Machine { process: 0.015, ..Machine::new(1000 + seed, 0.005) };
        [(); 2].map(|()| {
            // Two structures and, of the first, a twin, on eight kinds of rays; the floor is that of the run.
            let cells: Vec<Vec<Vec<f64>>> = (0..8).map(|_| machine.run(&[3.0, 1.0, 3.0], EPOCHS)).collect();
            let twins: Vec<_> = cells.iter().map(|cell| log_ratios(&cell[0], &cell[2], EPOCHS)).collect();
            let floor = NoiseFloor::new(&twins, seed);
            let ratios = cells.iter().map(|cell| log_ratios(&cell[0], &cell[1], EPOCHS));
            (ratios.collect::<Vec<_>>(), floor.log().unwrap(), floor.holding_one())
        })
    };
    let (mut without, mut with, mut twins, mut all) = (0, 0, 0, 0);
    for seed in 0..20 {
        let [(first, floor, holding), (second, ..)] = run(seed);
        twins += holding;
        for (first, second) in first.iter().zip(&second) {
            let estimate = mean(&epoch_values(std::slice::from_ref(second)).unwrap());
            let held = |floor| {
                let interval = replication(std::slice::from_ref(first), floor, seed).unwrap();
                (interval.low..=interval.high).contains(&libm::exp(estimate))
            };
            without += usize::from(held(0.0));
            with += usize::from(held(floor));
            all += 1;
        }
    }
    assert!(without * 100 < all * 92, "{without} of {all} without the floor");
    assert!(with * 100 >= all * 95, "{with} of {all} with the floor");
    // Twins that differ by process do so here alone; elsewhere they are the same code.
    assert!(twins * 100 >= all * 80, "{twins} of {all} A/A ratios hold 1");
}

#[test]
fn cells_of_one_epoch_share_its_luck() {
    // Both cells are moved by the same epochs: the mean is as uncertain as either.
    let cell = |by: f64| -> Vec<Vec<f64>> { (0..EPOCHS).map(|e| vec![by + 0.01 * e as f64; ROUNDS]).collect() };
    let one = replication(&[cell(0.0)], 0.0, 1).unwrap();
    let two = replication(&[cell(0.0), cell(1.0)], 0.0, 1).unwrap();
    let width = |x: Interval| libm::log(x.high / x.low);
    assert!((width(one) - width(two)).abs() < 1e-12);
    assert!((two.estimate / one.estimate - libm::exp(0.5)).abs() < 1e-12);
    // t(4) s sqrt(2 / 5), s the deviation of 0, 1, 2, 3, 4 hundredths.
    let half = factor(4.0, LEVEL) * 0.01 * libm::sqrt(2.5) * libm::sqrt(0.4);
    assert!((width(one) - 2.0 * half).abs() < 1e-12, "{}", width(one));
}

#[test]
fn a_longer_run_is_easier_to_foresee() {
    let cell: Vec<Vec<f64>> = (0..EPOCHS).map(|e| vec![0.01 * e as f64; ROUNDS]).collect();
    let half = |epochs| libm::log(prediction(std::slice::from_ref(&cell), epochs, 0.0, 1).unwrap().high) - 0.02;
    let error = factor(4.0, LEVEL) * 0.01 * libm::sqrt(2.5);
    for epochs in [2, 5, 20] {
        let expected = error * libm::sqrt(1.0 / 5.0 + 1.0 / epochs as f64);
        assert!((half(epochs) - expected).abs() < 1e-12, "{epochs}");
    }
}

#[test]
fn one_epoch_and_nothing() {
    let interval = replicated_ratio(&[2.0, 2.1, 1.9, 2.0], &[1.0; 4], 1, 0.0, 1).unwrap();
    assert!(
        interval.low < 1.9 && interval.high > 2.1 && interval.estimate == libm::exp(libm::log(2.0)),
        "{interval:?}"
    );
    let single = replicated_ratio(&[2.0], &[1.0], 1, 0.5, 1).unwrap();
    assert!(single.high > 1e100 && single.high.is_finite() && single.low < 1e-100, "nothing is known: {single:?}");
    assert_eq!(replication(&[], 0.0, 1), None);
}
