//! Seconds of a whole picture.

use super::{Settings, picture::Picture};
use crate::accel::Query;
use crate::measure::{Clock, Pass, Plan, Timed, take};
use crate::registry::Choice;
use crate::scene::Scene;
use crate::study::built::Built;
use crate::study::check::check_all;
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
    let batches: Vec<(&[_], Query)> = [(&picture.closest[..], Query::Closest), (&picture.any[..], Query::Any)]
        .into_iter()
        .filter(|(rays, _)| !rays.is_empty())
        .collect();
    let rays: Vec<&[_]> = batches.iter().map(|(rays, _)| *rays).collect();
    let checks = check_all(scene, &built, &rays, clock, settings.check_ns, progress)?;
    for (built, checks) in built.iter().zip(&checks) {
        let panicked = || StudyError::Panicked { structure: built.choice.label.clone(), scene: scene.name.clone() };
        if let Some(check) = checks.as_ref().ok_or_else(panicked)?.iter().find(|check| check.errors > 0) {
            return Err(StudyError::Wrong {
                structure: built.choice.label.clone(),
                scene: scene.name.clone(),
                errors: check.errors,
                checked: check.rays,
            });
        }
    }

    let mut cases: Vec<Box<dyn Timed + '_>> = vec![];
    for built in &built {
        for &(rays, query) in &batches {
            cases.push(Box::new(Pass::new(built.accel.as_ref(), rays, query, &settings.threads)));
        }
    }
    let plan = Plan { runs, sample_budget_ns: settings.sample_ns, warmup: 1, seed: settings.seed };
    let total = runs * cases.len();
    let samples = take(clock, &mut cases, &plan, &mut |taken| progress(Stage::Trace(taken, total)));
    let samples = samples.map_err(|cause| StudyError::Unsteady {
        structure: built[cause.case / batches.len()].choice.label.clone(),
        scene: scene.name.clone(),
        rays: "image".into(),
        cause,
    })?;

    let timings = samples.chunks(batches.len()).zip(&built).map(|(samples, built)| {
        let second = |round: usize| {
            let parts = samples.iter().zip(&batches);
            parts.map(|(s, (rays, _))| s.ns_per_ray()[round] * rays.len() as f64 * 1e-9).sum()
        };
        Timing {
            seconds: (0..runs).map(second).collect(),
            extrapolated: samples.iter().zip(&batches).any(|(s, (rays, _))| s.rays < rays.len()),
            build_s: built.build_ns as f64 * 1e-9,
        }
    });
    Ok(timings.collect())
}
