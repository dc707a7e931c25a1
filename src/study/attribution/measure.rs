//! One epoch of one scene.

use super::design::Cell;
use super::{Case, Settings};
use crate::measure::Clock;
use crate::registry::{Choice, ChoiceError, Registry};
use crate::scene::{Sampling, Scene, Workload};
use crate::study::trial::{Trial, build};
use crate::study::{Stage, StudyError};

/// Builds all trees, checks and counts them if this is the first epoch, and takes their samples. A later epoch needs the
/// `first` one: its trees are timed on the same rays, and must give the same answers.
///
/// # Errors
/// If a tree cannot be built or gives wrong answers, or the scene has no such rays.
pub fn measure(
    registry: &Registry,
    scene: &Scene,
    settings: &Settings,
    number: usize,
    first: Option<&Case>,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Case, StudyError> {
    let cells = Cell::all().into_iter().chain([Cell::REPORT, Cell::SAH]);
    let choices: Result<Vec<Choice>, ChoiceError> =
        cells.map(|cell| registry.choose(&cell.spec(&settings.test))).collect();
    let built = build(scene, &choices?, &settings.threads, clock, progress)?;

    progress(Stage::Rays(settings.workload.name()));
    let guide = built[Cell::SAH.number()].accel.as_ref();
    let sampling = Sampling::about(scene, settings.rays, settings.seed);
    let workload = Workload::new(scene, settings.workload, &sampling, guide);
    if workload.rays.is_empty() {
        return Err(StudyError::NoRays { scene: scene.name.clone(), rays: workload.name });
    }
    let trial = Trial {
        scene,
        built: &built,
        workloads: std::slice::from_ref(&workload),
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
        stand_in: !scene.stand_ins.is_empty(),
        workload_hash: workload.hash(),
        workload_rays: workload.rays.len(),
        workload: workload.name,
        epoch,
    })
}
