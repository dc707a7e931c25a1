//! Reduces the samples of several structures to one value per structure and epoch.

use crate::measure::{Estimate, Rerun, Variance, median};

/// Returns one log time per epoch and structure. `epochs` contains log times, indexed by epoch, structure and round.
///
/// Some disturbances slow all structures of a round. So the median shift of the structures is subtracted from all
/// samples of the round.
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

/// `of` computes a log ratio from one row of `epoch_medians`.
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
        // The second round is slower by 5 for all structures. One sample of the third round is slower by 40.
        let epoch = vec![vec![1.0, 6.0, 1.0], vec![2.0, 7.0, 42.0], vec![3.0, 8.0, 3.0]];
        let values = epoch_medians(vec![epoch.clone(), epoch]);
        assert_eq!(values, [[1.0, 2.0, 3.0], [1.0, 2.0, 3.0]]);
        assert_eq!(epoch_medians(vec![vec![vec![1.0], vec![3.0]]]), [[1.0, 3.0]], "one round is itself");
    }
}
