//! From the samples of several structures to values that are independent of each other.

use crate::measure::{Interval, median, replication};

/// Logarithms, one for each structure: once for each epoch; or once for each round where there is one epoch alone. Given are the
/// logarithms of all samples: of each epoch, of each structure.
///
/// Within an epoch, what slowed a whole round is taken out (the median over the structures of how far each is off its own
/// median), then each structure has the median of its rounds. Figures that are sums over these add up exactly, replicate by
/// replicate.
///
/// # Panics
/// If a structure has no samples.
pub(super) fn replicates(mut epochs: Vec<Vec<Vec<f64>>>) -> Vec<Vec<f64>> {
    let middle = |values: &[f64]| median(values).expect("a structure has samples");
    let rounds = |trees: &[Vec<f64>]| trees.iter().map(Vec::len).min().unwrap_or(0);
    if let [only] = &epochs[..] {
        return (0..rounds(only)).map(|r| only.iter().map(|tree| tree[r]).collect()).collect();
    }
    for trees in &mut epochs {
        let centres: Vec<f64> = trees.iter().map(|tree| middle(tree)).collect();
        for round in 0..rounds(trees) {
            let shifts: Vec<f64> = trees.iter().zip(&centres).map(|(tree, centre)| tree[round] - centre).collect();
            let shift = middle(&shifts);
            trees.iter_mut().for_each(|tree| tree[round] -= shift);
        }
    }
    epochs.iter().map(|trees| trees.iter().map(|tree| middle(tree)).collect()).collect()
}

/// The interval of e to the power of what `of` makes of a replicate.
///
/// # Panics
/// If there is no replicate.
pub(super) fn interval(replicates: &[Vec<f64>], of: impl Fn(&[f64]) -> f64, floor: f64, seed: u64) -> Interval {
    replication(&[values(replicates, of)], floor, seed).expect("there is a replicate")
}

/// What `of` makes of each replicate, as a cell of [`replication`].
pub(super) fn values(replicates: &[Vec<f64>], of: impl Fn(&[f64]) -> f64) -> Vec<Vec<f64>> {
    replicates.iter().map(|logs| vec![of(logs)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_round_is_taken_out_and_a_slow_sample_is_outvoted() {
        // Three structures, three rounds; the second round is slower by 5 throughout, one sample by 40.
        let epoch = vec![vec![1.0, 6.0, 1.0], vec![2.0, 7.0, 42.0], vec![3.0, 8.0, 3.0]];
        let values = replicates(vec![epoch.clone(), epoch]);
        assert_eq!(values, [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]]);
    }

    #[test]
    fn of_one_epoch_the_rounds_are_replicates() {
        assert_eq!(replicates(vec![vec![vec![1.0, 2.0], vec![3.0, 5.0]]]), [[1.0, 3.0], [2.0, 5.0]]);
    }

    #[test]
    fn the_interval_is_that_of_a_power() {
        let interval = interval(&[vec![1.0], vec![1.0]], |logs| logs[0], 0.0, 1);
        assert_eq!(interval.estimate, libm::exp(1.0));
        assert!(interval.low <= interval.estimate && interval.estimate <= interval.high);
    }
}
