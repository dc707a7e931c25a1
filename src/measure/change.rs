//! What changed between two runs.

use super::replication::{epoch_values, mean, standard_error};
use super::student::{LEVEL, factor};
use super::summary::Interval;

/// The geometric mean over cells of new / old, with its 95 % interval, where `old` and `new` are the cells of two runs, each what
/// [`log_ratios`](super::log_ratios) gives of a quantity to that of a reference in the same run.
///
/// Runs of different moments share no round: what slowed the machine in one of them cancels only within it, between a case
/// and its reference. The epochs of each run are independent samples of its figure, so the difference of the means is held by
/// the test of two samples with different spreads (Welch, "The generalization of Student's problem when several different
/// population variances are involved", 1947), with `floor`, a logarithm, joined in quadrature for what processes differ in.
///
/// Nothing when a run has no cell, a cell is empty, or there are less than two epochs and less than two rounds.
///
/// # Panics
/// If the cells of one run differ in their epochs.
pub fn change(old: &[Vec<Vec<f64>>], new: &[Vec<Vec<f64>>], floor: f64) -> Option<Interval> {
    let (old, new) = (epoch_values(old)?, epoch_values(new)?);
    let errors = [standard_error(&old)?, standard_error(&new)?].map(|error| error * error);
    let variance = errors[0] + errors[1];
    let half = if variance > 0.0 {
        let share = |i: usize, n: usize| errors[i] * errors[i] / (n - 1) as f64;
        let freedom = variance * variance / (share(0, old.len()) + share(1, new.len()));
        factor(freedom.max(1.0), LEVEL) * libm::sqrt(variance)
    } else {
        0.0
    };
    let (centre, half) = (mean(&new) - mean(&old), libm::hypot(half, floor));
    let [estimate, low, high] = [centre, centre - half, centre + half].map(libm::exp);
    Some(Interval { estimate, low, high })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::RandomOrder;

    fn cell(values: &[f64]) -> Vec<Vec<f64>> {
        values.iter().map(|&value| vec![value; 3]).collect()
    }

    #[test]
    fn a_change_is_as_sure_as_both_runs() {
        let change = |old: &[f64], new: &[f64], floor| change(&[cell(old)], &[cell(new)], floor).unwrap();
        let exact = change(&[0.0; 5], &[libm::log(1.1); 5], 0.0);
        assert!((exact.estimate - 1.1).abs() < 1e-12 && exact.low == exact.estimate && exact.high == exact.low);
        let floored = change(&[0.0; 5], &[0.0; 5], 0.02);
        assert!((floored.high - libm::exp(0.02)).abs() < 1e-12);
        // Both spread alike, five epochs each: eight degrees of freedom, the error is that of one by the root of two.
        let spread = [-0.02, -0.01, 0.0, 0.01, 0.02];
        let interval = change(&spread, &spread.map(|x| x + 0.1), 0.0);
        let half = factor(8.0, LEVEL) * 0.01 * libm::sqrt(2.5 / 5.0 * 2.0);
        assert!((libm::log(interval.high) - 0.1 - half).abs() < 1e-12, "{interval:?}");
        // One of them without spread: four degrees are left.
        let interval = change(&spread, &[0.1; 5], 0.0);
        assert!((libm::log(interval.high) - 0.1 - factor(4.0, LEVEL) * 0.01 * libm::sqrt(0.5)).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_there_has_not_changed() {
        assert_eq!(change(&[], &[cell(&[0.0; 5])], 0.0), None);
        assert_eq!(change(&[vec![vec![0.0]]], &[cell(&[0.0; 5])], 0.0), None, "a single sample");
        // With one epoch its rounds have to do.
        assert!(change(&[vec![vec![0.0, 0.1]]], &[cell(&[0.0; 5])], 0.0).is_some());
    }

    #[test]
    fn nineteen_in_twenty_intervals_hold_the_change() {
        let mut random = RandomOrder::new(5);
        let mut run = |centre: f64, deviation: f64, epochs: usize| -> Vec<Vec<f64>> {
            let mut normal = || (0..12).map(|_| random.below(1 << 20) as f64 / f64::from(1 << 20)).sum::<f64>() - 6.0;
            (0..epochs).map(|_| vec![centre + deviation * normal()]).collect()
        };
        let held = (0..400).filter(|_| {
            let interval = change(&[run(0.0, 0.03, 8)], &[run(0.1, 0.01, 5)], 0.0).unwrap();
            (interval.low..=interval.high).contains(&libm::exp(0.1))
        });
        let n = held.count();
        assert!((367..=394).contains(&n), "{n} of 400");
    }
}
