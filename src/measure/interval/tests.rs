//! Runs of a machine that is simulated, so that what an interval claims can be counted.

use super::*;
use crate::measure::{AaNoise, RandomOrder};

const EPOCHS: usize = 5;

/// A machine with everything that makes times hard to compare. All its parts are standard deviations of ln time.
#[derive(Clone, Copy, Debug)]
struct Machine {
    /// What the placement of an epoch does to a structure.
    placement: f64,
    /// What a run does to a structure in one cell, the same in all its epochs.
    run: f64,
    /// The most that an interruption adds: five standard deviations of other samples where nothing else is said.
    tail: f64,
    epochs: usize,
    rounds: usize,
}

impl Default for Machine {
    fn default() -> Self {
        Self { placement: 0.01, run: 0.0, tail: 0.05, epochs: EPOCHS, rounds: 1 }
    }
}

/// Noise of one sample: one in eight is interrupted, and then takes longer by up to `tail`.
fn noise(random: &mut RandomOrder, tail: f64) -> f64 {
    let interrupted = random.uniform() < 0.125;
    0.01 * random.normal() + if interrupted { tail * random.uniform() } else { 0.0 }
}

impl Machine {
    /// ln times of as many structures as `times`, epoch by epoch, round by round; the machine grows slower by a fifth
    /// over the run.
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
        let epoch = |e: usize| logs[0][e].iter().zip(&logs[1][e]).map(|(a, b)| a - b).collect();
        (0..self.epochs).map(epoch).collect()
    }
}

/// Machines of every kind: with and without placement luck, one round and three.
fn machines() -> impl Iterator<Item = Machine> {
    let of = |rounds: usize| [0.0, 0.01, 0.04].map(|placement| Machine { placement, rounds, ..Machine::default() });
    [1, 3].into_iter().flat_map(of)
}

const PAIRS: u64 = 2500;

/// In how many per cent of pairs of runs the second's estimate lies within the first's interval.
fn held(pairs: u64, run: impl Fn(&mut RandomOrder) -> Rerun) -> f64 {
    let once = |pair: &u64| {
        let mut random = RandomOrder::new(*pair);
        let [first, second] = [run(&mut random), run(&mut random)];
        first.plain().holds(second.plain().estimate)
    };
    (0..pairs).filter(once).count() as f64 * 100.0 / pairs as f64
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
    // As few epochs as studies have by default, and more.
    for machine in [3, 4, EPOCHS].into_iter().flat_map(|epochs| machines().map(move |m| Machine { epochs, ..m })) {
        let run = |random: &mut RandomOrder| mean_of(&[machine.ratio([3.0, 1.0], random)], Variance::NONE);
        as_promised(held(PAIRS, run), &format!("{machine:?}"));
    }
}

#[test]
fn rounds_filter_interruptions_and_without_them_long_ones_are_not_held() {
    let of = |rounds: usize, tail: f64| {
        let machine = Machine { rounds, tail, ..Machine::default() };
        held(PAIRS, |random| mean_of(&[machine.ratio([3.0, 1.0], random)], Variance::NONE))
    };
    as_promised(of(3, 0.1), "three rounds, interruptions of ten standard deviations");
    // A sample in eight that takes a third longer: rare in five samples, and ruinous where it comes.
    let (one, five) = (of(1, 0.3), of(5, 0.3));
    assert!(one < 90.0 && five > one + 4.0, "{one:.1} % of one round, {five:.1} % of five");
}

#[test]
fn that_of_a_longer_run_as_well() {
    let machine = Machine { placement: 0.02, ..Machine::default() };
    let once = |pair: &u64| {
        let mut random = RandomOrder::new(*pair);
        let mut run = || epoch_values(&[machine.ratio([3.0, 1.0], &mut random)]).unwrap();
        let (first, second) = (run(), [run(), run(), run(), run()].concat());
        Rerun::in_epochs(&first, second.len(), Variance::NONE).unwrap().plain().holds(mean(&second))
    };
    let held = (0..PAIRS).filter(once).count() as f64 * 100.0 / PAIRS as f64;
    as_promised(held, "runs of four times the epochs");
}

#[test]
fn other_intervals_do_not_hold_it() {
    let machine = Machine::default();
    // That of the mean over the epochs is for the mean and not for another run.
    let held = held(PAIRS, |random| {
        let of = mean_of(&[machine.ratio([3.0, 1.0], random)], Variance::NONE);
        Rerun { variance: of.variance.map(|variance| variance.times(std::f64::consts::FRAC_1_SQRT_2)), ..of }
    });
    assert!(held < 90.0, "{held:.1} %");
}

/// One run of two structures and, of the first, a twin, in so many cells: the ratios, and the A/A noise.
fn with_twins(machine: Machine, cells: usize, random: &mut RandomOrder) -> (Vec<Vec<Vec<f64>>>, AaNoise) {
    let [mut ratios, mut twins] = [vec![], vec![]];
    for _ in 0..cells {
        let logs = machine.cell(&[3.0, 1.0, 3.0], random);
        let over = |i: usize| -> Vec<Vec<f64>> {
            (0..EPOCHS).map(|e| logs[0][e].iter().zip(&logs[i][e]).map(|(a, b)| a - b).collect()).collect()
        };
        ratios.push(over(1));
        twins.push(over(2));
    }
    (ratios, AaNoise::new(&twins))
}

#[test]
fn what_whole_runs_differ_in_is_held_with_the_aa_noise_and_not_without() {
    // The standard error of a ratio is about 0.01 here: run luck of none of it, as much, and three times as much.
    for (run, cells) in [(0.0, 4), (0.0, 8), (0.007, 8), (0.02, 12)] {
        let machine = Machine { run, ..Machine::default() };
        let own = |random: &mut RandomOrder, noise: &dyn Fn(&AaNoise) -> Variance, all: bool| {
            let (ratios, twins) = with_twins(machine, cells, random);
            mean_of(if all { &ratios } else { &ratios[..1] }, noise(&twins))
        };
        let pairs = 2000;
        let of_one = held(pairs, |random| own(random, &AaNoise::of_ratio, false));
        let of_mean = held(pairs, |random| own(random, &|twins| twins.of_mean(cells), true));
        as_promised(of_one, &format!("single cells, run luck {run}, {cells} A/A ratios"));
        as_promised(of_mean, &format!("means, run luck {run}, {cells} A/A ratios"));
        if run > 0.01 {
            let without = held(pairs, |random| own(random, &|_| Variance::NONE, false));
            assert!(without < 75.0, "{without:.1} % without the A/A noise");
        }
    }
}

#[test]
fn a_single_aa_ratio_holds_what_it_can() {
    let of = |run: f64| {
        let machine = Machine { run, ..Machine::default() };
        held(PAIRS, |random| {
            let (ratios, twins) = with_twins(machine, 1, random);
            mean_of(&ratios, twins.of_ratio())
        })
    };
    as_promised(of(0.0), "one A/A ratio, no run luck");
    // One ratio does not tell how large a run's luck is: as much as the standard error is held a little too rarely.
    let some = of(0.007);
    assert!((91.0..=97.0).contains(&some), "{some:.1} %");
}

#[test]
fn more_cells_do_not_make_the_aa_noise_larger() {
    let machine = Machine { run: 0.01, ..Machine::default() };
    let noise = |cells: usize| {
        let mut random = RandomOrder::new(7);
        let squares = (0..200).map(|_| with_twins(machine, cells, &mut random).1.log().unwrap());
        libm::sqrt(squares.map(|log| log * log).sum::<f64>() / 200.0)
    };
    // Two builds of the same: the luck of a run twice.
    let expected = 0.01 * libm::sqrt(2.0);
    for cells in [8, 32] {
        assert!((noise(cells) / expected - 1.0).abs() < 0.12, "{cells} cells: {}", noise(cells));
    }
}

/// ln times of six meshes whose triangles grow by four: each with its own luck.
fn meshes(machine: Machine, random: &mut RandomOrder) -> Vec<Vec<f64>> {
    let times: Vec<f64> = (0..6).map(|i| libm::pow(4.0, 0.2 * f64::from(i))).collect();
    let values = |logs: &Vec<Vec<f64>>| logs.iter().map(|rounds| median(rounds).unwrap()).collect();
    machine.cell(&times, random).iter().map(values).collect()
}

fn slope(logs: &[f64]) -> f64 {
    let x = |i: usize| (i as f64 - 2.5) * libm::log(4.0);
    let squares: f64 = (0..logs.len()).map(|i| x(i) * x(i)).sum();
    logs.iter().enumerate().map(|(i, log)| x(i) * log).sum::<f64>() / squares
}

#[test]
fn slopes_are_held_and_the_jackknife_of_what_is_linear_is_its_value_in_each_epoch() {
    for machine in machines() {
        let run = |random: &mut RandomOrder| {
            let meshes = meshes(machine, random);
            let of_epoch = |e: usize| slope(&meshes.iter().map(|mesh| mesh[e]).collect::<Vec<_>>());
            let figure = |kept: &[usize]| {
                let mean = |mesh: &Vec<f64>| kept.iter().map(|&e| mesh[e]).sum::<f64>() / kept.len() as f64;
                Some(slope(&meshes.iter().map(mean).collect::<Vec<_>>()))
            };
            let values: Vec<f64> = (0..EPOCHS).map(of_epoch).collect();
            let (own, jackknifed) = (
                Rerun::of(&values, Variance::NONE).unwrap(),
                Rerun::jackknife(EPOCHS, Variance::NONE, figure).unwrap(),
            );
            let [low, other] = [own, jackknifed].map(|rerun| rerun.plain().low().unwrap());
            assert!((low - other).abs() < 1e-9, "{own:?} {jackknifed:?}");
            jackknifed
        };
        as_promised(held(PAIRS, run), &format!("slopes of {machine:?}"));
    }
}

/// What share of the squares of two effects is the first's: a half here, and both are of the size of ten standard
/// errors.
fn share(first: f64, second: f64) -> f64 {
    first * first / (first * first + second * second)
}

#[test]
fn shares_are_held_by_the_jackknife() {
    for placement in [0.0, 0.04, 0.1] {
        let machine = Machine { placement, ..Machine::default() };
        let effects = |random: &mut RandomOrder| {
            let mut of = |times| {
                let cell = machine.ratio(times, random);
                cell.iter().map(|rounds| median(rounds).unwrap()).collect::<Vec<f64>>()
            };
            [of([1.5, 1.0]), of([1.0, 1.3])]
        };
        let run = |random: &mut RandomOrder| {
            let effects = effects(random);
            let mean = |i: usize, kept: &[usize]| kept.iter().map(|&e| effects[i][e]).sum::<f64>() / kept.len() as f64;
            let figure = |kept: &[usize]| Some(share(mean(0, kept), mean(1, kept)));
            Rerun::jackknife(EPOCHS, Variance::NONE, figure).unwrap()
        };
        as_promised(held(PAIRS, run), &format!("shares, placement {placement}"));
    }
}

#[test]
fn all_of_many_hold_together_when_each_allows_for_the_others() {
    let machine = Machine::default();
    const LOOKS: usize = 20;
    let all = |looks: usize| {
        let once = |run: &u64| {
            let mut random = RandomOrder::new(*run);
            (0..LOOKS).all(|_| {
                let mut run = || mean_of(&[machine.ratio([1.0, 1.0], &mut random)], Variance::NONE).plain();
                let (first, second) = (run(), run());
                first.among(looks).holds(second.estimate)
            })
        };
        (0..400).filter(once).count() as f64 / 4.0
    };
    let (alone, together) = (all(1), all(LOOKS));
    assert!(alone < 50.0, "{alone} % at 95 % each");
    assert!((92.0..=98.0).contains(&together), "{together} % of all {LOOKS}");
}

#[test]
fn a_change_is_as_sure_as_both_runs() {
    let of = |old: &[f64], new: &[f64]| Rerun::change(old, new, [Variance::NONE; 2]).unwrap().plain();
    let exact = of(&[0.0; 5], &[0.1; 5]);
    assert!((exact.estimate - 0.1).abs() < 1e-12 && exact.low() == Some(exact.estimate));
    // Both spread alike, five epochs each: eight degrees of freedom, the error is that of one by the root of two.
    let spread = [-0.02, -0.01, 0.0, 0.01, 0.02];
    let half = |change: Estimate| change.high().unwrap() - change.estimate;
    let change = of(&spread, &spread.map(|x| x + 0.1));
    assert!((half(change) - 2.306 * 0.01 * libm::sqrt(2.5 / 5.0 * 2.0)).abs() < 1e-5, "{change:?}");
    // One of them without spread: four degrees are left.
    let change = of(&spread, &[0.1; 5]);
    assert!((half(change) - 2.776 * 0.01 * libm::sqrt(0.5)).abs() < 1e-5);
    // The noise of both runs is in it.
    let noise = Variance { square: 1e-4, freedom: 1e9 };
    let noisy = Rerun::change(&[0.0; 5], &[0.0; 5], [noise; 2]).unwrap().plain();
    assert!((half(noisy) - 1.96 * libm::sqrt(2e-4)).abs() < 1e-4);
    assert_eq!(Rerun::change(&[], &[0.0; 5], [Variance::NONE; 2]), None);
    assert_eq!(Rerun::change(&[0.0], &[0.0; 5], [Variance::NONE; 2]).unwrap().plain(), Estimate::alone(0.0));
}

#[test]
fn changes_are_held() {
    let machine = Machine { placement: 0.02, ..Machine::default() };
    let once = |run: &u64| {
        let mut random = RandomOrder::new(*run);
        let mut run = |times| epoch_values(&[machine.ratio(times, &mut random)]).unwrap();
        let (old, new) = (run([1.0, 1.0]), [run([1.1, 1.0]), run([1.1, 1.0])].concat());
        Rerun::change(&old, &new, [Variance::NONE; 2]).unwrap().plain().holds(libm::log(1.1))
    };
    let held = (0..PAIRS).filter(once).count() as f64 * 100.0 / PAIRS as f64;
    as_promised(held, "changes");
}

#[test]
fn cells_of_one_epoch_share_its_luck() {
    // Both cells are moved by the same epochs: the mean is as uncertain as either.
    let cell = |by: f64| -> Vec<Vec<f64>> { (0..EPOCHS).map(|e| vec![by + 0.01 * e as f64; 3]).collect() };
    let one = mean_of(&[cell(0.0)], Variance::NONE).ratio();
    let two = mean_of(&[cell(0.0), cell(1.0)], Variance::NONE).ratio();
    let width = |x: Estimate| libm::log(x.high().unwrap() / x.low().unwrap());
    assert!((width(one) - width(two)).abs() < 1e-12);
    assert!((two.estimate / one.estimate - libm::exp(0.5)).abs() < 1e-12);
    // t(4) s sqrt(2 / 5), s the deviation of 0, 1, 2, 3, 4 hundredths.
    let half = 2.776 * 0.01 * libm::sqrt(2.5) * libm::sqrt(0.4);
    assert!((width(one) - 2.0 * half).abs() < 1e-4, "{}", width(one));
}

#[test]
fn a_longer_run_is_easier_to_foresee() {
    let values: Vec<f64> = (0..EPOCHS).map(|e| 0.01 * e as f64).collect();
    let half = |epochs| Rerun::in_epochs(&values, epochs, Variance::NONE).unwrap().plain().high().unwrap() - 0.02;
    for epochs in [2, 5, 20] {
        let expected = 2.776 * 0.01 * libm::sqrt(2.5) * libm::sqrt(1.0 / 5.0 + 1.0 / epochs as f64);
        assert!((half(epochs) - expected).abs() < 1e-4, "{epochs}");
    }
}

#[test]
fn of_one_epoch_there_is_an_estimate_and_no_interval() {
    let cell = vec![[2.0, 2.1, 1.9, 2.0].map(libm::log).to_vec()];
    let one = mean_of(&[cell], Variance { square: 1.0, freedom: 1.0 }).ratio();
    assert!((one.estimate - 2.0).abs() < 1e-12 && one.interval.is_none(), "{one:?}");
    assert_eq!(Rerun::jackknife(1, Variance::NONE, |_| Some(3.0)).unwrap().plain(), Estimate::alone(3.0));
    assert_eq!((Rerun::of(&[], Variance::NONE), epoch_values(&[])), (None, None));
    assert_eq!(epoch_values(&[vec![vec![]]]), None);
    // What cannot be made without an epoch has no interval.
    let fragile = |kept: &[usize]| (kept.len() == 3).then_some(1.0);
    assert_eq!(Rerun::jackknife(3, Variance::NONE, fragile).unwrap().plain(), Estimate::alone(1.0));
}
