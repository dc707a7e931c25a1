//! All epochs of one structure on one workload of one scene: what tables, curves and comparisons of runs are made of.

use serde_json::Value;

use super::dataset::{Dataset, SceneEpochs};
use super::epoch::{Rays, Shape};
use crate::accel::Query;
use crate::measure::{AaNoise, SubsetSamples, log_ratios, median};
use crate::report::words::scene_name;
use crate::report::{Cell, Table};
use crate::request::is_obvhs;

/// One structure on one workload of one scene. What is not known is nothing, never 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurement {
    pub scene: String,
    pub scene_hash: String,
    pub triangles: usize,
    /// Those of them without area.
    pub degenerate: usize,
    /// Whether a mesh of our own stands in for a real one.
    pub stand_in: bool,
    /// Name in the registry.
    pub structure: String,
    /// The name with the keys that differ from their defaults.
    pub label: String,
    /// What the structure stands for in the study.
    pub role: String,
    pub config: Value,
    pub triangle_test: String,
    pub workload: String,
    pub query: Query,
    pub workload_hash: String,
    /// Rays of the whole workload.
    pub workload_rays: usize,
    /// Rays of one timed sample; 0 without a time.
    pub rays: usize,
    /// Whether that is a part of the workload.
    pub sampled: bool,
    /// The same samples for a part of their rays, as many as a slower structure is timed on.
    pub parts: Vec<SubsetSamples>,
    /// Rays that hits, tests, steps, instructions and branch misses are of.
    pub counted_rays: usize,
    pub hits: usize,
    /// Hash of the answers to the timed rays.
    pub answers: Option<u64>,
    /// Nanoseconds of the build, median over the epochs.
    pub build_ns: u64,
    /// Every build, one an epoch.
    pub build_samples_ns: Vec<u64>,
    pub build_peak_bytes: Option<usize>,
    /// Median nanoseconds of a sample; nothing without a time.
    pub trace_ns: Option<f64>,
    /// How often everything was built anew; each epoch has as many samples as another, one after the other.
    pub epochs: usize,
    pub samples_ns: Vec<f64>,
    /// The samples and builds of the twin, where the structure has one that was timed on as many rays.
    pub twin_samples_ns: Option<Vec<f64>>,
    pub twin_builds_ns: Option<Vec<u64>>,
    pub mrays_per_s: Option<f64>,
    pub tests_per_ray: Option<f64>,
    pub steps_per_ray: Option<f64>,
    pub leaf_steps_per_ray: Option<f64>,
    pub empty_leaf_steps_per_ray: Option<f64>,
    pub tests_over_minimum: Option<f64>,
    pub instructions_per_ray: Option<f64>,
    pub branch_misses_per_ray: Option<f64>,
    pub shape: Shape,
    /// What of these rays the structure declines.
    pub declined: Option<String>,
    /// Rays held against brute force over the same triangle test, and those of them with a wrong answer.
    pub checked_rays: usize,
    pub structure_errors: usize,
}

/// The name of a column, and what it says of a measurement.
pub type MeasurementColumn = (&'static str, fn(&Measurement) -> Cell);

/// Columns of tables for programs.
pub const COLUMNS: [MeasurementColumn; 38] = [
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
    ("tests_per_ray", |own| own.tests_per_ray.into()),
    ("steps_per_ray", |own| own.steps_per_ray.into()),
    ("leaf_steps_per_ray", |own| own.leaf_steps_per_ray.into()),
    ("empty_leaf_steps_per_ray", |own| own.empty_leaf_steps_per_ray.into()),
    ("tests_over_minimum", |own| own.tests_over_minimum.into()),
    ("instructions_per_ray", |own| own.instructions_per_ray.into()),
    ("branch_misses_per_ray", |own| own.branch_misses_per_ray.into()),
    ("bytes", |own| own.shape.bytes.into()),
    ("inner_nodes", |own| own.shape.inner_nodes.into()),
    ("leaves", |own| own.shape.leaves.into()),
    ("references", |own| own.shape.references.into()),
    ("references_per_triangle", |own| own.references_per_triangle().into()),
    ("depth", |own| own.shape.depth.into()),
    ("sah_cost", |own| own.shape.sah_cost.into()),
    ("hits", |own| own.hits.into()),
    ("counted_rays", |own| own.counted_rays.into()),
    ("declined", |own| own.declined.as_ref().into()),
    ("checked_rays", |own| own.checked_rays.into()),
    ("structure_errors", |own| own.structure_errors.into()),
];

/// Adds the columns of these names to a table with a row for each of the measurements.
pub fn push_columns(table: &mut Table, names: &[&str], rows: &[&Measurement]) {
    for name in names {
        let (_, cell) = COLUMNS.iter().find(|(known, _)| known == name).expect("a measurement has such a column");
        table.push_column(*name, rows.iter().map(|own| cell(own)));
    }
}

/// Whether it is of one of the BVHs from outside over their own triangle test, with nothing of ours in it.
pub fn is_reference(own: &Measurement) -> bool {
    is_obvhs(&own.structure) && !own.label.contains("test=")
}

/// Those of all scenes, structure by structure and workload by workload. Twins are part of the structure that they are
/// the twin of.
pub fn measurements(dataset: &Dataset) -> Vec<Measurement> {
    dataset.scenes().iter().flat_map(of_scene).collect()
}

/// Those of one scene.
pub fn of_scene(scene: &SceneEpochs) -> Vec<Measurement> {
    let first = scene.epochs[0];
    let mut all = vec![];
    for (place, structure) in first.structures.iter().enumerate() {
        if structure.is_twin() || structure.refused.is_some() {
            continue;
        }
        let twin = first.structures.iter().position(|other| other.is_twin() && other.label == structure.label);
        all.extend((0..structure.rays.len()).map(|kind| measurement(scene, place, twin, kind)));
    }
    all
}

fn rays<'a>(scene: &'a SceneEpochs, place: usize, kind: usize) -> impl Iterator<Item = &'a Rays> {
    scene.epochs.iter().filter_map(move |epoch| epoch.structures.get(place)?.rays.get(kind))
}

/// Every sample of a structure on a workload, nanoseconds.
pub fn samples(scene: &SceneEpochs, place: usize, kind: usize) -> Vec<f64> {
    rays(scene, place, kind).flat_map(|rays| &rays.ns).map(|&ns| ns.max(1) as f64).collect()
}

fn measurement(scene: &SceneEpochs, place: usize, twin: Option<usize>, kind: usize) -> Measurement {
    let epoch = scene.epochs[0];
    let structure = &epoch.structures[place];
    let first = &structure.rays[kind];
    let builds =
        |place: usize| -> Vec<u64> { scene.epochs.iter().map(|epoch| epoch.structures[place].build_ns).collect() };
    let build_samples_ns = builds(place);
    let as_numbers: Vec<f64> = build_samples_ns.iter().map(|&ns| ns as f64).collect();
    let samples_ns = samples(scene, place, kind);
    let trace_ns = median(&samples_ns);
    let timed = trace_ns.is_some();
    // Of a program each may have been timed on as many rays as its clock allowed.
    let twin = twin.filter(|&twin| timed && rays(scene, twin, kind).all(|own| own.rays == first.rays));
    let twin_samples = twin.map(|twin| samples(scene, twin, kind)).filter(|samples| !samples.is_empty());
    let counts = first.counts.unwrap_or_default();
    let per_ray = |n: Option<u64>| Some(n? as f64 / counts.rays.max(1) as f64);
    let (checked_rays, structure_errors) = first.checked.as_ref().map_or((0, 0), |own| (own.rays, own.errors));
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
        parts: if timed { parts(scene, place, kind) } else { vec![] },
        counted_rays: counts.rays,
        hits: counts.hits,
        answers: timed.then_some(first.checksum),
        build_ns: median(&as_numbers).expect("every epoch builds") as u64,
        build_samples_ns,
        build_peak_bytes: structure.build_peak_bytes,
        trace_ns,
        epochs: scene.epochs.len(),
        samples_ns,
        twin_builds_ns: twin_samples.as_ref().and(twin).map(builds),
        twin_samples_ns: twin_samples,
        mrays_per_s: trace_ns.map(|ns| first.rays as f64 * 1e3 / ns),
        tests_per_ray: counts.tests_per_ray(),
        steps_per_ray: counts.steps_per_ray(),
        leaf_steps_per_ray: per_ray(counts.leaves),
        empty_leaf_steps_per_ray: per_ray(counts.empty_leaves),
        tests_over_minimum: counts.tests_over_minimum(),
        instructions_per_ray: counts.instructions_per_ray,
        branch_misses_per_ray: counts.branch_misses_per_ray,
        shape: structure.shape,
        declined: first.declined.clone(),
        checked_rays,
        structure_errors,
    }
}

fn parts(scene: &SceneEpochs, place: usize, kind: usize) -> Vec<SubsetSamples> {
    let mut all: Vec<SubsetSamples> = vec![];
    for part in rays(scene, place, kind).flat_map(|rays| &rays.parts) {
        match all.iter_mut().find(|other| other.rays == part.rays) {
            Some(other) => other.ns.extend_from_slice(&part.ns),
            None => all.push(part.clone()),
        }
    }
    all
}

/// The A/A noise of times: how the twins' samples relate to those of the structures that they are the twins of.
pub fn trace_noise(measurements: &[Measurement]) -> AaNoise {
    AaNoise::new(&measurements.iter().filter_map(Measurement::speed_against_twin).collect::<Vec<_>>())
}

/// Likewise of builds, a cell for each scene.
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
    /// The scene as tables name it.
    pub fn scene_title(&self) -> String {
        scene_name(&self.scene, self.stand_in)
    }

    pub fn references_per_triangle(&self) -> f64 {
        self.shape.references as f64 / self.triangles.max(1) as f64
    }

    /// Whether wrong answers cost it its time.
    pub fn is_disqualified(&self) -> bool {
        self.structure_errors > 0
    }

    /// Nanoseconds of every sample for `rays` rays, which are all of it or a part. Nothing where these were not timed.
    fn samples_of(&self, rays: usize) -> Option<Vec<f64>> {
        if rays == self.rays {
            return Some(self.samples_ns.clone());
        }
        let part = self.parts.iter().find(|part| part.rays == rays)?;
        Some(part.ns.iter().map(|&ns| ns.max(1) as f64).collect())
    }

    /// Nanoseconds a ray, the median of the samples, over so many rays: all of it or a part. Nothing where these were not
    /// timed.
    pub fn ns_per_ray_of(&self, rays: usize) -> Option<f64> {
        Some(median(&self.samples_of(rays)?)? / rays as f64)
    }

    /// How many times faster this is than `other`, as logarithms, round by round in each epoch, both on the same rays:
    /// those of the one that was timed on fewer. Nothing where one has no time, or they were not measured in the same
    /// rounds.
    pub fn speed_against(&self, other: &Self) -> Option<Vec<Vec<f64>>> {
        let alike = self.epochs == other.epochs && self.workload_hash == other.workload_hash;
        let rays = self.rays.min(other.rays);
        if alike { self.ratios(&other.samples_of(rays)?, &self.samples_of(rays)?) } else { None }
    }

    /// How many times faster this is than its twin, likewise. Nothing where it has none.
    pub fn speed_against_twin(&self) -> Option<Vec<Vec<f64>>> {
        self.ratios(self.twin_samples_ns.as_ref()?, &self.samples_ns)
    }

    /// Logarithms of `slow` / `fast`, if they can be samples of the same rounds of these epochs.
    fn ratios(&self, slow: &[f64], fast: &[f64]) -> Option<Vec<Vec<f64>>> {
        let whole = !fast.is_empty() && self.epochs > 0 && fast.len().is_multiple_of(self.epochs);
        let positive = || slow.iter().chain(fast).all(|&time| time > 0.0);
        (slow.len() == fast.len() && whole && positive()).then(|| log_ratios(slow, fast, self.epochs))
    }

    /// ln nanoseconds of a ray, epoch by epoch: the median of its rounds. Nothing without a time.
    pub fn log_paces(&self) -> Option<Vec<f64>> {
        let rounds = (self.samples_ns.len() / self.epochs.max(1)).max(1);
        let of_epoch = |ns: &[f64]| median(&ns.iter().map(|&ns| libm::log(ns / self.rays as f64)).collect::<Vec<_>>());
        (!self.samples_ns.is_empty()).then(|| self.samples_ns.chunks(rounds).filter_map(of_epoch).collect())
    }

    /// ln nanoseconds of the build, epoch by epoch.
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

    /// The structure `label` on a workload, as if its samples of 500 rays had been taken in so many epochs.
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
            counted_rays: 1000,
            hits: 20,
            answers: Some(1),
            build_ns: 1500,
            build_samples_ns: vec![1500; epochs],
            build_peak_bytes: Some(8192),
            trace_ns,
            epochs,
            samples_ns: samples_ns.into(),
            mrays_per_s: trace_ns.map(|ns| 500.0 * 1e3 / ns),
            steps_per_ray: Some(1.5),
            tests_over_minimum: Some(2.5),
            shape: Shape { bytes: 4096, leaves: 7, ..Shape::default() },
            checked_rays: 100,
            ..Measurement::default()
        }
    }

    #[test]
    fn both_sides_of_a_ratio_are_of_the_same_rays() {
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
