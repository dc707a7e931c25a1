//! Times for all rays of a scene together.

use super::epoch::{Epoch, Rays, Structure};
use super::epoch_medians::{epoch_medians, ratio, values};
use crate::measure::{AaNoise, Estimate};

/// The time that the structures of a scene take for all rays, even if only a subset was timed: the rays of every
/// workload at the speed of the timed ones. Structures are named by their roles.
pub struct WholeTimes<'a> {
    /// The epochs of one scene in which every structure is timed; at least one.
    pub epochs: &'a [&'a Epoch],
}

impl WholeTimes<'_> {
    /// ln(seconds) of the structures in these roles, on the rays that all of them were timed on, by epoch.
    fn epoch_medians(&self, roles: &[&str]) -> Vec<Vec<f64>> {
        let of_epoch = |epoch: &&Epoch| {
            let in_role = |role: &&str| epoch.in_role(role).unwrap_or_else(|| panic!("no structure is {role:?}"));
            let chosen: Vec<&Structure> = roles.iter().map(in_role).collect();
            chosen.iter().map(|structure| seconds(structure, &chosen)).collect()
        };
        epoch_medians(self.epochs.iter().map(of_epoch).collect())
    }

    /// Seconds: the geometric mean over the epochs, with its interval.
    pub fn seconds(&self, role: &str, noise: &AaNoise) -> Estimate {
        ratio(&self.epoch_medians(&[role]), |logs| logs[0], noise.weighted(&[1.0]))
    }

    /// ln(time of `one` / time of `other`) in each epoch, as a cell of [`epoch_values`](crate::measure::epoch_values).
    pub fn log_ratios(&self, one: &str, other: &str) -> Vec<Vec<f64>> {
        let logs = values(&self.epoch_medians(&[one, other]), |logs| logs[0] - logs[1]);
        logs.into_iter().map(|log| vec![log]).collect()
    }

    /// Time of `one` / time of `other`, with its interval.
    pub fn ratio(&self, one: &str, other: &str, noise: &AaNoise) -> Estimate {
        ratio(&self.epoch_medians(&[one, other]), |logs| logs[0] - logs[1], noise.of_ratio())
    }
}

/// ln(seconds) of a structure for all rays, by round, at the speed of the rays on which all of `beside` were timed.
fn seconds(structure: &Structure, beside: &[&Structure]) -> Vec<f64> {
    let paces_of_kind = |(kind, rays): (usize, &Rays)| {
        let common = beside.iter().map(|other| other.rays[kind].rays).min().unwrap_or(rays.rays);
        rays.ns_per_ray(common).into_iter().map(|pace| pace * rays.all as f64 * 1e-9).collect::<Vec<f64>>()
    };
    let kinds: Vec<Vec<f64>> = structure.rays.iter().enumerate().map(paces_of_kind).collect();
    let rounds = kinds.iter().map(Vec::len).min().unwrap_or(0);
    (0..rounds).map(|round| libm::log(kinds.iter().map(|kind| kind[round]).sum::<f64>())).collect()
}
