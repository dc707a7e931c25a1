//! Times for all rays of a scene together.

use super::{Epoch, Rays, Structure};
use crate::measure::{Interval, NoiseFloor, standard_error, two_sided};
use crate::study::replicates::{interval, replicates, values};

/// How long the structures of an epoch take for all their rays, whatever part of them was timed: the rays of every kind at the pace of
/// those that were.
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

    /// ln of seconds of the structures with these numbers, on the rays that all of them were timed on: of each epoch, or of each round of a
    /// single one.
    fn replicates(&self, structures: &[usize]) -> Vec<Vec<f64>> {
        let of_epoch = |all: &Vec<Structure>| {
            let chosen: Vec<&Structure> = structures.iter().map(|&number| &all[number]).collect();
            chosen.iter().map(|structure| seconds(structure, &chosen)).collect()
        };
        replicates(self.epochs.iter().map(of_epoch).collect())
    }

    /// Seconds: the geometric mean over the epochs, with the interval that holds that of another run.
    ///
    /// # Panics
    /// If there is no epoch.
    pub fn seconds(&self, structure: usize, floor: f64, seed: u64) -> Interval {
        interval(&self.replicates(&[structure]), |logs| logs[0], floor, seed)
    }

    /// ln of the time of `one` over that of `other`, as a cell of [`replication`](crate::measure::replication()).
    pub fn log_ratios(&self, one: usize, other: usize) -> Vec<Vec<f64>> {
        values(&self.replicates(&[one, other]), |logs| logs[0] - logs[1])
    }

    /// The time of `one` over that of `other`, with the interval that holds it in another run.
    pub fn ratio(&self, one: usize, other: usize, floor: f64, seed: u64) -> Interval {
        interval(&self.replicates(&[one, other]), |logs| logs[0] - logs[1], floor, seed)
    }

    /// What two builds of one structure differ by, as a logarithm.
    pub fn floor(&self, twins: [usize; 2], seed: u64) -> f64 {
        NoiseFloor::new(&[self.log_ratios(twins[0], twins[1])], seed).log().unwrap_or(0.0)
    }

    /// How likely a difference as large as that of two structures is by chance: Student's t over the epochs. Nothing with fewer than
    /// two of them.
    pub fn probability(&self, one: usize, other: usize) -> Option<f64> {
        if self.epochs.len() < 2 {
            return None;
        }
        let differences: Vec<f64> = self.log_ratios(one, other).concat();
        let error = standard_error(&differences)?;
        let mean = differences.iter().sum::<f64>() / differences.len() as f64;
        if error == 0.0 {
            return Some(if mean == 0.0 { 1.0 } else { 0.0 });
        }
        Some(two_sided(mean / error, differences.len() as f64 - 1.0))
    }
}

/// ln of the seconds that a structure takes for all rays, in each round, at the pace of those that all of `beside` were timed on.
fn seconds(structure: &Structure, beside: &[&Structure]) -> Vec<f64> {
    let paces_of_kind = |(kind, rays): (usize, &Rays)| {
        let common = beside.iter().map(|other| other.rays[kind].rays).min().unwrap_or(rays.rays);
        rays.paces(common).into_iter().map(|pace| pace * rays.all as f64 * 1e-9).collect::<Vec<f64>>()
    };
    let kinds: Vec<Vec<f64>> = structure.rays.iter().enumerate().map(paces_of_kind).collect();
    let rounds = kinds.iter().map(Vec::len).min().unwrap_or(0);
    (0..rounds).map(|round| libm::log(kinds.iter().map(|kind| kind[round]).sum::<f64>())).collect()
}
