//! `replicate`: the source report's tables measured again, and the claim it ends with put to the test.
//!
//! The report times all rays of a picture, construction left out, on a machine of its own: seconds can be compared with its
//! seconds only in their ratios. `t'` is seconds / (rays x triangles).

pub(in crate::study) mod original;
mod tables;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use super::epoch::{self, Asked, Epoch, PICTURE, Structure, WholeTimes, measure};
use crate::accel::Query;
use crate::measure::{AaNoise, Clock, Estimate, Provenance, Rerun, Threads, epoch_values, median};
use crate::registry::{Choice, ChoiceError, Registry};
use crate::scene::Scene;
use crate::study::baselines::{BRUTE_FORCE, REPORT_TREE, SAH_TREE};
use crate::study::parameters;
use crate::study::{Stage, StudyError};
use original::{HARD, HardRow, MAIN, SWEEP, t_prime};

pub use tables::tables;

/// How long the study may take.
pub struct Settings {
    /// How often everything is built anew, at least 1.
    pub epochs: usize,
    /// Samples of every structure in an epoch, at least 1.
    pub runs: usize,
    /// What the samples of an epoch of one scene may take together, nanoseconds; slow structures are timed on fewer rays and
    /// extrapolated.
    pub budget_ns: u64,
    /// Seed of the order of samples.
    pub seed: u64,
    pub threads: Threads,
}

/// The report's three tables, ours beside its own, and its conclusion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Replication {
    /// Version of this form.
    pub schema: u32,
    /// Scenes in which a mesh of our own stands in for a real one.
    pub stand_ins: Vec<String>,
    pub rays: Vec<Rays>,
    pub main: Vec<Main>,
    pub parameters: Vec<Setting>,
    pub hard: Vec<Hard>,
    pub conclusion: Conclusion,
    pub provenance: Provenance,
}

/// Rays of a 512 x 512 picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seconds {
    /// Geometric mean over the epochs.
    pub seconds: f64,
    /// `t'`: seconds / (rays x triangles).
    pub t_prime: Estimate,
    /// Whether a part of the rays was timed and stands for all.
    pub extrapolated: bool,
}

/// An easy or normal scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conclusion {
    /// The scenes of the mean.
    pub scenes: Vec<String>,
    /// Geometric mean over the scenes of how much faster SAH is, with the interval that holds that of another run in 95 % of cases.
    pub sah_over_median: Option<Estimate>,
}

/// What the study is told to do and told of, and what it makes of it.
pub struct Study<'a> {
    pub registry: &'a Registry,
    pub settings: &'a Settings,
    pub clock: &'a dyn Clock,
}

/// Where structures stand among those of an easy or normal scene: before the sweep of [`parameters::structures`].
const BRUTE: usize = 0;
const SAH: usize = 1;
const FIRST_SETTING: usize = 2;

impl Study<'_> {
    /// An empty result, to which scenes are added.
    pub fn start(&self) -> Replication {
        Replication::empty(Provenance::of(&self.settings.threads))
    }

    /// Names of the scenes of the report: easy and normal, then hard.
    pub fn scenes() -> Vec<&'static str> {
        MAIN.iter().map(|row| row.scene).chain(HARD.iter().map(|row| row.scene)).collect()
    }

    /// Measures one scene of the report; others are passed over.
    ///
    /// # Errors
    /// If a structure of the study is not registered, cannot be built or answers wrongly.
    pub fn add(
        &self,
        scene: &Scene,
        result: &mut Replication,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<(), StudyError> {
        if MAIN.iter().any(|row| row.scene == scene.name) {
            let mut structures = self.choose(&[BRUTE_FORCE, SAH_TREE])?;
            structures.extend(parameters::structures(self.registry)?);
            result.add_main(&self.epochs(scene, structures, Asked::Picture, progress)?);
        }
        if HARD.iter().any(|row| row.scene == scene.name) {
            let structures = self.choose(&[REPORT_TREE, SAH_TREE, REPORT_TREE])?;
            result.add_hard(&self.epochs(scene, structures, Asked::PrimaryPicture, progress)?);
        }
        Ok(())
    }

    /// All epochs of a scene. A wrong answer ends the study: there is nothing to compare with the report then.
    fn epochs(
        &self,
        scene: &Scene,
        structures: Vec<Choice>,
        asked: Asked,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Vec<Epoch>, StudyError> {
        let Settings { runs, budget_ns, seed, ref threads, .. } = *self.settings;
        let guide = self.registry.choose(SAH_TREE)?;
        let threads = threads.clone();
        let settings = epoch::Settings { structures, guide, asked, runs, budget_ns, seed, threads };
        let mut epochs: Vec<Epoch> = vec![];
        for number in 0..self.settings.epochs {
            let epoch = measure(scene, &settings, number, epochs.first(), self.clock, progress)?;
            epoch.is_whole()?;
            epochs.push(epoch);
        }
        Ok(epochs)
    }

    fn choose(&self, specs: &[&str]) -> Result<Vec<Choice>, ChoiceError> {
        specs.iter().map(|spec| self.registry.choose(spec)).collect()
    }
}

impl Replication {
    /// Without any scene.
    fn empty(provenance: Provenance) -> Self {
        Self {
            schema: 2,
            stand_ins: vec![],
            rays: vec![],
            main: vec![],
            parameters: vec![],
            hard: vec![],
            conclusion: Conclusion { scenes: vec![], sah_over_median: None },
            provenance,
        }
    }

    /// Adds an easy or normal scene of the report.
    fn add_main(&mut self, epochs: &[Epoch]) {
        let first = &epochs[0];
        let Some(index) = MAIN.iter().position(|row| row.scene == first.scene) else { return };
        let row = &MAIN[index];
        let rays = self.add_rays(first, row.rays);
        let setting = |row: usize| FIRST_SETTING + row;
        let (tree, twin) = (setting(parameters::default_row()), setting(SWEEP.len()));

        let times = WholeTimes::new(epochs);
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

    /// Adds a hard scene of the report: its tree, the SAH tree, and its tree once more.
    fn add_hard(&mut self, epochs: &[Epoch]) {
        const TREE: usize = 0;
        const TWIN: usize = 2;
        let first = &epochs[0];
        let Some(row): Option<&HardRow> = HARD.iter().find(|row| row.scene == first.scene) else { return };
        let rays = self.add_rays(first, row.rays);

        let times = WholeTimes::new(epochs);
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
        let values = epoch_values(&cells(|hard| &hard.log_ratios));
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
