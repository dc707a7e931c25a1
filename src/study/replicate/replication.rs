//! The measurements of the scenes in the source report, a student report that this project reproduces.

use super::original::{DEFAULT, HARD, MAIN, Row};
use crate::accel::Query;
use crate::measure::{AaNoise, Estimate, Rerun, cut_to_shared_epochs, epoch_values, median};
use crate::request::TWIN;
use crate::study::epoch::{Rays, Structure};
use crate::study::epoch_medians::{epoch_medians, ratio, values};
use crate::study::{Dataset, Epoch};

pub const BRUTE: &str = "brute force";
pub const SAH: &str = "sah";
/// The role of the report's tree on a hard scene. On other scenes, the tree has the role of [`DEFAULT`].
pub const TREE: &str = "tree";

pub struct Replicated<'a> {
    pub report: &'static Row,
    epochs: Vec<&'a Epoch>,
}

/// The scenes of [`HARD`] follow the scenes of [`MAIN`].
pub fn replicated(dataset: &Dataset) -> Vec<Replicated<'_>> {
    let scenes = dataset.scenes();
    let of = |report: &'static Row| {
        let own = scenes.iter().filter(|scene| scene.epochs[0].scene == report.scene);
        own.map(move |scene| Replicated { report, epochs: scene.epochs.clone() })
    };
    MAIN.iter().chain(&HARD).flat_map(of).collect()
}

/// The geometric mean of [`Replicated::faster`] over the hard scenes.
pub fn mean(hard: &[Replicated]) -> Option<Estimate> {
    let ratios = |other: &str| hard.iter().map(|own| own.log_ratios(other)).collect::<Vec<_>>();
    let noise = AaNoise::new(&ratios(TWIN)).of_mean(hard.len());
    let mut ratios = ratios(SAH);
    // After an interrupted run, some scenes lack an epoch.
    cut_to_shared_epochs(&mut ratios);
    Some(Rerun::of(&epoch_values(&ratios)?, noise)?.ratio())
}

impl Replicated<'_> {
    pub fn first(&self) -> &Epoch {
        self.epochs[0]
    }

    /// The numbers of primary, mirror and shadow rays of a 512 x 512 picture.
    pub fn rays(&self) -> [u64; 3] {
        let all = |query| {
            let of_query = self.first().structures[0].rays.iter().filter(|rays| rays.query == query);
            of_query.map(|rays| rays.all as u64).sum::<u64>()
        };
        let closest = all(Query::Closest);
        // Each pixel has one primary ray.
        let primary = closest.min(512 * 512);
        [primary, closest - primary, all(Query::Any)]
    }

    pub fn total(&self) -> u64 {
        self.rays().iter().sum()
    }

    fn structure<'a>(&self, epoch: &'a Epoch, role: &str) -> Option<&'a Structure> {
        let is_setting = role == TREE && !self.report.is_hard();
        let role = if is_setting { DEFAULT.role() } else { role.to_owned() };
        epoch.structures.iter().find(|own| own.role == role)
    }

    /// ln(seconds) for all rays. The indices are the epoch and the place in `roles`. The seconds are extrapolated from
    /// rays that were timed for all `roles`.
    fn medians(&self, roles: &[&str]) -> Vec<Vec<f64>> {
        let of_epoch = |epoch: &&Epoch| {
            let in_role =
                |role: &&str| self.structure(epoch, role).unwrap_or_else(|| panic!("no structure is {role:?}"));
            let chosen: Vec<&Structure> = roles.iter().map(in_role).collect();
            chosen.iter().map(|structure| log_seconds(structure, &chosen)).collect()
        };
        epoch_medians(self.epochs.iter().map(of_epoch).collect())
    }

    /// ln(seconds of the report's tree / seconds of `other`). Each epoch has one value.
    fn log_ratios(&self, other: &str) -> Vec<Vec<f64>> {
        let logs = values(&self.medians(&[TREE, other]), |logs| logs[0] - logs[1]);
        logs.into_iter().map(|log| vec![log]).collect()
    }

    fn noise(&self) -> AaNoise {
        AaNoise::new(&[self.log_ratios(TWIN)])
    }

    /// Seconds with `one` / seconds with `other`.
    fn ratio(&self, one: &str, other: &str) -> Estimate {
        ratio(&self.medians(&[one, other]), |logs| logs[0] - logs[1], self.noise().of_ratio())
    }

    /// Seconds for the picture, as a geometric mean over the epochs.
    pub fn seconds(&self, role: &str) -> Option<Estimate> {
        self.structure(self.first(), role)?;
        Some(ratio(&self.medians(&[role]), |logs| logs[0], self.noise().weighted(&[1.0])))
    }

    pub fn t_prime(&self, role: &str) -> Option<Estimate> {
        let rays_and_triangles = self.total() as f64 * self.first().triangles as f64;
        Some(self.seconds(role)?.map(|seconds| seconds / rays_and_triangles))
    }

    /// Whether only a subset of the rays was timed.
    pub fn is_sampled(&self, role: &str) -> Option<bool> {
        Some(self.structure(self.first(), role)?.rays.iter().any(|rays| rays.rays < rays.all))
    }

    pub fn build_s(&self, role: &str) -> Option<f64> {
        let builds = self.epochs.iter().filter_map(|epoch| Some(self.structure(epoch, role)?.build_ns as f64));
        Some(median(&builds.collect::<Vec<_>>())? * 1e-9)
    }

    /// Triangle tests / (rays x triangles).
    pub fn tests(&self, role: &str) -> Option<f64> {
        let rays = &self.structure(self.first(), role)?.rays;
        let tests: u64 = rays.iter().map(|rays| rays.counts?.whole_tests).sum::<Option<_>>()?;
        Some(tests as f64 / (self.total() as f64 * self.first().triangles as f64))
    }

    pub fn improvement(&self) -> Option<Estimate> {
        (!self.report.is_hard()).then(|| self.ratio(BRUTE, TREE))
    }

    pub fn faster(&self) -> Estimate {
        self.ratio(TREE, SAH)
    }
}

/// ln(seconds) for all rays. Each round has one value. The seconds are extrapolated from rays that were timed for all
/// structures in `beside`.
fn log_seconds(structure: &Structure, beside: &[&Structure]) -> Vec<f64> {
    let seconds = |(kind, rays): (usize, &Rays)| {
        let common = beside.iter().map(|other| other.rays[kind].rays).min().unwrap_or(rays.rays);
        rays.ns_per_ray(common).into_iter().map(|pace| pace * rays.all as f64 * 1e-9).collect::<Vec<f64>>()
    };
    let kinds: Vec<Vec<f64>> = structure.rays.iter().enumerate().map(seconds).collect();
    let rounds = kinds.iter().map(Vec::len).min().unwrap_or(0);
    (0..rounds).map(|round| libm::log(kinds.iter().map(|kind| kind[round]).sum::<f64>())).collect()
}
