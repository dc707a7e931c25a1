//! Prediction intervals: the range of the same estimate in another run.
//!
//! A 95 % confidence interval of a mean contains the estimate of a second run in only about 83 % of runs (Cumming,
//! Williams, Fidler, "Replication and researchers' understanding of confidence intervals and standard error bars",
//! 2004). A prediction interval contains the estimate of the second run in 95 % of runs.
//!
//! **The model.** Each epoch is a separate process that rebuilds all structures. In each round of an epoch, every
//! structure is timed once on every workload. For two structures, y is ln(first time / second time) in the same round.
//! A process has one memory layout, so all rounds of an epoch share a placement effect (Kalibera, Jones, "Rigorous
//! benchmarking in reasonable time", 2013; Mytkowicz, Diwan, Hauswirth, Sweeney, "Producing wrong data without doing
//! anything obviously wrong", 2009).
//!
//! **The estimate.** z(e) is the median of y over the rounds of epoch e. For several cells (scenes, workloads), z(e) is
//! the mean of the medians of the cells. The estimate is exp(mean of z).
//!
//! **The interval.** With E epochs, the estimate has the variance s^2 / E, where s^2 is the sample variance of z. The
//! difference between the estimates of two runs has the variance 2 s^2 / E. Student's t with E - 1 degrees of freedom
//! gives the half-width t s sqrt(2 / E) (Hahn, Meeker, Escobar, "Statistical intervals", 2nd edition 2017, chapter 4:
//! prediction of the mean of a future sample).
//!
//! **The A/A noise.** Some effects differ between runs, but not between the epochs of one run.
//! [`AaNoise`](super::AaNoise) estimates these effects. The variance of these effects is added once for each of the two
//! runs.
//!
//! **Limits.** The intervals of epochs with one round are too narrow if many samples are interrupted.

use super::estimate::{Estimate, Interval};
use super::quantiles::{LEVEL, factor};
use super::summary::{Variance, mean, median};

/// Returns ln(numerator / denominator) of every round, by epoch. The samples are ordered by epoch and then by round.
///
/// # Panics
/// If the numbers of samples differ or are not a multiple of `epochs`, `epochs` is 0, or a sample is not positive.
pub fn log_ratios(numerator: &[f64], denominator: &[f64], epochs: usize) -> Vec<Vec<f64>> {
    assert_eq!(numerator.len(), denominator.len(), "samples come in pairs");
    assert!(epochs > 0 && numerator.len().is_multiple_of(epochs), "each epoch has the same number of rounds");
    assert!(numerator.iter().chain(denominator).all(|&t| t > 0.0), "samples must be positive");
    let logs: Vec<f64> = numerator.iter().zip(denominator).map(|(a, b)| libm::log(a / b)).collect();
    logs.chunks((logs.len() / epochs).max(1)).map(<[f64]>::to_vec).collect()
}

/// A mean over cells needs the same epochs in each cell. The first epochs stay, because a choice by results would bias
/// the mean.
pub fn cut_to_shared_epochs(cells: &mut [Vec<Vec<f64>>]) {
    let fewest = cells.iter().map(Vec::len).min().unwrap_or(0);
    cells.iter_mut().for_each(|cell| cell.truncate(fewest));
}

/// Returns z(e) of every epoch. Each cell is a result of [`log_ratios`].
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
    /// `values` has one value per epoch. `noise` is the variance that the [A/A noise](super::AaNoise) adds to one run.
    pub fn of(values: &[f64], noise: Variance) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let both = |run: Variance| run.times(std::f64::consts::SQRT_2);
        let variance = Variance::of_mean(values).map(|spread| Variance::sum(&[both(spread), both(noise)]));
        Some(Self { centre: mean(values), variance })
    }

    /// `old` and `new` are the epoch values of two runs. `noises` has the variance that the A/A noise adds to each run.
    pub fn change(old: &[f64], new: &[f64], noises: [Variance; 2]) -> Option<Self> {
        if old.is_empty() || new.is_empty() {
            return None;
        }
        let spreads = Variance::of_mean(old).zip(Variance::of_mean(new));
        let variance = spreads.map(|(old, new)| Variance::sum(&[old, new, noises[0], noises[1]]));
        Some(Self { centre: mean(new) - mean(old), variance })
    }

    /// The same variance around `centre`, an estimate from more epochs.
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
