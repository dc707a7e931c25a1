//! Prediction intervals: the range of the same estimate in another run. All tables, studies and pages use them.
//!
//! **The question.** A 95 % confidence interval of a mean contains the true mean in 95 % of runs, but the *estimate of
//! a second run* only in about 83 %, because that estimate varies as well (Cumming, Williams, Fidler, "Replication and
//! researchers' understanding of confidence intervals and standard error bars", 2004). The intervals here are
//! prediction intervals for the estimate of another run of the same plan: they contain that estimate in 95 % of cases.
//!
//! **The model.** Each epoch e is a separate process that rebuilds all structures. In each round r of an epoch every
//! structure is timed once on every workload: workloads in random order, and the structures of a workload in random
//! order. For two structures on a workload let y = ln(first time / second time) in the same round: a slow phase of the
//! machine affects both times and cancels. Then y = theta + p(e) + n(e, r), where theta is the true log ratio. The
//! placement effect p is the same for a whole epoch, because a process has one layout of address space, stack and heap
//! (Kalibera, Jones, "Rigorous benchmarking in reasonable time", 2013; Mytkowicz, Diwan, Hauswirth, Sweeney, "Producing
//! wrong data without doing anything obviously wrong", 2009). The noise n of a sample has heavy tails.
//!
//! **The estimate.** z(e) is the median of y over the rounds of an epoch, because heavy tails hardly move a median. The
//! estimate is exp(mean of z). For several cells (scenes, workloads) z(e) is the mean of their medians. Cells of the
//! same epoch share a placement effect; the spread of z contains this correlation without a model of it.
//!
//! **The interval.** With E epochs the variance of an estimate is s^2 / E, where s^2 is the sample variance of z, which
//! includes placement and noise. Another run varies as much, independently, so the difference of the two estimates has
//! variance 2 s^2 / E. Divided by s sqrt(2 / E), the difference follows Student's t with E - 1 degrees of freedom: the
//! half-width is t(E - 1) s sqrt(2 / E) (Hahn, Meeker, Escobar, "Statistical intervals", 2nd edition 2017, chapter 4:
//! prediction of the mean of a future sample).
//!
//! **The A/A noise.** Effects that differ between two runs, but not between the epochs of one run, do not show in the
//! spread of z. The ratios of a structure to its twin show a part of these effects, the [A/A noise](super::AaNoise).
//! Its variance is added once for each of the two runs, and the sum has the degrees of freedom of Satterthwaite (1946).
//!
//! **One epoch** does not show placement effects: it gives an estimate and no interval.
//!
//! **Multiple comparisons.** If m findings are judged together, each has an interval of the level 1 - 0.05 / m
//! ([`Estimate::among`], Bonferroni): in 95 % of cases all m intervals are correct.
//!
//! The tests simulate thousands of pairs of runs with placement effects, heavy tails, drift and A/A noise, and count
//! how often the second estimate lies within the first interval: in 93 to 97 % of pairs, for one cell and many cells.
//! Known limits: if one sample in eight takes up to a third longer, the interval of five epochs of one round contains
//! only 86 % of the second estimates. A single A/A ratio is not enough if the effects of whole runs dominate.

use super::estimate::{Estimate, Interval};
use super::quantiles::{LEVEL, factor};
use super::summary::{Variance, mean, median};

/// ln(numerator / denominator) of every round, by epoch. The samples are in the order of the rounds, epoch by epoch;
/// each epoch has the same number of rounds.
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

/// Cuts all cells to the number of epochs of the shortest cell, because a mean over cells needs the same epochs in each
/// cell. The first epochs stay: a choice by results would bias the mean.
pub fn cut_to_shared_epochs(cells: &mut [Vec<Vec<f64>>]) {
    let fewest = cells.iter().map(Vec::len).min().unwrap_or(0);
    cells.iter_mut().for_each(|cell| cell.truncate(fewest));
}

/// z(e) of every epoch: the mean over the cells of the median log ratio over the rounds. A cell is a result of
/// [`log_ratios`]. `None` without cells or epochs, or if an epoch has no rounds.
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

/// The estimate of a run, and how much the estimate of another run varies around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rerun {
    centre: f64,
    /// The variance of the difference between the estimates of two runs; `None` with a single epoch.
    variance: Option<Variance>,
}

impl Rerun {
    /// The mean of `values`, one per epoch, and its variation in another run with as many epochs. `noise` is the
    /// variance that the [A/A noise](super::AaNoise) adds to one run. `None` without epochs.
    pub fn of(values: &[f64], noise: Variance) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let both = |run: Variance| run.times(std::f64::consts::SQRT_2);
        let variance = Variance::of_mean(values).map(|spread| Variance::sum(&[both(spread), both(noise)]));
        Some(Self { centre: mean(values), variance })
    }

    /// The mean of `new` minus the mean of `old`, the epoch values of two runs. `noises` has the variance that the A/A
    /// noise adds to each run. `None` if a run has no epochs. If a run has a single epoch, there is no variance.
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

    /// The estimate with its interval.
    pub fn plain(&self) -> Estimate {
        let interval = self.variance.map(|Variance { square, freedom }| {
            let half = if square > 0.0 { factor(freedom, LEVEL) * libm::sqrt(square) } else { 0.0 };
            Interval { low: self.centre - half, high: self.centre + half, freedom }
        });
        Estimate { estimate: self.centre, interval }
    }

    /// The exponential of the estimate, with its interval: a ratio, if the estimate is a log ratio.
    pub fn ratio(&self) -> Estimate {
        self.plain().map(libm::exp)
    }
}

#[cfg(test)]
mod tests;
