//! Reduces the samples of several structures to one value per structure and epoch.

use crate::measure::{Estimate, Rerun, Variance, median};

/// One log time per epoch and structure. `epochs` contains the log times of all samples, by epoch, structure and round.
///
/// Some disturbances slow all structures of a round. The disturbance of a round is the median, over the structures, of
/// the sample minus the median of the structure. It is subtracted from all samples of the round. The value of a
/// structure is then the median over its rounds.
pub(super) fn epoch_medians(mut epochs: Vec<Vec<Vec<f64>>>) -> Vec<Vec<f64>> {
    let middle = |values: &[f64]| median(values).expect("a structure has samples");
    let rounds = |trees: &[Vec<f64>]| trees.iter().map(Vec::len).min().unwrap_or(0);
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

/// exp(mean over epochs of `of(values of an epoch)`), with its interval. The A/A noise adds the variance `noise`.
pub(super) fn ratio(epoch_medians: &[Vec<f64>], of: impl Fn(&[f64]) -> f64, noise: Variance) -> Estimate {
    Rerun::of(&values(epoch_medians, of), noise).expect("there is an epoch").ratio()
}

pub(super) fn values(epoch_medians: &[Vec<f64>], of: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    epoch_medians.iter().map(|logs| of(logs)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_round_is_taken_out_and_a_slow_sample_is_outvoted() {
        // Three structures in three rounds. The whole second round is slower by 5; one sample of the third by 40.
        let epoch = vec![vec![1.0, 6.0, 1.0], vec![2.0, 7.0, 42.0], vec![3.0, 8.0, 3.0]];
        let values = epoch_medians(vec![epoch.clone(), epoch]);
        assert_eq!(values, [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]]);
        assert_eq!(epoch_medians(vec![vec![vec![1.0], vec![3.0]]]), [[1.0, 3.0]], "one round is itself");
    }
}
