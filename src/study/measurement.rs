//! The measurements of one structure on one workload in all epochs.

use serde_json::Value;

use super::epoch::{RayCounts, Rays, Shape};
use super::{Dataset, SceneEpochs};
use crate::accel::Query;
use crate::measure::{AaNoise, SubsetSamples, log_ratios, median};
use crate::report::words::scene_name;
use crate::report::{Cell, Table};
use crate::request::is_obvhs;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurement {
    pub scene: String,
    pub scene_hash: String,
    pub triangles: usize,
    pub degenerate: usize,
    pub stand_in: bool,
    /// Name in the registry.
    pub structure: String,
    pub label: String,
    pub role: String,
    pub config: Value,
    pub triangle_test: String,
    pub workload: String,
    pub query: Query,
    pub workload_hash: String,
    /// Number of rays in the whole workload.
    pub workload_rays: usize,
    /// Number of rays in one sample, or 0 if `trace_ns` is `None`.
    pub rays: usize,
    /// Whether a sample has fewer rays than the workload. Also true if `trace_ns` is `None`.
    pub sampled: bool,
    pub parts: Vec<SubsetSamples>,
    /// `RayCounts::default()` if epoch 0 has no counts.
    pub counts: RayCounts,
    /// Checksum of hits. The checksum covers only rays that all epochs trace.
    pub hit_checksum: Option<u64>,
    /// The median of `build_samples_ns`.
    pub build_ns: u64,
    pub build_samples_ns: Vec<u64>,
    pub build_peak_bytes: Option<usize>,
    /// The median of `samples_ns`.
    pub trace_ns: Option<f64>,
    pub epochs: usize,
    /// In the order of the epochs. Each epoch has the same number of samples.
    pub samples_ns: Vec<f64>,
    /// `None` if no twin was timed on equally many rays.
    pub twin_samples_ns: Option<Vec<f64>>,
    pub twin_builds_ns: Option<Vec<u64>>,
    pub mrays_per_s: Option<f64>,
    pub shape: Shape,
    pub declined: Option<String>,
    pub checked_rays: usize,
    /// Number of checked rays with an error that rounding cannot explain.
    pub wrong_hits: usize,
}

pub type MeasurementColumn = (&'static str, fn(&Measurement) -> Cell);

pub const COLUMNS: [MeasurementColumn; 36] = [
    ("scene", |own| (&own.scene).into()),
    ("scene_hash", |own| (&own.scene_hash).into()),
    ("stand_in", |own| own.stand_in.into()),
    ("triangles", |own| own.triangles.into()),
    ("structure", |own| (&own.structure).into()),
    ("label", |own| (&own.label).into()),
    ("triangle_test", |own| (&own.triangle_test).into()),
    ("config", |own| own.config.to_string().into()),
    ("workload", |own| (&own.workload).into()),
    ("query", |own| own.query.name().into()),
    ("workload_hash", |own| (&own.workload_hash).into()),
    ("workload_rays", |own| own.workload_rays.into()),
    ("rays", |own| own.rays.into()),
    ("epochs", |own| own.epochs.into()),
    ("runs", |own| own.samples_ns.len().into()),
    ("build_ns", |own| own.build_ns.into()),
    ("build_peak_bytes", |own| own.build_peak_bytes.into()),
    ("trace_ns", |own| own.trace_ns.into()),
    ("mrays_per_s", |own| own.mrays_per_s.into()),
    ("tests_per_ray", |own| own.counts.tests_per_ray().into()),
    ("steps_per_ray", |own| own.counts.steps_per_ray().into()),
    ("leaf_steps_per_ray", |own| own.counts.per_ray(own.counts.leaves).into()),
    ("empty_leaf_steps_per_ray", |own| own.counts.per_ray(own.counts.empty_leaves).into()),
    ("tests_over_minimum", |own| own.counts.tests_over_minimum().into()),
    ("bytes", |own| own.shape.bytes.into()),
    ("inner_nodes", |own| own.shape.inner_nodes.into()),
    ("leaves", |own| own.shape.leaves.into()),
    ("references", |own| own.shape.references.into()),
    ("references_per_triangle", |own| own.references_per_triangle().into()),
    ("depth", |own| own.shape.depth.into()),
    ("sah_cost", |own| own.shape.sah_cost.into()),
    ("hits", |own| own.counts.hits.into()),
    ("counted_rays", |own| own.counts.rays.into()),
    ("declined", |own| own.declined.as_ref().into()),
    ("checked_rays", |own| own.checked_rays.into()),
    ("structure_errors", |own| own.wrong_hits.into()),
];

/// The rows of `table` must be in the order of `rows`.
pub fn push_columns(table: &mut Table, names: &[&str], rows: &[&Measurement]) {
    for name in names {
        let (_, cell) = COLUMNS.iter().find(|(known, _)| known == name).expect("a measurement has such a column");
        table.push_column(*name, rows.iter().map(|own| cell(own)));
    }
}

/// Whether the structure is an obvhs BVH with the triangle test of obvhs.
pub fn is_native_obvhs(own: &Measurement) -> bool {
    is_obvhs(&own.structure) && !own.label.contains("test=")
}

/// Twins and refused structures have no measurements.
pub fn measurements(dataset: &Dataset) -> Vec<Measurement> {
    dataset.scenes().iter().flat_map(of_scene).collect()
}

pub fn of_scene(scene: &SceneEpochs) -> Vec<Measurement> {
    let first = scene.epochs[0];
    let mut all = vec![];
    for (place, structure) in first.structures.iter().enumerate() {
        if structure.is_twin() || structure.refused.is_some() {
            continue;
        }
        let twin = first.structures.iter().position(|other| other.is_twin() && other.label == structure.label);
        all.extend((0..structure.rays.len()).map(|workload| measurement(scene, place, twin, workload)));
    }
    all
}

fn rays<'a>(scene: &'a SceneEpochs, place: usize, workload: usize) -> impl Iterator<Item = &'a Rays> {
    scene.epochs.iter().filter_map(move |epoch| epoch.structures.get(place)?.rays.get(workload))
}

/// Times of all samples in nanoseconds.
pub fn samples(scene: &SceneEpochs, place: usize, workload: usize) -> Vec<f64> {
    rays(scene, place, workload).flat_map(|rays| &rays.ns).map(|&ns| ns.max(1) as f64).collect()
}

fn measurement(scene: &SceneEpochs, place: usize, twin: Option<usize>, workload: usize) -> Measurement {
    let epoch = scene.epochs[0];
    let structure = &epoch.structures[place];
    let first = &structure.rays[workload];
    let builds = |place: usize| scene.epochs.iter().map(|epoch| epoch.structures[place].build_ns).collect();
    let build_samples_ns: Vec<u64> = builds(place);
    let as_numbers: Vec<f64> = build_samples_ns.iter().map(|&ns| ns as f64).collect();
    let samples_ns = samples(scene, place, workload);
    let trace_ns = median(&samples_ns);
    let timed = trace_ns.is_some();
    // A twin with a different number of rays is ignored.
    let twin = twin.filter(|&twin| timed && rays(scene, twin, workload).all(|own| own.rays == first.rays));
    let twin_samples = twin.map(|twin| samples(scene, twin, workload)).filter(|samples| !samples.is_empty());
    let (checked_rays, wrong_hits) = first.checked.as_ref().map_or((0, 0), |own| (own.rays, own.errors));
    Measurement {
        scene: epoch.scene.clone(),
        scene_hash: epoch.scene_hash.clone(),
        triangles: epoch.triangles,
        degenerate: epoch.degenerate,
        stand_in: epoch.stand_in,
        structure: structure.name.clone(),
        label: structure.label.clone(),
        role: structure.role.clone(),
        config: structure.config.clone(),
        triangle_test: structure.triangle_test.clone(),
        workload: first.workload.clone(),
        query: first.query,
        workload_hash: first.hash.clone(),
        workload_rays: first.all,
        rays: if timed { first.rays } else { 0 },
        sampled: !timed || first.rays < first.all,
        parts: if timed { parts(scene, place, workload) } else { vec![] },
        counts: first.counts.unwrap_or_default(),
        hit_checksum: timed.then_some(first.checksum),
        build_ns: median(&as_numbers).expect("every epoch builds") as u64,
        build_samples_ns,
        build_peak_bytes: structure.build_peak_bytes,
        trace_ns,
        epochs: scene.epochs.len(),
        samples_ns,
        twin_builds_ns: twin_samples.as_ref().and(twin).map(builds),
        twin_samples_ns: twin_samples,
        mrays_per_s: trace_ns.map(|ns| first.rays as f64 * 1e3 / ns),
        shape: structure.shape,
        declined: first.declined.clone(),
        checked_rays,
        wrong_hits,
    }
}

fn parts(scene: &SceneEpochs, place: usize, workload: usize) -> Vec<SubsetSamples> {
    let mut all: Vec<SubsetSamples> = vec![];
    for part in rays(scene, place, workload).flat_map(|rays| &rays.parts) {
        match all.iter_mut().find(|other| other.rays == part.rays) {
            Some(other) => other.ns.extend_from_slice(&part.ns),
            None => all.push(part.clone()),
        }
    }
    all
}

pub fn trace_noise(measurements: &[Measurement]) -> AaNoise {
    AaNoise::new(&measurements.iter().filter_map(Measurement::speed_against_twin).collect::<Vec<_>>())
}

/// Uses one structure with a twin per scene, because build times do not depend on the workload.
pub fn build_noise(measurements: &[Measurement]) -> AaNoise {
    let of = |own: &Measurement| {
        let log = |ns: &u64| libm::log((*ns).max(1) as f64);
        let twin = own.twin_builds_ns.as_ref()?;
        Some(own.build_samples_ns.iter().zip(twin).map(|(own, twin)| vec![log(own) - log(twin)]).collect())
    };
    let scenes = measurements.chunk_by(|a, b| a.scene_hash == b.scene_hash);
    AaNoise::new(&scenes.filter_map(|scene| scene.iter().find_map(of)).collect::<Vec<Vec<Vec<f64>>>>())
}

impl Measurement {
    pub fn scene_title(&self) -> String {
        scene_name(&self.scene, self.stand_in)
    }

    pub fn references_per_triangle(&self) -> f64 {
        self.shape.references as f64 / self.triangles.max(1) as f64
    }

    pub fn is_disqualified(&self) -> bool {
        self.wrong_hits > 0
    }

    fn samples_of(&self, rays: usize) -> Option<Vec<f64>> {
        if rays == self.rays {
            return Some(self.samples_ns.clone());
        }
        let part = self.parts.iter().find(|part| part.rays == rays)?;
        Some(part.ns.iter().map(|&ns| ns.max(1) as f64).collect())
    }

    /// Median nanoseconds per ray, from the samples with `rays` rays. `None` if no samples have `rays` rays.
    pub fn ns_per_ray_of(&self, rays: usize) -> Option<f64> {
        Some(median(&self.samples_of(rays)?)? / rays as f64)
    }

    /// ln(time of `other` / time of `self`), indexed by epoch and round. Both times are for the same rays.
    pub fn speed_against(&self, other: &Self) -> Option<Vec<Vec<f64>>> {
        let alike = self.epochs == other.epochs && self.workload_hash == other.workload_hash;
        let rays = self.rays.min(other.rays);
        if alike { self.ratios(&other.samples_of(rays)?, &self.samples_of(rays)?) } else { None }
    }

    /// ln(time of the twin / time of `self`), indexed by epoch and round.
    pub fn speed_against_twin(&self) -> Option<Vec<Vec<f64>>> {
        self.ratios(self.twin_samples_ns.as_ref()?, &self.samples_ns)
    }

    fn ratios(&self, numerator: &[f64], denominator: &[f64]) -> Option<Vec<Vec<f64>>> {
        let is_whole = !denominator.is_empty() && self.epochs > 0 && denominator.len().is_multiple_of(self.epochs);
        let is_positive = numerator.iter().chain(denominator).all(|&time| time > 0.0);
        let are_pairs = numerator.len() == denominator.len() && is_whole && is_positive;
        are_pairs.then(|| log_ratios(numerator, denominator, self.epochs))
    }

    /// The median of ln(nanoseconds per ray), one value per epoch.
    pub fn log_paces(&self) -> Option<Vec<f64>> {
        let rounds = (self.samples_ns.len() / self.epochs.max(1)).max(1);
        let of_epoch = |ns: &[f64]| median(&ns.iter().map(|&ns| libm::log(ns / self.rays as f64)).collect::<Vec<_>>());
        (!self.samples_ns.is_empty()).then(|| self.samples_ns.chunks(rounds).filter_map(of_epoch).collect())
    }

    /// ln(build time in nanoseconds), one value per epoch.
    pub fn log_builds(&self) -> Vec<f64> {
        self.build_samples_ns.iter().map(|&ns| libm::log(ns.max(1) as f64)).collect()
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::report::words::bare;
    use crate::request::is_obvhs;
    use crate::triangle::{Exact, TriangleTest};

    pub fn example(label: &str, workload: &str, samples_ns: &[f64], epochs: usize) -> Measurement {
        let trace_ns = median(samples_ns);
        Measurement {
            scene: "Cube".into(),
            scene_hash: "00".into(),
            triangles: 12,
            structure: bare(label).into(),
            label: label.into(),
            config: serde_json::json!({"leaf": 8, "threshold": 0.7}),
            triangle_test: if is_obvhs(label) { "native".into() } else { Exact::NAME.into() },
            workload: workload.into(),
            workload_hash: "11".into(),
            workload_rays: 1000,
            rays: 500,
            sampled: true,
            counts: RayCounts { rays: 1000, hits: 20, steps: Some(1500), ..RayCounts::default() },
            hit_checksum: Some(1),
            build_ns: 1500,
            build_samples_ns: vec![1500; epochs],
            build_peak_bytes: Some(8192),
            trace_ns,
            epochs,
            samples_ns: samples_ns.into(),
            mrays_per_s: trace_ns.map(|ns| 500.0 * 1e3 / ns),
            shape: Shape { bytes: 4096, leaves: 7, ..Shape::default() },
            checked_rays: 100,
            ..Measurement::default()
        }
    }

    #[test]
    fn both_times_of_a_ratio_are_of_the_same_rays() {
        let part = |rays, ns: [u64; 2]| SubsetSamples { rays, ns: ns.into() };
        let whole = Measurement { parts: vec![part(100, [10, 20])], ..example("a", "primary", &[100.0, 200.0], 2) };
        let few = Measurement { rays: 100, ..example("b", "primary", &[40.0, 40.0], 2) };
        let logs = whole.speed_against(&few).unwrap();
        assert_eq!(logs, [vec![libm::log(4.0)], vec![libm::log(2.0)]]);
        assert_eq!((whole.ns_per_ray_of(100), whole.ns_per_ray_of(7)), (Some(0.15), None));
        assert_eq!(whole.speed_against(&Measurement { epochs: 1, ..few.clone() }), None);
        assert_eq!(whole.speed_against(&Measurement { workload_hash: "x".into(), ..few }), None);
        assert_eq!(whole.log_paces().unwrap(), [libm::log(0.2), libm::log(0.4)]);
    }
}
