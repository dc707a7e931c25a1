//! Prediction intervals for the estimate of a second run.
//!
//! On average, a 95 % confidence interval contains the mean of a second run with a probability of only 83 % (Cumming,
//! Williams, Fidler, "Replication and researchers' understanding of confidence intervals and standard error bars",
//! 2004). A 95 % prediction interval contains the mean of a second run with a probability of 95 %.
//!
//! **The model.** Each epoch is a separate process that rebuilds all structures. In each round of an epoch, every
//! structure is timed once on every workload. For structures A and B on one workload, y is ln(time of A / time of B) in
//! one round: a slow phase of the machine affects the two times equally and cancels. All rounds of an epoch share the
//! effect of one memory layout (Kalibera, Jones, "Rigorous benchmarking in reasonable time", 2013; Mytkowicz, Diwan,
//! Hauswirth, Sweeney, "Producing wrong data without doing anything obviously wrong", 2009).
//!
//! **The estimate.** z(e) is the median of y over the rounds of epoch e. A cell is one workload of one scene. For
//! several cells, z(e) is the mean of the medians of all cells. The estimate is the mean of z over all epochs. Medians
//! resist the heavy tails of the noise.
//!
//! **The interval.** Let s^2 be the sample variance of z over E epochs. The variance of the estimate is s^2 / E. The
//! difference between the estimates of two runs of E epochs has the variance 2 s^2 / E. Student's t with E - 1 degrees
//! of freedom gives the half-width t s sqrt(2 / E) (Hahn, Meeker, Escobar, "Statistical intervals", 2nd edition 2017,
//! chapter 4: prediction of the mean of a future sample). A single epoch gives no interval.
//!
//! **The A/A noise.** Some effects on the times vary between runs, not between the epochs of a run.
//! [`AaNoise`](super::AaNoise) estimates the variance of these effects. The variance of the difference includes this
//! variance once for each of the two runs.
//!
//! **Limits.** With one round per epoch, frequent long interruptions make the intervals too narrow. A single A/A ratio
//! is not enough if the effects of whole runs dominate.

use super::estimate::{Estimate, Interval};
use super::quantiles::{LEVEL, factor};
use super::summary::{Variance, mean, median};

/// Returns ln(numerator / denominator) of every round, grouped by epoch. Both slices must be sorted by epoch and round.
///
/// # Panics
/// If `epochs` is 0, the slices differ in length, the length is no multiple of `epochs`, or a sample is not positive.
pub fn log_ratios(numerator: &[f64], denominator: &[f64], epochs: usize) -> Vec<Vec<f64>> {
    assert_eq!(numerator.len(), denominator.len(), "samples come in pairs");
    assert!(epochs > 0 && numerator.len().is_multiple_of(epochs), "each epoch has the same number of rounds");
    assert!(numerator.iter().chain(denominator).all(|&t| t > 0.0), "samples must be positive");
    let logs: Vec<f64> = numerator.iter().zip(denominator).map(|(a, b)| libm::log(a / b)).collect();
    logs.chunks((logs.len() / epochs).max(1)).map(<[f64]>::to_vec).collect()
}

/// Truncates every cell to the length of the shortest cell. A choice of epochs by their results would bias means.
pub fn cut_to_shared_epochs(cells: &mut [Vec<Vec<f64>>]) {
    let fewest = cells.iter().map(Vec::len).min().unwrap_or(0);
    cells.iter_mut().for_each(|cell| cell.truncate(fewest));
}

/// Returns the z(e) of the [module documentation](self) for every epoch e. Each cell is a result of [`log_ratios`].
///
/// # Panics
/// If the cells differ in their number of epochs.
pub fn epoch_values(cells: &[Vec<Vec<f64>>]) -> Option<Vec<f64>> {
    let epochs = cells.first()?.len();
    assert!(cells.iter().all(|cell| cell.len() == epochs), "all cells have the same epochs");
    let of = |e: usize| -> Option<f64> {
        let middles: Option<Vec<f64>> = cells.iter().map(|cell| median(&cell[e])).collect();
        middles.map(|middles| mean(&middles))
    };
    (0..epochs).map(of).collect::<Option<Vec<f64>>>().filter(|values| !values.is_empty())
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rerun {
    centre: f64,
    /// The variance of the difference between the estimates of two runs.
    variance: Option<Variance>,
}

impl Rerun {
    /// `values` has one value per epoch. `noise` is the [A/A noise](super::AaNoise) of one run. The second run must
    /// have as many epochs.
    pub fn of(values: &[f64], noise: Variance) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let both = |run: Variance| run.times(std::f64::consts::SQRT_2);
        let variance = Variance::of_mean(values).map(|spread| Variance::sum(&[both(spread), both(noise)]));
        Some(Self { centre: mean(values), variance })
    }

    /// `old` and `new` are the [`epoch_values`] of two runs. `noises` contains the A/A noise of each run.
    pub fn change(old: &[f64], new: &[f64], noises: [Variance; 2]) -> Option<Self> {
        if old.is_empty() || new.is_empty() {
            return None;
        }
        let spreads = Variance::of_mean(old).zip(Variance::of_mean(new));
        let variance = spreads.map(|(old, new)| Variance::sum(&[old, new, noises[0], noises[1]]));
        Some(Self { centre: mean(new) - mean(old), variance })
    }

    #[must_use]
    pub fn around(self, centre: f64) -> Self {
        Self { centre, ..self }
    }

    pub fn plain(&self) -> Estimate {
        let interval = self.variance.map(|Variance { square, freedom }| {
            let half = if square > 0.0 { factor(freedom, LEVEL) * libm::sqrt(square) } else { 0.0 };
            Interval { low: self.centre - half, high: self.centre + half, freedom }
        });
        Estimate { estimate: self.centre, interval }
    }

    pub fn ratio(&self) -> Estimate {
        self.plain().map(libm::exp)
    }
}

#[cfg(test)]
mod tests;
