//! Seconds of a whole picture.

use super::{Settings, picture::Picture};
use crate::geometry::Ray;
use crate::measure::{Clock, Plan};
use crate::registry::Choice;
use crate::scene::Scene;
use crate::study::built::Built;
use crate::study::check::check_all;
use crate::study::timing::{self, Case};
use crate::study::{Stage, StudyError};

/// How long one structure takes for all rays of a picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Timing {
    /// Seconds of each round: those of two structures of one call with the same index are a pair.
    pub seconds: Vec<f64>,
    /// Whether a part of the rays was timed and stands for all.
    pub extrapolated: bool,
    /// Seconds of the construction.
    pub build_s: f64,
}

/// Times `structures` on all rays of `picture`, `runs` times, interleaved.
///
/// # Errors
/// If a structure refuses the mesh or gives a wrong answer.
pub(super) fn time(
    scene: &Scene,
    picture: &Picture,
    structures: &[Choice],
    runs: usize,
    settings: &Settings,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Vec<Timing>, StudyError> {
    let mut built = vec![];
    for choice in structures {
        progress(Stage::Build(&choice.label));
        built.push(Built::new(choice, scene, &settings.threads, clock)?);
    }

    // A wrong answer ends the study: there is nothing to compare with the report then.
    let rays: Vec<&[Ray]> = picture.workloads.iter().map(|workload| &workload.rays[..]).collect();
    let checks = check_all(scene, &built, &rays, clock, settings.check_ns, progress)?;
    let panicked =
        |built: &Built| StudyError::Panicked { structure: built.choice.label.clone(), scene: scene.name.clone() };
    for (built, checks) in built.iter().zip(&checks) {
        if let Some(check) = checks.as_ref().ok_or_else(|| panicked(built))?.iter().find(|check| check.errors > 0) {
            return Err(StudyError::Wrong {
                structure: built.choice.label.clone(),
                scene: scene.name.clone(),
                errors: check.errors,
                checked: check.rays,
            });
        }
    }

    let workloads = &picture.workloads[..];
    let timing = timing::Timing { scene, built: &built, workloads, threads: &settings.threads, clock };
    let plan = Plan { runs, sample_budget_ns: settings.sample_ns, warmup: 1, seed: settings.seed };
    let cases = Case::all(built.len(), workloads.len());
    let total = runs * cases.len();
    let taken = timing.take(&cases, &plan, None, &mut |taken| progress(Stage::Trace(taken, total)))?;
    if let Some(case) = taken.panicked.iter().position(|&panicked| panicked) {
        return Err(panicked(&built[cases[case].structure]));
    }

    let timings = taken.samples.chunks(workloads.len()).zip(&built).map(|(samples, built)| {
        let second = |round: usize| {
            let parts = samples.iter().zip(workloads);
            parts.map(|(s, workload)| s.ns_per_ray()[round] * workload.rays.len() as f64 * 1e-9).sum()
        };
        Timing {
            seconds: (0..runs).map(second).collect(),
            extrapolated: samples.iter().zip(workloads).any(|(s, workload)| s.rays < workload.rays.len()),
            build_s: built.build_ns as f64 * 1e-9,
        }
    });
    Ok(timings.collect())
}
