//! One epoch of one scene.

use super::design::Cell;
use super::design::Factor;
use super::{Case, Counted, Settings, Tree};
use crate::accel::{Counts, Query};
use crate::geometry::{Hit, Ray};
use crate::measure::{Clock, Pass, Plan, Samples, Timed, take, take_again};
use crate::registry::{Choice, Registry};
use crate::scene::{Sampling, Scene, Workload};
use crate::study::built::Built;
use crate::study::check::check_all;
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
    epoch: usize,
    first: Option<&Case>,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Case, StudyError> {
    let cells: Vec<Cell> = Cell::all().into_iter().chain([Cell::REPORT, Cell::SAH]).collect();
    let choices: Result<Vec<Choice>, _> =
        cells.iter().map(|cell| registry.choose(&cell.spec(&settings.test))).collect();
    let mut built = vec![];
    for choice in &choices? {
        progress(Stage::Build(&choice.label));
        built.push(Built::new(choice, scene, &settings.threads, clock)?);
    }

    progress(Stage::Rays(settings.workload.name()));
    let guide = built[Cell::SAH.number()].accel.as_ref();
    let sampling = Sampling::about(scene, settings.rays, settings.seed);
    let workload = Workload::new(scene, settings.workload, &sampling, guide);
    if workload.rays.is_empty() {
        return Err(StudyError::NoRays { scene: scene.name.clone(), rays: workload.name });
    }

    // Builds and answers do not change from epoch to epoch, and checksums hold them to it.
    let counts = match first {
        None => Some(counted(scene, &built, &workload, settings, clock, progress)?),
        Some(_) => None,
    };
    let samples = timed(&built, &workload, settings, epoch, first, clock, progress).map_err(|(structure, cause)| {
        StudyError::Unsteady { structure, scene: scene.name.clone(), rays: workload.name.clone(), cause }
    })?;
    if let Some(first) = first {
        let changed = first.trees.iter().zip(&samples).position(|(first, now)| first.checksum != now.checksum);
        if let Some(i) = changed {
            return Err(StudyError::Changed { structure: built[i].choice.label.clone(), scene: scene.name.clone() });
        }
    }

    let levels = |cell: Cell| Factor::ALL.map(|factor| factor.levels()[cell.level(factor)].name.to_owned());
    let trees = cells.iter().zip(&built).zip(samples).map(|((&cell, built), samples)| Tree {
        levels: levels(cell),
        build_ns: built.build_ns,
        rays: samples.rays,
        checksum: samples.checksum,
        ns: samples.ns,
    });
    Ok(Case {
        scene: scene.name.clone(),
        scene_hash: scene.hash(),
        triangles: scene.mesh.len(),
        stand_in: !scene.stand_ins.is_empty(),
        workload_hash: workload.hash(),
        workload_rays: workload.rays.len(),
        workload: workload.name,
        epoch,
        trees: trees.collect(),
        counts,
    })
}

/// Samples of all trees.
fn timed(
    built: &[Built],
    workload: &Workload,
    settings: &Settings,
    epoch: usize,
    first: Option<&Case>,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Vec<Samples>, (String, crate::measure::UnsteadyAnswers)> {
    let mut cases: Vec<Box<dyn Timed + '_>> = vec![];
    for built in built {
        cases.push(Box::new(Pass::new(built.accel.as_ref(), &workload.rays, workload.query, &settings.threads)));
    }
    // The search for the number of rays and the warm-up cost about three passes more than the samples.
    let slots = (cases.len() * (settings.runs + 3)) as u64;
    let plan = Plan {
        runs: settings.runs,
        sample_budget_ns: (settings.budget_ns / slots).max(1),
        warmup: 1,
        seed: settings.seed.wrapping_add(epoch as u64),
    };
    let total = cases.len() * settings.runs;
    let mut told = |taken| progress(Stage::Trace(taken, total));
    let samples = match first {
        None => take(clock, &mut cases, &plan, &mut told),
        Some(first) => {
            let none =
                |tree: &Tree| Samples { rays: tree.rays, checksum: 0, same_answers: true, unsteady: 0, ns: vec![] };
            let mut samples: Vec<Samples> = first.trees.iter().map(none).collect();
            take_again(clock, &mut cases, &plan, &mut samples, &mut told).map(|()| samples)
        }
    };
    samples.map_err(|cause| (built[cause.case].choice.label.clone(), cause))
}

/// Holds all trees against brute force on some rays and against each other on all, and counts what they do.
fn counted(
    scene: &Scene,
    built: &[Built],
    workload: &Workload,
    settings: &Settings,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Vec<Counted>, StudyError> {
    let checks = check_all(scene, built, &[&workload.rays], clock, settings.check_ns, progress)?;
    let wrong = |built: &Built, errors, checked| StudyError::Wrong {
        structure: built.choice.label.clone(),
        scene: scene.name.clone(),
        errors,
        checked,
    };
    let mut answers: Option<Vec<Option<Hit>>> = None;
    let mut counted = vec![];
    for (built, checks) in built.iter().zip(checks) {
        let panicked = || StudyError::Panicked { structure: built.choice.label.clone(), scene: scene.name.clone() };
        let check = checks.ok_or_else(panicked)?[0];
        if check.errors > 0 {
            return Err(wrong(built, check.errors, check.rays));
        }
        let mut counts = Counts::default();
        let hits = count(built, &workload.rays, workload.query, &mut counts);
        // Trees over one triangle test answer alike to the bit, so that all rays check all trees.
        let expected = answers.get_or_insert_with(|| hits.clone());
        let errors = expected.iter().zip(&hits).filter(|(a, b)| a != b).count();
        if errors > 0 {
            return Err(wrong(built, errors, hits.len()));
        }
        let shape = built.accel.shape();
        counted.push(Counted {
            tests: counts.tests,
            steps: counts.steps(),
            references: shape.references,
            leaves: shape.leaves,
            depth: shape.depth,
            bytes: built.accel.footprint().total(),
            checked_rays: check.rays,
        });
    }
    Ok(counted)
}

/// The answers, counting what is done for them; of an any-hit query that there is one.
fn count(built: &Built, rays: &[Ray], query: Query, counts: &mut Counts) -> Vec<Option<Hit>> {
    match query {
        Query::Closest => {
            let mut hits = vec![None; rays.len()];
            built.accel.closest_hits_counted(rays, &mut hits, counts);
            hits
        }
        Query::Any => {
            let mut hits = vec![false; rays.len()];
            built.accel.any_hits_counted(rays, &mut hits, counts);
            let some = Hit { t: 0.0, prim: crate::geometry::PrimId::new(0) };
            hits.into_iter().map(|hit| hit.then_some(some)).collect()
        }
    }
}
