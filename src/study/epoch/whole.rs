//! Times for all rays of a scene together.

use super::{Epoch, Structure};
use crate::measure::{Interval, NoiseFloor, standard_error, two_sided};
use crate::study::replicates::{interval, replicates, values};

/// How long the structures of an epoch take for all their rays, whatever part of them was timed: the rays of every kind at the pace of
/// those that were.
#[derive(Clone, Debug, PartialEq)]
pub struct WholeTimes {
    /// ln of seconds: of each epoch, or of each round of a single one; of each structure.
    replicates: Vec<Vec<f64>>,
    epochs: usize,
}

impl WholeTimes {
    /// Of the epochs of one scene, in which every structure is timed.
    pub fn new<'a>(epochs: impl IntoIterator<Item = &'a Epoch>) -> Self {
        let logs = |epoch: &Epoch| epoch.structures.iter().map(seconds).collect();
        let samples: Vec<Vec<Vec<f64>>> = epochs.into_iter().map(logs).collect();
        Self { epochs: samples.len(), replicates: replicates(samples) }
    }

    /// Seconds: the geometric mean over the epochs, with the interval that holds that of another run.
    ///
    /// # Panics
    /// If there is no epoch.
    pub fn seconds(&self, structure: usize, floor: f64, seed: u64) -> Interval {
        interval(&self.replicates, |logs| logs[structure], floor, seed)
    }

    /// ln of the time of `one` over that of `other`, as a cell of [`replication`](crate::measure::replication()).
    pub fn log_ratios(&self, one: usize, other: usize) -> Vec<Vec<f64>> {
        values(&self.replicates, |logs| logs[one] - logs[other])
    }

    /// The time of `one` over that of `other`, with the interval that holds it in another run.
    pub fn ratio(&self, one: usize, other: usize, floor: f64, seed: u64) -> Interval {
        interval(&self.replicates, |logs| logs[one] - logs[other], floor, seed)
    }

    /// What two builds of one structure differ by, as a logarithm.
    pub fn floor(&self, twins: [usize; 2], seed: u64) -> f64 {
        NoiseFloor::new(&[self.log_ratios(twins[0], twins[1])], seed).log().unwrap_or(0.0)
    }

    /// How likely a difference as large as that of two structures is by chance: Student's t over the epochs. Nothing with fewer than
    /// two of them.
    pub fn probability(&self, one: usize, other: usize) -> Option<f64> {
        if self.epochs < 2 {
            return None;
        }
        let differences: Vec<f64> = self.log_ratios(one, other).concat();
        let error = standard_error(&differences)?;
        let mean = differences.iter().sum::<f64>() / differences.len() as f64;
        if error == 0.0 {
            return Some(if mean == 0.0 { 1.0 } else { 0.0 });
        }
        Some(two_sided(mean / error, differences.len() - 1))
    }
}

/// ln of the seconds that a structure takes for all rays, in each round.
fn seconds(structure: &Structure) -> Vec<f64> {
    let rounds = structure.rays.iter().map(|rays| rays.ns.len()).min().unwrap_or(0);
    let second =
        |round: usize| structure.rays.iter().map(|rays| rays.paces()[round] * rays.all as f64 * 1e-9).sum::<f64>();
    (0..rounds).map(|round| libm::log(second(round))).collect()
}
