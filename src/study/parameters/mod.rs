//! `parameters`: the report's sweep of its leaf limit and match threshold; which differences are real?
//!
//! The report prints single runs. Here every setting is built anew in several epochs and timed in interleaved rounds on all rays
//! of the picture, the setting of the report's main table twice: what these twins differ by is the noise floor. Cube has fewer
//! triangles than every leaf limit, so that all its settings are the same tree: the control.

mod result;
mod student;
mod table;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use super::replicate::original::{MAIN, SWEEP, SweepRow};
use super::replicate::picture::Picture;
use super::trial::{Epoch, Trial, build};
use super::{SAH_TREE, Stage, StudyError};
use crate::accel::Query;
use crate::measure::{Clock, Threads};
use crate::registry::{Choice, ChoiceError, Registry};
use crate::scene::{Scene, Workload};
use crate::study::baselines::REPORT_TREE;
use crate::study::built::Built;

pub use result::{Parameters, Setting, Verdict, result, rows};
pub use table::tables;

/// Name of the study, and of its journal.
pub const NAME: &str = "parameters";

/// The setting of the report's main table: the others are held against it.
pub const DEFAULT: (u32, f32) = (100, 0.7);

/// How long the study may take.
pub struct Settings {
    /// Samples of every setting in an epoch, at least 1.
    pub runs: usize,
    /// What the samples of an epoch of one scene may take together, nanoseconds: slow settings are timed on fewer rays.
    pub budget_ns: u64,
    /// What the check of the answers may take for each scene, nanoseconds.
    pub check_ns: u64,
    /// Seed of the order of samples.
    pub seed: u64,
    pub threads: Threads,
}

/// The settings as a journal keeps them.
#[derive(Serialize)]
struct Kept {
    runs: usize,
    budget_ns: u64,
    seed: u64,
}

impl Settings {
    /// What a journal keeps of them.
    pub fn kept(&self) -> impl Serialize {
        Kept { runs: self.runs, budget_ns: self.budget_ns, seed: self.seed }
    }
}

/// One epoch of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    pub scene: String,
    pub scene_hash: String,
    pub triangles: usize,
    /// Rays of the picture: closest hit, any hit.
    pub rays: Vec<usize>,
    /// The settings of the sweep in their order, then the twin of the default.
    pub epoch: Epoch,
}

/// Names of the scenes of the report's sweep.
pub fn scenes() -> Vec<&'static str> {
    MAIN.iter().map(|row| row.scene).collect()
}

/// The key of an epoch of a scene.
pub fn key(scene: &Scene, epoch: usize) -> String {
    format!("{} {} epoch {epoch}", scene.name, &scene.hash()[..8])
}

/// The number of the default in the sweep.
fn default_row() -> usize {
    SWEEP.iter().position(is_default).expect("the sweep holds the default")
}

fn is_default(row: &SweepRow) -> bool {
    (row.leaf, row.threshold) == DEFAULT
}

/// The structures: all settings, then the default once more.
fn specs() -> Vec<String> {
    let rows = SWEEP.iter().chain([&SWEEP[default_row()]]);
    rows.map(|row| format!("{REPORT_TREE}:leaf={},threshold={}", row.leaf, row.threshold)).collect()
}

/// Measures epoch `number` of a scene; a later one needs the `first`.
///
/// # Errors
/// If a tree cannot be built or gives wrong answers.
pub fn measure(
    registry: &Registry,
    scene: &Scene,
    settings: &Settings,
    number: usize,
    first: Option<&Case>,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Case, StudyError> {
    let choices: Result<Vec<Choice>, ChoiceError> = specs().iter().map(|spec| registry.choose(spec)).collect();
    let built = build(scene, &choices?, &settings.threads, clock, progress)?;
    progress(Stage::Rays("image"));
    let guide = Built::new(&registry.choose(SAH_TREE)?, scene, &settings.threads, clock)?;
    let picture = Picture::whole(scene, guide.accel.as_ref());
    drop(guide);
    let workloads: Vec<Workload> =
        [("image", Query::Closest, picture.closest), ("image-shadow", Query::Any, picture.any)]
            .into_iter()
            .filter(|(_, _, rays)| !rays.is_empty())
            .map(|(name, query, rays)| Workload { name: name.into(), query, rays })
            .collect();
    let trial = Trial {
        scene,
        built: &built,
        workloads: &workloads,
        runs: settings.runs,
        budget_ns: settings.budget_ns,
        check_ns: settings.check_ns,
        seed: settings.seed,
        threads: &settings.threads,
        clock,
    };
    let epoch = trial.epoch(number, first.map(|case| &case.epoch), progress)?;
    Ok(Case {
        scene: scene.name.clone(),
        scene_hash: scene.hash(),
        triangles: scene.mesh.len(),
        rays: workloads.iter().map(|workload| workload.rays.len()).collect(),
        epoch,
    })
}
