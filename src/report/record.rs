//! One record per case.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::accel::{Query, TreeShape};
use crate::measure::{Part, Provenance, log_ratios, median};

/// What is known of one case; the fields are described in the [module](super).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct Record {
    pub schema: u32,
    pub scene: String,
    pub scene_hash: String,
    pub triangles: usize,
    pub degenerate: usize,
    pub stand_in: bool,
    pub structure: String,
    pub label: String,
    pub config: Value,
    pub triangle_test: String,
    pub workload: String,
    pub query: Query,
    pub workload_hash: String,
    pub workload_rays: usize,
    pub rays: usize,
    pub sampled: bool,
    #[serde(default)]
    pub parts: Vec<Part>,
    pub counted_rays: usize,
    pub hits: usize,
    pub answers: Option<String>,
    pub build_ns: u64,
    #[serde(default)]
    pub build_samples_ns: Vec<u64>,
    pub build_peak_bytes: Option<usize>,
    pub trace_ns: Option<f64>,
    pub runs: usize,
    #[serde(default = "one")]
    pub epochs: usize,
    pub samples_ns: Vec<f64>,
    pub twin_samples_ns: Option<Vec<f64>>,
    pub noise_floor: Option<f64>,
    pub mrays_per_s: Option<f64>,
    pub tests_per_ray: Option<f64>,
    pub steps_per_ray: Option<f64>,
    pub instructions_per_ray: Option<f64>,
    #[serde(default)]
    pub branch_misses_per_ray: Option<f64>,
    pub bytes: usize,
    pub declined: Option<String>,
    pub checked_rays: usize,
    pub structure_errors: usize,
    pub provenance: Provenance,
    pub counts: CaseCounts,
}

/// Before there were epochs, structures were built once.
fn one() -> usize {
    1
}

impl Record {
    /// Version of the schema.
    pub const SCHEMA: u32 = 2;

    /// Whether wrong answers cost the case its time.
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

    /// Nanoseconds a ray, the median of the samples, over so many rays: all of it or a part. Nothing where these were not timed.
    pub fn ns_per_ray_of(&self, rays: usize) -> Option<f64> {
        Some(median(&self.samples_of(rays)?)? / rays as f64)
    }

    /// How many times faster this case is than `other`, as logarithms, round by round in each epoch, both on the same
    /// rays: those of the one that was timed on fewer. Nothing where one has no time, or they were not measured in the
    /// same rounds.
    pub fn speed_against(&self, other: &Self) -> Option<Vec<Vec<f64>>> {
        let alike = self.epochs == other.epochs && self.workload_hash == other.workload_hash;
        let rays = self.rays.min(other.rays);
        if alike { self.ratios(&other.samples_of(rays)?, &self.samples_of(rays)?) } else { None }
    }

    /// How many times faster this case is than its twin, likewise. Nothing where it has none.
    pub fn speed_against_twin(&self) -> Option<Vec<Vec<f64>>> {
        self.ratios(self.twin_samples_ns.as_ref()?, &self.samples_ns)
    }

    /// Logarithms of `slow` / `fast`, if they can be samples of the same rounds of this case's epochs.
    fn ratios(&self, slow: &[f64], fast: &[f64]) -> Option<Vec<Vec<f64>>> {
        let whole = !fast.is_empty() && self.epochs > 0 && fast.len().is_multiple_of(self.epochs);
        let positive = || slow.iter().chain(fast).all(|&time| time > 0.0);
        (slow.len() == fast.len() && whole && positive()).then(|| log_ratios(slow, fast, self.epochs))
    }
}

/// What no machine changes of one case, besides what stands in the record itself; the fields are described in the
/// [module](super).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct CaseCounts {
    pub inner_nodes: usize,
    pub leaves: usize,
    pub empty_leaves: usize,
    pub references: usize,
    pub largest_leaf: usize,
    pub depth: usize,
    pub sah_cost: Option<f64>,
    pub leaf_steps_per_ray: Option<f64>,
    pub empty_leaf_steps_per_ray: Option<f64>,
    pub tests_over_minimum: Option<f64>,
}

impl CaseCounts {
    /// Those of a structure; nothing is known of rays.
    pub fn of(shape: &TreeShape) -> Self {
        Self {
            inner_nodes: shape.inner,
            leaves: shape.leaves,
            empty_leaves: shape.empty,
            references: shape.references,
            largest_leaf: shape.largest_leaf,
            depth: shape.depth,
            sah_cost: shape.sah_cost,
            ..Self::default()
        }
    }
}

#[cfg(test)]
pub(crate) fn example() -> Record {
    Record {
        schema: Record::SCHEMA,
        scene: "Cube".into(),
        scene_hash: "00".into(),
        triangles: 12,
        degenerate: 0,
        stand_in: false,
        structure: "median-kd".into(),
        label: "median-kd:leaf=8".into(),
        config: serde_json::json!({ "leaf": 8, "threshold": 0.7 }),
        triangle_test: "moller-trumbore".into(),
        workload: "primary".into(),
        query: Query::Closest,
        workload_hash: "11".into(),
        workload_rays: 1000,
        rays: 500,
        sampled: true,
        parts: vec![Part { rays: 125, ns: vec![500_000, 400_000, 750_000] }],
        counted_rays: 1000,
        hits: 20,
        answers: Some("0123456789abcdef".into()),
        build_ns: 1500,
        build_samples_ns: vec![1500],
        build_peak_bytes: Some(8192),
        trace_ns: Some(2e6),
        runs: 3,
        epochs: 1,
        samples_ns: vec![2e6, 1.5e6, 3e6],
        twin_samples_ns: None,
        noise_floor: Some(0.01),
        mrays_per_s: Some(0.25),
        tests_per_ray: None,
        steps_per_ray: Some(1.5),
        instructions_per_ray: None,
        branch_misses_per_ray: None,
        bytes: 4096,
        declined: None,
        checked_rays: 100,
        structure_errors: 0,
        provenance: Provenance::capture(1),
        counts: CaseCounts { leaves: 7, tests_over_minimum: Some(2.5), ..CaseCounts::default() },
    }
}

/// The structure `label` on rays of this kind, as if its samples had been taken in so many epochs.
#[cfg(test)]
pub(crate) fn timed_example(label: &str, workload: &str, samples_ns: &[f64], epochs: usize) -> Record {
    Record {
        structure: super::words::bare(label).into(),
        label: label.into(),
        workload: workload.into(),
        epochs,
        runs: samples_ns.len(),
        trace_ns: median(samples_ns),
        samples_ns: samples_ns.into(),
        ..example()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::journal::{self, Header};

    /// Names in the first column of the tables of the document, up to a line that starts with `end`.
    fn documented(text: &str) -> Vec<&str> {
        text.lines().filter_map(|line| line.strip_prefix("| `")?.split_once('`').map(|(name, _)| name)).collect()
    }

    fn serialised(value: &Value) -> Vec<&str> {
        value.as_object().unwrap().keys().map(String::as_str).collect()
    }

    #[test]
    fn the_documented_fields_are_the_serialised_ones() {
        let record = serde_json::to_value(example()).unwrap();
        let (record_part, rest) =
            include_str!("SCHEMA.md").split_once("`provenance`:").expect("the document has all tables");
        let (provenance_part, rest) = rest.split_once("`counts`:").expect("the document has all tables");
        let (counts_part, case_part) = rest.split_once("# Cases").expect("the document has all tables");
        assert_eq!(documented(record_part), serialised(&record));
        assert_eq!(documented(provenance_part), serialised(&record["provenance"]));
        assert_eq!(documented(counts_part), serialised(&record["counts"]));
        let header = Header::new("a study", &serde_json::json!({"seed": 1}), example().provenance);
        let case: Value = serde_json::from_str(&journal::text(&header, "Cube epoch 0", &7, |_| Ok(7))).unwrap();
        assert_eq!(documented(case_part), serialised(&case));
        for (part, schema) in [(record_part, Record::SCHEMA), (case_part, journal::SCHEMA)] {
            assert!(part.contains(&format!("version of this list, {schema}")), "{schema}");
        }
        // What is counted is of `counted_rays`.
        assert!(!record_part.contains("mean over `rays`") && !counts_part.contains("mean over `rays`"));
    }
}
