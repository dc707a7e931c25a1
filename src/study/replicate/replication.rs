//! The report's tables with our figures in them.

use super::original::{DEFAULT, Row, t_prime};
use crate::accel::Query;
use crate::measure::{AaNoise, Estimate, Rerun, cut_to_shared_epochs, epoch_values, median};
use crate::request::TWIN;
use crate::study::epoch::Structure;
use crate::study::whole_times::WholeTimes;
use crate::study::{Dataset, Epoch};

/// Roles of structures. The settings of the sweep have [roles](original::SweepRow::role) of their own.
pub const BRUTE: &str = "brute force";
pub const SAH: &str = "sah";
/// The report's tree on a hard scene.
pub const TREE: &str = "tree";

/// A scene of the report, ours beside its own.
#[derive(Debug)]
pub struct Replicated {
    pub report: &'static Row,
    /// As tables name it.
    pub title: String,
    pub triangles: usize,
    /// Rays of a 512 x 512 picture.
    pub primary: u64,
    pub mirror: u64,
    pub shadow: u64,
    /// The role of the report's tree.
    tree: String,
    /// Of each role but the twin's.
    times: Vec<(String, Times)>,
    /// Seconds with every ray against every triangle / seconds with the report's tree; nothing on hard scenes.
    pub improvement: Option<Estimate>,
    /// Seconds with the report's tree / seconds with the SAH tree: how many times faster SAH is.
    pub faster: Estimate,
    /// Its logarithm in each epoch, and that of the time of the report's tree over that of its twin.
    log_ratios: Vec<Vec<f64>>,
    log_aa_ratios: Vec<Vec<f64>>,
}

/// How long a structure takes for a picture.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    /// Geometric mean over the epochs.
    pub seconds: f64,
    /// `t'`: seconds / (rays x triangles).
    pub t_prime: Estimate,
    /// Whether a part of the rays was timed and stands for all.
    pub sampled: bool,
    /// Seconds of the build, median over the epochs.
    pub build_s: f64,
    /// Triangle tests for each ray and triangle; nothing where they are not counted.
    pub tests: Option<f64>,
}

/// The measured scenes of the report, in the order of `rows`.
pub fn replicated(dataset: &Dataset, rows: &'static [Row]) -> Vec<Replicated> {
    let scenes = dataset.scenes();
    let of =
        |row: &'static Row| scenes.iter().filter(|own| own.epochs[0].scene == row.scene).map(move |own| (own, row));
    rows.iter().flat_map(of).map(|(own, row)| Replicated::of(&own.epochs, row)).collect()
}

/// How many times faster the SAH tree is: the geometric mean over the hard scenes, so far as they are measured.
pub fn mean(hard: &[Replicated]) -> Option<Estimate> {
    let cells = |of: fn(&Replicated) -> &Vec<Vec<f64>>| hard.iter().map(|own| of(own).clone()).collect::<Vec<_>>();
    let noise = AaNoise::new(&cells(|own| &own.log_aa_ratios)).of_mean(hard.len());
    let mut ratios = cells(|own| &own.log_ratios);
    // What is not measured to its end has scenes that lack an epoch.
    cut_to_shared_epochs(&mut ratios);
    Some(Rerun::of(&epoch_values(&ratios)?, noise)?.ratio())
}

/// Pixels of the report's pictures, each with one primary ray.
const PIXELS: u64 = 512 * 512;

impl Replicated {
    fn of(epochs: &[&Epoch], report: &'static Row) -> Self {
        let first = epochs[0];
        let tree = if report.is_hard() { TREE.into() } else { DEFAULT.role() };
        let all = WholeTimes { epochs };
        let log_aa_ratios = all.log_ratios(&tree, TWIN);
        let noise = AaNoise::new(std::slice::from_ref(&log_aa_ratios));
        let of = |structure: &Structure| Times::of(structure, epochs, all.seconds(&structure.role, &noise));
        let structures = first.structures.iter().filter(|structure| !structure.is_twin());
        let times: Vec<(String, Times)> = structures.map(|own| (own.role.clone(), of(own))).collect();
        let [closest, shadow] = [Query::Closest, Query::Any].map(|query| rays(&first.structures[0], &[query]));
        let primary = closest.min(PIXELS);
        Self {
            report,
            title: first.title(),
            triangles: first.triangles,
            primary,
            mirror: closest - primary,
            shadow,
            times,
            improvement: (!report.is_hard()).then(|| all.ratio(BRUTE, &tree, &noise)),
            faster: all.ratio(&tree, SAH, &noise),
            log_ratios: all.log_ratios(&tree, SAH),
            log_aa_ratios,
            tree,
        }
    }

    pub fn total(&self) -> u64 {
        self.primary + self.mirror + self.shadow
    }

    /// With the report's tree.
    pub fn tree(&self) -> Option<&Times> {
        self.times(&self.tree)
    }

    /// Of the structure in this role.
    pub fn times(&self, role: &str) -> Option<&Times> {
        self.times.iter().find(|(own, _)| own == role).map(|(_, times)| times)
    }
}

/// Rays of the picture that ask one of the `queries`.
fn rays(structure: &Structure, queries: &[Query]) -> u64 {
    structure.rays.iter().filter(|rays| queries.contains(&rays.query)).map(|rays| rays.all as u64).sum()
}

impl Times {
    fn of(structure: &Structure, epochs: &[&Epoch], seconds: Estimate) -> Self {
        let (all, triangles) = (rays(structure, &[Query::Closest, Query::Any]), epochs[0].triangles);
        let builds = epochs.iter().filter_map(|epoch| epoch.in_role(&structure.role)).map(|own| own.build_ns as f64);
        let tests = structure.rays.iter().map(|rays| rays.counts?.whole_tests).sum::<Option<u64>>();
        Self {
            seconds: seconds.estimate,
            t_prime: seconds.map(|seconds| t_prime(seconds, all, triangles)),
            sampled: structure.rays.iter().any(|rays| rays.rays < rays.all),
            build_s: median(&builds.collect::<Vec<_>>()).expect("every epoch builds") * 1e-9,
            tests: tests.map(|tests| tests as f64 / (all as f64 * triangles as f64)),
        }
    }
}
