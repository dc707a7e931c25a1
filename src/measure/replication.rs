//! Intervals of ratios that say what the same run would find another time.
//!
//! **The question.** A plain 95 % interval of a mean holds the true mean in 95 % of runs, but the *estimate of a second run*
//! only in about 83 %, for that errs as well (Cumming, Williams, Fidler, "Replication and researchers' understanding of
//! confidence intervals and standard error bars", 2004). What is printed here is a prediction interval for the estimate of
//! another run of the same plan: it holds that estimate in 95 % of cases.
//!
//! **The model.** In epoch e all structures are built anew; in round r of it every case is timed once, in random order. For
//! two cases let y = ln(time of one / time of the other) in the same round: what slows the machine for a while slows both and
//! cancels. Then y = theta + p(e) + n(e, r), where p is the luck of placement, the same for a whole epoch (Kalibera, Jones,
//! "Rigorous benchmarking in reasonable time", 2013; Mytkowicz, Diwan, Hauswirth, Sweeney, "Producing wrong data without doing
//! anything obviously wrong", 2009), and n the noise of a sample, with heavy tails.
//!
//! **The estimate.** z(e) is the median of y over the rounds of an epoch, which heavy tails hardly move; the estimate is
//! exp(mean of z). Over several cells (scenes, kinds of rays) z(e) is the mean of their medians: cells that were measured
//! in the same epoch share its luck, and the spread of z holds that without a word about correlations.
//!
//! **The interval.** With E epochs the variance of an estimate is s^2 / E, where s^2 is the sample variance of z, which holds
//! placement and noise both. Another run errs as much again, independently, so the difference of the two estimates has variance
//! 2 s^2 / E, and with s from E epochs it follows Student's t with E - 1 degrees of freedom: the half-width is t(E - 1) s sqrt(2 / E)
//! (Hahn, Meeker, Escobar, "Statistical intervals", 2nd edition 2017, chapter 4: prediction of the mean of a
//! future sample). Medians
//! of lopsided noise are lopsided: where a percentile bootstrap that draws epochs, then rounds within them (Efron, "Bootstrap
//! methods", 1979; Davison, Hinkley, "Bootstrap methods and their application", 1997, section 3.8), reaches farther, its end
//! counts. On five epochs alone that bootstrap would be too narrow by a third.
//!
//! **The floor.** What differs between two processes but not between two epochs of one (where the code lies in memory, which
//! other programs run) no run can see in its own spread. The A/A ratios see a part of it: their
//! [floor](super::NoiseFloor) is joined to the half-width in quadrature.
//!
//! **One epoch** says nothing of placement: then the rounds take the place of epochs, and the interval is for another run that
//! happens to be placed alike. **One sample** says nothing of either: its interval reaches from next to nothing to all.
//!
//! The tests simulate pairs of runs with placement luck, heavy tails and drift: these intervals hold the second estimate in 95 %
//! and more, plain bootstrap intervals in fewer than 85 %.

use super::RandomOrder;
use std::borrow::Cow;

use super::student::{LEVEL, factor};
use super::summary::{Interval, median};

/// ln(numerator / denominator) of every round, epoch by epoch, for samples in the order taken, `epochs` times as many rounds.
///
/// # Panics
/// If the numbers of samples differ or are no multiple of `epochs`, or a sample is not positive.
pub fn log_ratios(numerator: &[f64], denominator: &[f64], epochs: usize) -> Vec<Vec<f64>> {
    assert_eq!(numerator.len(), denominator.len(), "samples come in pairs");
    assert!(epochs > 0 && numerator.len().is_multiple_of(epochs), "every epoch has as many rounds");
    assert!(numerator.iter().chain(denominator).all(|&t| t > 0.0), "a sample takes time");
    let logs: Vec<f64> = numerator.iter().zip(denominator).map(|(a, b)| libm::log(a / b)).collect();
    logs.chunks((logs.len() / epochs).max(1)).map(<[f64]>::to_vec).collect()
}

/// The geometric mean over `cells` of their ratios, with the interval that holds the same figure of another run in 95 % of cases;
/// the [module](self) derives it. A cell is what [`log_ratios`] gives; `floor` is that of the A/A ratios, as a logarithm, 0
/// where there are none. Nothing when there is no cell or one is empty.
///
/// # Panics
/// If the cells differ in their epochs.
pub fn replication(cells: &[Vec<Vec<f64>>], floor: f64, seed: u64) -> Option<Interval> {
    prediction(cells, cells.first()?.len(), floor, seed)
}

/// As [`replication`], for the figure of a run with `epochs` epochs, which errs less the more it has: with E epochs here the half-width is
/// t(E - 1) s sqrt(1 / E + 1 / `epochs`).
///
/// # Panics
/// If the cells differ in their epochs.
pub fn prediction(cells: &[Vec<Vec<f64>>], epochs: usize, floor: f64, seed: u64) -> Option<Interval> {
    let values = epoch_values(cells)?;
    let one = cells[0].len() == 1;
    // How much more a difference of the two figures varies than this figure.
    let both = if one || epochs == 0 { 2.0 } else { 1.0 + values.len() as f64 / epochs as f64 };
    let cells = &by_round(cells)[..];
    let centre = if one { middle(cells) } else { mean(&values) };
    let (low, high) = ends(&values, centre, both, cells, seed);
    Some(Interval {
        estimate: libm::exp(centre),
        low: libm::exp(centre - libm::hypot(low, floor)),
        high: libm::exp(centre + libm::hypot(high, floor)),
    })
}

/// The cells; where they have one epoch, its rounds stand for epochs, as many as all cells have.
fn by_round(cells: &[Vec<Vec<f64>>]) -> Cow<'_, [Vec<Vec<f64>>]> {
    if cells.iter().any(|cell| cell.len() != 1) {
        return Cow::Borrowed(cells);
    }
    let rounds = cells.iter().map(|cell| cell[0].len()).min().unwrap_or(0);
    cells.iter().map(|cell| (0..rounds).map(|r| vec![cell[0][r]]).collect()).collect()
}

/// Of each epoch, or of each round where there is one epoch: the mean over the cells of the median of its rounds, a logarithm.
/// Nothing when there is no cell or one is empty.
///
/// # Panics
/// If the cells differ in their epochs.
pub fn epoch_values(cells: &[Vec<Vec<f64>>]) -> Option<Vec<f64>> {
    let epochs = cells.first()?.len();
    assert!(cells.iter().all(|cell| cell.len() == epochs), "all cells have the same epochs");
    if epochs == 0 || cells.iter().flatten().any(Vec::is_empty) {
        return None;
    }
    let cells = by_round(cells);
    let of = |e: usize| mean(&cells.iter().map(|cell| middle_of(&cell[e])).collect::<Vec<_>>());
    Some((0..cells[0].len()).map(of).collect())
}

/// Resamples of a bootstrap: the ends of a 95 % interval are then the 50th value from either end.
const RESAMPLES: usize = 2000;

/// Half the width, a logarithm, of an interval that nothing is known of: a single sample may be anything.
const UNKNOWN: f64 = 600.0;

/// Distances of the ends from the centre: by Student's t, or by the bootstrap where that reaches farther.
fn ends(values: &[f64], centre: f64, both: f64, cells: &[Vec<Vec<f64>>], seed: u64) -> (f64, f64) {
    let Some(error) = standard_error(values) else { return (UNKNOWN, UNKNOWN) };
    let half = factor(values.len() as f64 - 1.0, LEVEL) * libm::sqrt(both) * error;

    let mut random = RandomOrder::new(seed);
    let mut draws: Vec<f64> = (0..RESAMPLES).map(|_| resampled(cells, &mut random)).collect();
    draws.sort_unstable_by(f64::total_cmp);
    let tail = RESAMPLES / 40;
    (half.max(centre - draws[tail]), half.max(draws[RESAMPLES - 1 - tail] - centre))
}

/// The estimate from epochs drawn with replacement, the same for all cells, and rounds drawn within them.
fn resampled(cells: &[Vec<Vec<f64>>], random: &mut RandomOrder) -> f64 {
    let epochs = cells[0].len();
    let mut sum = 0.0;
    for _ in 0..epochs {
        let epoch = random.below(epochs);
        for cell in cells {
            let rounds = &cell[epoch];
            let drawn: Vec<f64> = rounds.iter().map(|_| rounds[random.below(rounds.len())]).collect();
            sum += middle_of(&drawn);
        }
    }
    sum / (epochs * cells.len()) as f64
}

/// The standard error of the mean of `values`; nothing of fewer than two.
pub fn standard_error(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let centre = mean(values);
    let squares: f64 = values.iter().map(|v| (v - centre) * (v - centre)).sum();
    (values.len() > 1).then(|| libm::sqrt(squares / (n - 1.0) / n))
}

/// The mean over cells of the median over all their rounds.
fn middle(cells: &[Vec<Vec<f64>>]) -> f64 {
    mean(&cells.iter().map(|cell| middle_of(&cell.concat())).collect::<Vec<_>>())
}

fn middle_of(values: &[f64]) -> f64 {
    median(values).expect("an epoch has rounds")
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests;
