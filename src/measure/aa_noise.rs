//! The A/A noise, estimated from the times of two builds of the same structure.

use super::estimate::Estimate;
use super::interval::{Rerun, epoch_values};
use super::summary::{Variance, mean};

/// The **A/A noise** is the size of timing effects that differ between runs, but not between the epochs of a run.
///
/// # References
/// Georges, Buytaert, Eeckhout: Statistically rigorous Java performance evaluation. 2007 (comparison of alternatives).
#[derive(Clone, Debug, PartialEq)]
pub struct AaNoise {
    /// Each cell has one time ratio of two builds of the same structure. Without noise, each ratio is 1. The
    /// prediction intervals of the ratios do not include the A/A noise.
    pub ratios: Vec<Estimate>,
    noise: Variance,
}

impl Default for AaNoise {
    fn default() -> Self {
        Self { ratios: vec![], noise: Variance::NONE }
    }
}

impl AaNoise {
    /// Each cell contains the [log ratios](super::log_ratios) of two builds of the same structure.
    pub fn new(cells: &[Vec<Vec<f64>>]) -> Self {
        let (mut ratios, mut squares) = (vec![], vec![]);
        for values in cells.iter().filter_map(|cell| epoch_values(std::slice::from_ref(cell))) {
            let sampling = Variance::of_mean(&values).map_or(0.0, |variance| variance.square);
            squares.push(mean(&values) * mean(&values) - sampling);
            ratios.extend(Rerun::of(&values, Variance::NONE).map(|rerun| rerun.ratio()));
        }
        if squares.is_empty() {
            return Self::default();
        }
        // `freedom` is at least the number of epochs minus 1, to avoid very wide intervals.
        let epochs = cells.iter().map(Vec::len).max().unwrap_or(0);
        let freedom = squares.len().max(epochs.saturating_sub(1)).max(1) as f64;
        Self { ratios, noise: Variance { square: mean(&squares).max(0.0), freedom } }
    }

    /// The A/A noise, as a standard deviation of ln(ratio).
    pub fn log(&self) -> Option<f64> {
        (!self.ratios.is_empty()).then(|| libm::sqrt(self.noise.square))
    }

    pub fn of_ratio(&self) -> Variance {
        self.weighted(&[1.0, -1.0])
    }

    /// The cells must be independent.
    pub fn of_mean(&self, cells: usize) -> Variance {
        self.of_ratio().times(1.0 / libm::sqrt(cells.max(1) as f64))
    }

    /// The variance that the A/A noise adds to a weighted sum of log times. No two times may be of the same build.
    pub fn weighted(&self, weights: &[f64]) -> Variance {
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        self.noise.times(libm::sqrt(squares / 2.0))
    }

    /// Returns the number of ratios whose interval contains 1, and the number of intervals.
    pub fn containing_one(&self) -> Option<(usize, usize)> {
        let known = self.ratios.iter().filter(|ratio| ratio.interval.is_some());
        let holding = known.clone().filter(|ratio| ratio.holds(1.0)).count();
        Some((holding, known.count())).filter(|&(_, known)| known > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn twins(logs: &[f64]) -> AaNoise {
        AaNoise::new(&logs.iter().map(|&log| vec![vec![log; 3]; 5]).collect::<Vec<_>>())
    }

    #[test]
    fn it_is_a_root_mean_square_and_does_not_grow_with_the_cells() {
        assert_eq!((twins(&[]).log(), twins(&[]).of_ratio().square), (None, 0.0));
        let one = twins(&[0.01, -0.03, 0.02]);
        assert!((one.log().unwrap() - libm::sqrt(14e-4 / 3.0)).abs() < 1e-12);
        let many = twins(&[0.01, -0.03, 0.02].repeat(20));
        assert!((many.log().unwrap() - one.log().unwrap()).abs() < 1e-12);
        assert_eq!((one.of_ratio().freedom, many.of_ratio().freedom), (4.0, 60.0));
        assert_eq!((one.containing_one(), twins(&[0.0]).containing_one()), (Some((0, 3)), Some((1, 1))));
    }

    #[test]
    fn what_epochs_explain_is_left_out() {
        let epochs = [-0.02, 0.01, 0.04, 0.01].map(|log| vec![log]);
        let error = Variance::of_mean(&epochs.concat()).unwrap().square;
        let noise = AaNoise::new(&[epochs.to_vec()]);
        assert!(error > 1e-4 && noise.log() == Some(0.0), "{error} {noise:?}");
    }

    #[test]
    fn one_epoch_has_noise_and_no_intervals() {
        let noise = AaNoise::new(&[vec![vec![0.01, 0.03]]]);
        assert!((noise.log().unwrap() - 0.02).abs() < 1e-12);
        assert_eq!(noise.containing_one(), None);
        let both = AaNoise::new(&[vec![vec![0.01, 0.03]], vec![vec![0.0; 3]; 5]]);
        assert_eq!((both.ratios.len(), both.containing_one()), (2, Some((1, 1))));
        let noise = twins(&[0.02; 4]);
        let squares = [noise.of_ratio(), noise.of_mean(4), noise.weighted(&[2.0])].map(|variance| variance.square);
        assert!(squares.iter().zip([4e-4, 1e-4, 8e-4]).all(|(one, other)| (one - other).abs() < 1e-12), "{squares:?}");
    }
}
