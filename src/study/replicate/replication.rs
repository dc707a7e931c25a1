//! The report's tables with our figures in them.

use serde::Serialize;

use super::original::{HARD, HardRow, MAIN, SWEEP, t_prime};
use crate::accel::Query;
use crate::measure::{AaNoise, Estimate, Rerun, cut_to_shared_epochs, epoch_values, median};
use crate::study::epoch::{self, Epoch, PICTURE, Structure, WholeTimes};
use crate::study::parameters;

/// The report's three tables, ours beside its own, and its conclusion.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Replication {
    /// Scenes in which a mesh of our own stands in for a real one.
    pub stand_ins: Vec<String>,
    pub rays: Vec<Rays>,
    pub main: Vec<Main>,
    pub parameters: Vec<Setting>,
    pub hard: Vec<Hard>,
    pub conclusion: Conclusion,
}

/// Rays of a 512 x 512 picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rays {
    pub scene: String,
    pub primary: u64,
    pub mirror: u64,
    pub shadow: u64,
    /// Of these three; on the hard scenes the report counts primary rays alone, and so does this.
    pub total: u64,
    /// The report's total.
    pub report: u64,
}

/// Seconds of a picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Seconds {
    /// Geometric mean over the epochs.
    pub seconds: f64,
    /// `t'`: seconds / (rays x triangles).
    pub t_prime: Estimate,
    /// Whether a part of the rays was timed and stands for all.
    pub extrapolated: bool,
}

/// An easy or normal scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Main {
    pub scene: String,
    pub triangles: usize,
    pub rays: u64,
    /// With the report's tree.
    pub tree: Seconds,
    /// Every ray against every triangle: "unoptimised".
    pub brute_force: Seconds,
    /// Seconds without the tree / seconds with it.
    pub improvement: Estimate,
    /// With the SAH tree.
    pub sah: Seconds,
    pub report_tree_s: f64,
    pub report_brute_force_s: f64,
    pub report_tree_t_prime: f64,
    pub report_brute_force_t_prime: f64,
    /// As printed.
    pub report_improvement: f64,
}

/// The report's tree with one pair of parameters on one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Setting {
    pub scene: String,
    /// L.
    pub leaf: u32,
    /// T.
    pub threshold: f32,
    pub seconds: f64,
    pub extrapolated: bool,
    pub report_s: f64,
}

/// A hard scene, primary rays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hard {
    pub scene: String,
    pub triangles: usize,
    pub rays: u64,
    pub stand_in: bool,
    /// With the report's tree.
    pub tree: Seconds,
    /// Construction of the report's tree, seconds.
    pub tree_build_s: f64,
    pub sah: Seconds,
    pub sah_build_s: f64,
    /// Seconds with the report's tree / seconds with the SAH tree: how much faster SAH is.
    pub sah_over_median: Estimate,
    /// Its logarithm in each epoch.
    pub log_ratios: Vec<f64>,
    /// The logarithm of the time of the report's tree over that of its twin in each epoch.
    pub log_aa_ratios: Vec<f64>,
    pub report_tree_s: f64,
    pub report_tree_build_s: f64,
    pub report_tree_t_prime: f64,
}

/// The claim that the report ends with: for the hard scenes a SAH tree would have been much faster.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Conclusion {
    /// The scenes of the mean.
    pub scenes: Vec<String>,
    /// Geometric mean over the scenes of how much faster SAH is, with the interval that holds that of another run, as little disturbed, in 95 % of cases.
    pub sah_over_median: Option<Estimate>,
}

/// Where structures stand among those of an easy or normal scene: before the sweep of [`parameters::structures`].
const BRUTE: usize = 0;
const SAH: usize = 1;
const FIRST_SETTING: usize = 2;

impl Replication {
    /// From the epochs of all scenes.
    pub fn of(cases: &[Epoch]) -> Self {
        let mut replication = Self::default();
        for epochs in epoch::scenes(cases) {
            replication.add_main(&epochs);
            replication.add_hard(&epochs);
        }
        replication
    }

    /// Adds an easy or normal scene of the report; nothing of another one.
    pub(super) fn add_main(&mut self, epochs: &[&Epoch]) {
        let first = epochs[0];
        let Some(index) = MAIN.iter().position(|row| row.scene == first.scene) else { return };
        let row = &MAIN[index];
        let rays = self.add_rays(first, row.rays);
        let setting = |row: usize| FIRST_SETTING + row;
        let (tree, twin) = (setting(parameters::default_row()), setting(SWEEP.len()));

        let times = WholeTimes::new(epochs.iter().copied());
        let noise = AaNoise::new(&[times.cell(tree, twin)]);
        let seconds = |structure: usize| Seconds::of(&times, first, structure, rays, &noise);
        self.main.push(Main {
            scene: first.scene.clone(),
            triangles: first.triangles,
            rays,
            tree: seconds(tree),
            brute_force: seconds(BRUTE),
            improvement: times.ratio(BRUTE, tree, &noise),
            sah: seconds(SAH),
            report_tree_s: row.tree_s,
            report_brute_force_s: row.brute_s,
            report_tree_t_prime: t_prime(row.tree_s, row.rays, row.triangles),
            report_brute_force_t_prime: t_prime(row.brute_s, row.rays, row.triangles),
            report_improvement: row.improvement,
        });
        for (i, sweep) in SWEEP.iter().enumerate() {
            let Seconds { seconds, extrapolated, .. } = seconds(setting(i));
            self.parameters.push(Setting {
                scene: first.scene.clone(),
                leaf: sweep.leaf,
                threshold: sweep.threshold,
                seconds,
                extrapolated,
                report_s: sweep.seconds[index],
            });
        }
    }

    /// Adds a hard scene of the report, likewise: its tree, the SAH tree, and its tree once more.
    pub(super) fn add_hard(&mut self, epochs: &[&Epoch]) {
        const TREE: usize = 0;
        const TWIN: usize = 2;
        let first = epochs[0];
        let Some(row): Option<&HardRow> = HARD.iter().find(|row| row.scene == first.scene) else { return };
        let rays = self.add_rays(first, row.rays);

        let times = WholeTimes::new(epochs.iter().copied());
        let noise = AaNoise::new(&[times.cell(TREE, TWIN)]);
        let seconds = |structure: usize| Seconds::of(&times, first, structure, rays, &noise);
        let build_s = |structure: usize| {
            let builds: Vec<f64> = epochs.iter().map(|epoch| epoch.structures[structure].build_ns as f64).collect();
            median(&builds).expect("there is an epoch") * 1e-9
        };
        self.hard.push(Hard {
            scene: first.scene.clone(),
            triangles: first.triangles,
            rays,
            stand_in: first.stand_in,
            tree: seconds(TREE),
            tree_build_s: build_s(TREE),
            sah: seconds(SAH),
            sah_build_s: build_s(SAH),
            sah_over_median: times.ratio(TREE, SAH, &noise),
            log_ratios: times.log_ratios(TREE, SAH),
            log_aa_ratios: times.log_ratios(TREE, TWIN),
            report_tree_s: row.tree_s,
            report_tree_build_s: row.build_s,
            report_tree_t_prime: t_prime(row.tree_s, row.rays, row.triangles),
        });

        // The claim is about all hard scenes: say so far as they are measured.
        let cells = |of: fn(&Hard) -> &[f64]| -> Vec<Vec<Vec<f64>>> {
            self.hard.iter().map(|hard| of(hard).iter().map(|&log| vec![log]).collect()).collect()
        };
        let noise = AaNoise::new(&cells(|hard| &hard.log_aa_ratios)).of_mean(self.hard.len());
        let mut ratios = cells(|hard| &hard.log_ratios);
        // What is not measured to its end has scenes that lack an epoch.
        cut_to_shared_epochs(&mut ratios);
        let values = epoch_values(&ratios);
        self.conclusion = Conclusion {
            scenes: self.hard.iter().map(|hard| hard.scene.clone()).collect(),
            sah_over_median: values.and_then(|values| Some(Rerun::of(&values, noise)?.ratio())),
        };
    }

    /// Adds the rays of a picture; `report` is the report's total. Gives ours.
    fn add_rays(&mut self, epoch: &Epoch, report: u64) -> u64 {
        if epoch.stand_in {
            self.stand_ins.push(epoch.scene.clone());
        }
        let asked = |query: Query| -> u64 {
            let rays = epoch.structures[0].rays.iter().filter(|rays| rays.query == query);
            rays.map(|rays| rays.all as u64).sum()
        };
        let (closest, shadow) = (asked(Query::Closest), asked(Query::Any));
        let primary = closest.min(u64::from(PICTURE[0]) * u64::from(PICTURE[1]));
        let (scene, mirror, total) = (epoch.scene.clone(), closest - primary, closest + shadow);
        self.rays.push(Rays { scene, primary, mirror, shadow, total, report });
        total
    }
}

impl Seconds {
    fn of(times: &WholeTimes, first: &Epoch, structure: usize, rays: u64, noise: &AaNoise) -> Self {
        let seconds = times.seconds(structure, noise);
        let t_prime = |seconds: f64| t_prime(seconds, rays, first.triangles);
        let Structure { rays: timed, .. } = &first.structures[structure];
        Self {
            seconds: seconds.estimate,
            t_prime: seconds.map(t_prime),
            extrapolated: timed.iter().any(|rays| rays.rays < rays.all),
        }
    }
}
