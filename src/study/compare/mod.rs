//! `compare`: every structure builds, is checked, counted and timed on every workload of a scene.

mod table;
#[cfg(test)]
mod tests;
mod trace;

use super::built::Built;
use super::check::{Check, check_all};
use super::{PANICKED, Refused, Stage, StudyError};
use crate::accel::{DynAccel, Query};
use crate::geometry::Ray;
use crate::measure::{Clock, Provenance, Threads, median};
use crate::registry::Choice;
use crate::report::{CaseCounts, Record};
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};

pub use table::{legend, mean_table, scene_table};

/// What is compared, and for how long.
pub struct Settings {
    /// The structures, in the order of the tables.
    pub structures: Vec<Choice>,
    /// The structure that tells where secondary rays start.
    pub guide: Choice,
    /// The kinds of rays. `Mirror` is left out of scenes without mirrors.
    pub workloads: Vec<WorkloadKind>,
    /// Rays made before, in place of those kinds where there are any.
    pub replayed: Option<Workload>,
    /// Rays of a workload, at most.
    pub rays: u32,
    /// Samples of every case.
    pub runs: usize,
    /// What a scene may take, builds included, nanoseconds: slow cases are timed on fewer rays to keep within it.
    pub budget_ns: u64,
    /// Seed of the workloads and of the order of samples.
    pub seed: u64,
    pub threads: Threads,
}

/// What came of one scene.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    /// One for each structure and workload, in the order of the settings, structure by structure.
    pub records: Vec<Record>,
    /// The structures without records.
    pub refused: Vec<Refused>,
}

/// Compares the structures. One that cannot be built, or that panics on a ray, is refused; the others go on.
///
/// # Errors
/// If a structure answers the same rays differently.
pub fn compare_scene(
    scene: &Scene,
    settings: &Settings,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Compared, StudyError> {
    let start = clock.now_ns();
    let (mut built, mut refused) = (vec![], vec![]);
    for choice in &settings.structures {
        progress(Stage::Build(&choice.label));
        match Built::new(choice, scene, &settings.threads, clock) {
            Ok(structure) => built.push(structure),
            Err(StudyError::Build { structure, cause, .. }) => {
                refused.push(Refused { label: structure, reason: cause.to_string() });
            }
            Err(other) => return Err(other),
        }
    }

    // The same rays for all structures; those that start on a surface start where the guide finds it. A workload may come
    // out empty: nothing casts shadows where nothing is hit.
    let own_guide;
    let guide = match built.iter().find(|built| built.choice.label == settings.guide.label) {
        Some(built) => built.accel.as_ref(),
        None => {
            own_guide = Built::new(&settings.guide, scene, &settings.threads, clock)?;
            own_guide.accel.as_ref()
        }
    };
    let mut workloads: Vec<Workload> = vec![];
    let sampling = Sampling::about(scene, settings.rays, settings.seed);
    let made =
        |kind: &&WorkloadKind| settings.replayed.is_none() && (**kind != WorkloadKind::Mirror || scene.has_mirrors());
    for &kind in settings.workloads.iter().filter(made) {
        progress(Stage::Rays(kind.name()));
        workloads.push(Workload::new(scene, kind, &sampling, guide));
    }
    if let Some(replayed) = &settings.replayed {
        workloads = vec![replayed.clone()];
    }
    workloads.retain(|workload| !workload.rays.is_empty());

    // A quarter of the time is for the truth.
    let batches: Vec<&[Ray]> = workloads.iter().map(|workload| &workload.rays[..]).collect();
    let checks = check_all(scene, &built, &batches, clock, settings.budget_ns / 4, progress)?;
    let (built, checks) = survivors(built, checks, &mut refused);

    let spent = clock.now_ns() - start;
    let budget_ns = settings.budget_ns.saturating_sub(spent).max(settings.budget_ns / 3);
    let traces = trace::trace_all(scene, &built, &workloads, &checks, settings, clock, budget_ns, progress)?;
    let checked: Vec<(Built, Vec<Check>)> = built.into_iter().zip(checks).collect();
    let (checked, traces) = survivors(checked, traces, &mut refused);

    let provenance = Provenance::capture(settings.threads.count());
    let hash = scene.hash();
    let hashes: Vec<String> = workloads.iter().map(Workload::hash).collect();
    let mut records = vec![];
    for ((built, checks), traces) in checked.iter().zip(&traces) {
        let shape = CaseCounts::of(&built.accel.shape());
        for (w, workload) in workloads.iter().enumerate() {
            let (check, trace) = (&checks[w], &traces[w]);
            let trace_ns = median(&trace.ns);
            records.push(Record {
                schema: Record::SCHEMA,
                scene: scene.name.clone(),
                scene_hash: hash.clone(),
                triangles: scene.mesh.len(),
                degenerate: scene.mesh.degenerate().len(),
                stand_in: !scene.stand_ins.is_empty(),
                structure: built.choice.entry.name.clone(),
                label: built.choice.label.clone(),
                config: built.choice.config.clone(),
                triangle_test: built.choice.triangle_test().into(),
                workload: workload.name.clone(),
                query: workload.query,
                workload_hash: hashes[w].clone(),
                workload_rays: workload.rays.len(),
                rays: trace.rays,
                sampled: trace.rays < workload.rays.len(),
                hits: trace.hits,
                build_ns: built.build_ns,
                trace_ns,
                runs: trace.ns.len(),
                samples_ns: trace.ns.clone(),
                mrays_per_s: trace_ns.map(|ns| trace.rays as f64 * 1e3 / ns),
                tests_per_ray: trace.tests_per_ray,
                steps_per_ray: trace.steps_per_ray,
                bytes: built.accel.footprint().total(),
                declined: declined(built.accel.as_ref(), workload).map(String::from),
                checked_rays: Some(check.rays),
                structure_errors: Some(check.errors),
                provenance: provenance.clone(),
                counts: CaseCounts {
                    leaf_steps_per_ray: trace.leaf_steps_per_ray,
                    empty_leaf_steps_per_ray: trace.empty_leaf_steps_per_ray,
                    tests_over_minimum: trace.tests_over_minimum,
                    ..shape
                },
            });
        }
    }
    Ok(Compared { records, refused })
}

/// What of a workload a structure declines, if anything is: then it has no time.
pub(super) fn declined(accel: &dyn DynAccel, workload: &Workload) -> Option<&'static str> {
    let can = accel.capabilities();
    if workload.query == Query::Any && !can.any_hit {
        return Some("any hit");
    }
    workload.rays.iter().find_map(|ray| can.declines(ray))
}

/// Those that have a result, with it; the others are refused.
fn survivors<S: Labelled, R>(
    structures: Vec<S>,
    results: Vec<Option<R>>,
    refused: &mut Vec<Refused>,
) -> (Vec<S>, Vec<R>) {
    let (mut alive, mut kept) = (vec![], vec![]);
    for (structure, result) in structures.into_iter().zip(results) {
        match result {
            Some(result) => {
                alive.push(structure);
                kept.push(result);
            }
            None => refused.push(Refused { label: structure.label().into(), reason: PANICKED.into() }),
        }
    }
    (alive, kept)
}

/// What is known by the label of a structure.
trait Labelled {
    fn label(&self) -> &str;
}

impl Labelled for Built {
    fn label(&self) -> &str {
        &self.choice.label
    }
}

impl Labelled for (Built, Vec<Check>) {
    fn label(&self) -> &str {
        self.0.label()
    }
}
