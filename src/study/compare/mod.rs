//! `compare`: every structure builds, is checked, counted and timed on every workload of a scene.

mod table;
#[cfg(test)]
mod tests;
mod trace;

use super::built::Built;
use super::check::check_all;
use super::{Stage, StudyError};
use crate::geometry::Ray;
use crate::measure::{Clock, Provenance, Threads, median};
use crate::registry::Choice;
use crate::report::Record;
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

/// One record for each structure and workload, in the order of the settings, structure by structure.
///
/// # Errors
/// If a structure refuses the mesh, or answers the same rays differently.
pub fn compare_scene(
    scene: &Scene,
    settings: &Settings,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Vec<Record>, StudyError> {
    let start = clock.now_ns();
    let mut built = vec![];
    for choice in &settings.structures {
        progress(Stage::Build(&choice.label));
        built.push(Built::new(choice, scene, &settings.threads, clock)?);
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
    for &kind in settings.workloads.iter().filter(|&&kind| kind != WorkloadKind::Mirror || scene.has_mirrors()) {
        progress(Stage::Rays(kind.name()));
        workloads.push(Workload::new(scene, kind, &sampling, guide));
    }
    workloads.retain(|workload| !workload.rays.is_empty());

    // A quarter of the time is for the truth.
    let batches: Vec<&[Ray]> = workloads.iter().map(|workload| &workload.rays[..]).collect();
    let checks = check_all(scene, &built, &batches, clock, settings.budget_ns / 4, progress)?;

    let spent = clock.now_ns() - start;
    let budget_ns = settings.budget_ns.saturating_sub(spent).max(settings.budget_ns / 3);
    let traces = trace::trace_all(scene, &built, &workloads, &checks, settings, clock, budget_ns, progress)?;

    let provenance = Provenance::capture(settings.threads.count());
    let hash = scene.hash();
    let hashes: Vec<String> = workloads.iter().map(Workload::hash).collect();
    let mut records = vec![];
    for (s, built) in built.iter().enumerate() {
        for (w, workload) in workloads.iter().enumerate() {
            let (check, trace) = (&checks[s][w], &traces[s][w]);
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
                workload: workload.kind.name().into(),
                query: workload.query,
                workload_hash: hashes[w].clone(),
                workload_rays: workload.rays.len(),
                rays: trace.rays,
                sampled: trace.rays < workload.rays.len(),
                hits: trace.hits,
                build_ns: built.build_ns,
                trace_ns,
                runs: trace.ns.len(),
                mrays_per_s: trace_ns.map(|ns| trace.rays as f64 * 1e3 / ns),
                tests_per_ray: trace.tests_per_ray,
                steps_per_ray: trace.steps_per_ray,
                bytes: built.accel.footprint().total(),
                checked_rays: Some(check.rays),
                structure_errors: Some(check.errors),
                provenance: provenance.clone(),
            });
        }
    }
    Ok(records)
}
