//! Times for all rays of a scene together.

use super::epoch::{Epoch, Rays, Structure};
use crate::measure::{AaNoise, Estimate};
use crate::study::epoch_medians::{epoch_medians, ratio, values};

/// How long the structures of an epoch take for all their rays, whatever part of them was timed: the rays of every kind
/// at the pace of those that were.
#[derive(Clone, Debug, PartialEq)]
pub struct WholeTimes {
    /// Of each epoch, its structures.
    epochs: Vec<Vec<Structure>>,
}

impl WholeTimes {
    /// Of the epochs of one scene, in which every structure is timed.
    pub fn new<'a>(epochs: impl IntoIterator<Item = &'a Epoch>) -> Self {
        Self { epochs: epochs.into_iter().map(|epoch| epoch.structures.clone()).collect() }
    }

    /// ln of seconds of the structures with these numbers, on the rays that all of them were timed on, of each epoch.
    fn epoch_medians(&self, structures: &[usize]) -> Vec<Vec<f64>> {
        let of_epoch = |all: &Vec<Structure>| {
            let chosen: Vec<&Structure> = structures.iter().map(|&number| &all[number]).collect();
            chosen.iter().map(|structure| seconds(structure, &chosen)).collect()
        };
        epoch_medians(self.epochs.iter().map(of_epoch).collect())
    }

    /// Seconds: the geometric mean over the epochs, with its interval.
    ///
    /// # Panics
    /// If there is no epoch.
    pub fn seconds(&self, structure: usize, noise: &AaNoise) -> Estimate {
        ratio(&self.epoch_medians(&[structure]), |logs| logs[0], noise.weighted(&[1.0]))
    }

    /// ln of the time of `one` over that of `other`, in each epoch.
    pub fn log_ratios(&self, one: usize, other: usize) -> Vec<f64> {
        values(&self.epoch_medians(&[one, other]), |logs| logs[0] - logs[1])
    }

    /// The same as a cell of [`epoch_values`](crate::measure::epoch_values).
    pub fn cell(&self, one: usize, other: usize) -> Vec<Vec<f64>> {
        self.log_ratios(one, other).into_iter().map(|log| vec![log]).collect()
    }

    /// The time of `one` over that of `other`, with its interval.
    ///
    /// # Panics
    /// If there is no epoch.
    pub fn ratio(&self, one: usize, other: usize, noise: &AaNoise) -> Estimate {
        ratio(&self.epoch_medians(&[one, other]), |logs| logs[0] - logs[1], noise.of_ratio())
    }
}

/// ln of the seconds that a structure takes for all rays, in each round, at the pace of those that all of `beside` were
/// timed on.
fn seconds(structure: &Structure, beside: &[&Structure]) -> Vec<f64> {
    let paces_of_kind = |(kind, rays): (usize, &Rays)| {
        let common = beside.iter().map(|other| other.rays[kind].rays).min().unwrap_or(rays.rays);
        rays.paces(common).into_iter().map(|pace| pace * rays.all as f64 * 1e-9).collect::<Vec<f64>>()
    };
    let kinds: Vec<Vec<f64>> = structure.rays.iter().enumerate().map(paces_of_kind).collect();
    let rounds = kinds.iter().map(Vec::len).min().unwrap_or(0);
    (0..rounds).map(|round| libm::log(kinds.iter().map(|kind| kind[round]).sum::<f64>())).collect()
}
