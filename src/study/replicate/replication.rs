//! The report's tables with our figures in them.

use super::original::{CROWDED, DEFAULT, HARD, HardRow, MAIN, MainRow, SWEEP, t_prime};
use super::{BRUTE, SAH, TREE};
use crate::accel::Query;
use crate::measure::{AaNoise, Estimate, Rerun, cut_to_shared_epochs, epoch_values, median};
use crate::request::TWIN;
use crate::study::whole_times::WholeTimes;
use crate::study::{Dataset, Epoch};

/// The scenes of the report, ours beside its own, and its conclusion.
#[derive(Debug, Default)]
pub struct Replication {
    pub main: Vec<Main>,
    pub hard: Vec<Hard>,
    /// How many times faster the SAH tree is on the hard scenes: the geometric mean over them.
    pub faster: Option<Estimate>,
}

/// What is measured on every scene.
#[derive(Debug)]
pub struct Replicated {
    pub name: String,
    /// As tables name it.
    pub title: String,
    pub triangles: usize,
    /// Rays of a 512 x 512 picture.
    pub primary: u64,
    pub mirror: u64,
    pub shadow: u64,
    /// With the report's tree.
    pub tree: Seconds,
    pub sah: Seconds,
}

/// Seconds of a picture.
#[derive(Clone, Copy, Debug)]
pub struct Seconds {
    /// Geometric mean over the epochs.
    pub seconds: f64,
    /// `t'`: seconds / (rays x triangles).
    pub t_prime: Estimate,
    /// Whether a part of the rays was timed and stands for all.
    pub sampled: bool,
}

/// An easy or normal scene.
#[derive(Debug)]
pub struct Main {
    pub scene: Replicated,
    /// Every ray against every triangle: "unoptimised".
    pub brute_force: Seconds,
    /// Seconds without the tree / seconds with it.
    pub improvement: Estimate,
    /// With the settings of [`SWEEP`].
    pub sweep: Vec<Seconds>,
    /// Triangle tests for each ray and triangle, with the setting of the main table and with that of [`CROWDED`]; nothing
    /// where they are not counted.
    pub tests: [Option<f64>; 2],
    pub report: &'static MainRow,
}

/// A hard scene, primary rays.
#[derive(Debug)]
pub struct Hard {
    pub scene: Replicated,
    /// Seconds that builds take.
    pub tree_build_s: f64,
    pub sah_build_s: f64,
    /// Seconds with the report's tree / seconds with the SAH tree: how many times faster SAH is.
    pub faster: Estimate,
    /// Its logarithm in each epoch, and that of the time of the report's tree over that of its twin.
    log_ratios: Vec<Vec<f64>>,
    log_aa_ratios: Vec<Vec<f64>>,
    pub report: &'static HardRow,
}

impl Replication {
    /// From the epochs of all scenes. Those that are not the report's say nothing.
    pub fn of(dataset: &Dataset) -> Self {
        let (mut main, mut hard) = (vec![], vec![]);
        for scene in dataset.scenes() {
            let (epochs, name) = (&scene.epochs[..], scene.epochs[0].scene.as_str());
            main.extend(MAIN.iter().find(|row| row.scene == name).map(|row| Main::of(epochs, row)));
            hard.extend(HARD.iter().find(|row| row.scene == name).map(|row| Hard::of(epochs, row)));
        }
        Self { faster: mean(&hard), main, hard }
    }

    /// Whether all easy and normal scenes are measured.
    pub fn has_all_main(&self) -> bool {
        MAIN.iter().all(|row| self.main.iter().any(|main| main.scene.name == row.scene))
    }

    /// All scenes with the report's count of rays, in its order.
    pub fn scenes(&self) -> impl Iterator<Item = (&Replicated, u64)> {
        let main = self.main.iter().map(|main| (&main.scene, main.report.rays));
        main.chain(self.hard.iter().map(|hard| (&hard.scene, hard.report.rays)))
    }
}

impl Main {
    fn of(epochs: &[&Epoch], report: &'static MainRow) -> Self {
        let (times, tree) = (WholeTimes::new(epochs), DEFAULT.role());
        let noise = AaNoise::new(&[times.log_ratios(&tree, TWIN)]);
        let seconds = |role: &str| Seconds::of(&times, epochs[0], role, &noise);
        Self {
            scene: Replicated::of(epochs[0], seconds(&tree), seconds(SAH)),
            brute_force: seconds(BRUTE),
            improvement: times.ratio(BRUTE, &tree, &noise),
            sweep: SWEEP.iter().map(|row| seconds(&row.role())).collect(),
            tests: [DEFAULT, CROWDED.1].map(|row| tests(epochs[0], &row.role())),
            report,
        }
    }
}

impl Hard {
    fn of(epochs: &[&Epoch], report: &'static HardRow) -> Self {
        let times = WholeTimes::new(epochs);
        let log_aa_ratios = times.log_ratios(TREE, TWIN);
        let noise = AaNoise::new(std::slice::from_ref(&log_aa_ratios));
        let seconds = |role: &str| Seconds::of(&times, epochs[0], role, &noise);
        let build_s = |role: &str| {
            let builds = epochs.iter().filter_map(|epoch| epoch.in_role(role)).map(|own| own.build_ns as f64);
            median(&builds.collect::<Vec<_>>()).expect("every epoch builds") * 1e-9
        };
        Self {
            scene: Replicated::of(epochs[0], seconds(TREE), seconds(SAH)),
            tree_build_s: build_s(TREE),
            sah_build_s: build_s(SAH),
            faster: times.ratio(TREE, SAH, &noise),
            log_ratios: times.log_ratios(TREE, SAH),
            log_aa_ratios,
            report,
        }
    }
}

/// How many times faster the SAH tree is, so far as hard scenes are measured: the claim is about all of them.
fn mean(hard: &[Hard]) -> Option<Estimate> {
    let cells = |of: fn(&Hard) -> &Vec<Vec<f64>>| hard.iter().map(|own| of(own).clone()).collect::<Vec<_>>();
    let noise = AaNoise::new(&cells(|hard| &hard.log_aa_ratios)).of_mean(hard.len());
    let mut ratios = cells(|hard| &hard.log_ratios);
    // What is not measured to its end has scenes that lack an epoch.
    cut_to_shared_epochs(&mut ratios);
    Some(Rerun::of(&epoch_values(&ratios)?, noise)?.ratio())
}

impl Replicated {
    fn of(epoch: &Epoch, tree: Seconds, sah: Seconds) -> Self {
        let [closest, shadow] = [Query::Closest, Query::Any].map(|query| rays(epoch, Some(query)));
        let primary = closest.min(PIXELS);
        let (name, title, triangles) = (epoch.scene.clone(), epoch.title(), epoch.triangles);
        Self { name, title, triangles, primary, mirror: closest - primary, shadow, tree, sah }
    }

    pub fn total(&self) -> u64 {
        self.primary + self.mirror + self.shadow
    }
}

/// Pixels of the report's pictures, each with one primary ray.
const PIXELS: u64 = 512 * 512;

/// Rays of the picture that ask `query`, or all of them.
fn rays(epoch: &Epoch, query: Option<Query>) -> u64 {
    let all = epoch.structures.first().into_iter().flat_map(|structure| &structure.rays);
    all.filter(|rays| query.is_none_or(|query| rays.query == query)).map(|rays| rays.all as u64).sum()
}

/// Triangle tests for each ray and triangle.
fn tests(epoch: &Epoch, role: &str) -> Option<f64> {
    let counted = epoch.in_role(role)?.rays.iter().map(|rays| rays.counts?.whole_tests);
    Some(counted.sum::<Option<u64>>()? as f64 / (rays(epoch, None) as f64 * epoch.triangles as f64))
}

impl Seconds {
    fn of(times: &WholeTimes, first: &Epoch, role: &str, noise: &AaNoise) -> Self {
        let (seconds, all) = (times.seconds(role, noise), rays(first, None));
        let timed = first.in_role(role).into_iter().flat_map(|structure| &structure.rays);
        Self {
            seconds: seconds.estimate,
            t_prime: seconds.map(|seconds| t_prime(seconds, all, first.triangles)),
            sampled: timed.into_iter().any(|rays| rays.rays < rays.all),
        }
    }
}
