//! From epochs to one record a case.

use super::{Compared, twins};
use crate::measure::advice::{Conditions, of_own_clock, of_samples};
use crate::measure::{Part, Provenance, machine, median};
use crate::report::{CaseCounts, Record};
use crate::study::Refused;
use crate::study::epoch::{Epoch, RayDetails, Rays, scenes, twin_of};

/// The records of all scenes, each structure by structure. `epochs` are detailed.
pub fn compared<'a>(epochs: impl IntoIterator<Item = &'a Epoch>, provenance: &Provenance) -> Compared {
    let mut all = Compared::default();
    for scene in scenes(epochs) {
        let mut of_scene = of_scene(&scene, provenance);
        all.records.append(&mut of_scene.records);
        all.refused.append(&mut of_scene.refused);
    }
    all
}

fn of_scene(epochs: &[&Epoch], provenance: &Provenance) -> Compared {
    let first = epochs[0];
    let mut compared = Compared::default();
    let warnings = warnings(epochs, provenance);
    for place in 0..first.structures.len() {
        if twin_of(first, place).is_some() {
            continue;
        }
        let of_epochs = || epochs.iter().filter_map(|epoch| epoch.structures.get(place));
        if let Some(reason) = of_epochs().find_map(|structure| structure.refused.clone()) {
            let (label, scene) = (first.structures[place].label.clone(), first.scene.clone());
            let wrong = of_epochs().any(|structure| structure.wrong);
            compared.refused.push(Refused { label, scene, reason, wrong });
            continue;
        }
        let twin = (0..first.structures.len()).find(|&other| twin_of(first, other) == Some(place));
        for kind in 0..first.structures[place].rays.len() {
            compared.records.extend(record(epochs, place, twin, kind, provenance, &warnings));
        }
    }
    let floor = twins(&compared.records).log().map(|log| libm::exp(log) - 1.0);
    compared.records.iter_mut().for_each(|record| record.noise_floor = floor);
    compared
}

fn rays<'a>(epochs: &'a [&Epoch], place: usize, kind: usize) -> impl Iterator<Item = &'a Rays> {
    epochs.iter().filter_map(move |epoch| epoch.structures.get(place)?.rays.get(kind))
}

fn samples<'a>(rays: impl Iterator<Item = &'a Rays>) -> Vec<f64> {
    rays.flat_map(|rays| &rays.ns).map(|&ns| ns.max(1) as f64).collect()
}

/// One structure on one kind of rays; nothing if its first epoch is not detailed.
fn record(
    epochs: &[&Epoch],
    place: usize,
    twin: Option<usize>,
    kind: usize,
    provenance: &Provenance,
    warnings: &[String],
) -> Option<Record> {
    let scene = epochs[0];
    let structure = &scene.structures[place];
    let first = &structure.rays[kind];
    let (details, of_rays) = (structure.details.as_ref()?, first.details.as_ref()?);
    let build_samples_ns: Vec<u64> = epochs.iter().map(|epoch| epoch.structures[place].build_ns).collect();
    let builds: Vec<f64> = build_samples_ns.iter().map(|&ns| ns as f64).collect();
    let samples_ns = samples(rays(epochs, place, kind));
    let trace_ns = median(&samples_ns);
    let timed = trace_ns.is_some();
    // Of a program each may have been timed on as many rays as its clock allowed.
    let twin = twin.filter(|&twin| timed && rays(epochs, twin, kind).all(|own| own.rays == first.rays));
    let twin = twin.map(|twin| samples(rays(epochs, twin, kind)));
    let RayDetails { checked, errors, ref declined, .. } = *of_rays;
    Some(Record {
        schema: Record::SCHEMA,
        scene: scene.scene.clone(),
        scene_hash: scene.scene_hash.clone(),
        triangles: scene.triangles,
        degenerate: scene.degenerate,
        stand_in: scene.stand_in,
        structure: structure.name.clone(),
        label: structure.label.clone(),
        config: details.config.clone(),
        triangle_test: details.triangle_test.clone(),
        workload: first.workload.clone(),
        query: first.query,
        workload_hash: first.hash.clone(),
        workload_rays: first.all,
        rays: if timed { first.rays } else { 0 },
        sampled: !timed || first.rays < first.all,
        parts: if timed { parts(epochs, place, kind) } else { vec![] },
        counted_rays: first.counts.map_or(0, |counts| counts.rays),
        hits: first.counts.map_or(0, |counts| counts.hits),
        answers: timed.then(|| format!("{:016x}", first.checksum)),
        build_ns: median(&builds).expect("every epoch builds") as u64,
        build_samples_ns,
        build_peak_bytes: details.build_peak_bytes,
        trace_ns,
        runs: samples_ns.len(),
        epochs: epochs.len(),
        samples_ns,
        twin_samples_ns: twin.filter(|samples| !samples.is_empty()),
        noise_floor: None,
        mrays_per_s: trace_ns.map(|ns| first.rays as f64 * 1e3 / ns),
        tests_per_ray: first.counts.and_then(|counts| counts.tests_per_ray()),
        steps_per_ray: first.counts.and_then(|counts| counts.steps_per_ray()),
        instructions_per_ray: of_rays.instructions_per_ray,
        branch_misses_per_ray: of_rays.branch_misses_per_ray,
        bytes: structure.shape.bytes,
        declined: declined.clone(),
        checked_rays: checked,
        structure_errors: errors,
        provenance: Provenance { warnings: warnings.to_vec(), ..provenance.clone() },
        counts: CaseCounts {
            leaf_steps_per_ray: of_rays.leaf_steps_per_ray,
            empty_leaf_steps_per_ray: of_rays.empty_leaf_steps_per_ray,
            tests_over_minimum: of_rays.tests_over_minimum,
            ..details.counts
        },
    })
}

fn parts(epochs: &[&Epoch], place: usize, kind: usize) -> Vec<Part> {
    let mut all: Vec<Part> = vec![];
    for part in rays(epochs, place, kind).flat_map(|rays| &rays.parts) {
        match all.iter_mut().find(|other| other.rays == part.rays) {
            Some(other) => other.ns.extend_from_slice(&part.ns),
            None => all.push(part.clone()),
        }
    }
    all
}

fn warnings(epochs: &[&Epoch], provenance: &Provenance) -> Vec<String> {
    let mut conditions = Conditions {
        load: provenance.load,
        cores: provenance.cores,
        governor: provenance.governor.clone(),
        denormals: machine::denormals(provenance.mxcsr),
        debug: provenance.profile == "debug",
        ..Conditions::default()
    };
    epochs.iter().filter_map(|epoch| epoch.circumstances).for_each(|own| own.add_to(&mut conditions));
    let mut warnings = conditions.warnings();
    let kinds = |place: usize| 0..epochs[0].structures[place].rays.len();
    let all = (0..epochs[0].structures.len()).flat_map(|place| kinds(place).map(move |kind| (place, kind)));
    let samples: Vec<Vec<f64>> = all.map(|(place, kind)| samples(rays(epochs, place, kind))).collect();
    let samples: Vec<&[f64]> = samples.iter().map(Vec::as_slice).filter(|samples| !samples.is_empty()).collect();
    warnings.extend(of_samples(&samples));
    let runners = epochs[0].structures.iter().enumerate().filter_map(|(place, structure)| {
        let outside = epochs.iter().filter_map(|epoch| epoch.structures.get(place)?.outside);
        of_own_clock(&structure.label, median(&outside.collect::<Vec<_>>())?)
    });
    warnings.extend(runners);
    warnings
}
