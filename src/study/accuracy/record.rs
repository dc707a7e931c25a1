use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::measure::Provenance;
use crate::validate::Ulps;

/// One structure over one triangle test on the rays of one kind: how wrong, and how fast.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AccuracyRecord {
    pub schema: u32,
    pub scene: String,
    /// SHA-256 of the scene.
    pub scene_hash: String,
    pub triangles: usize,
    /// Whether a mesh stands in for one that is not there.
    pub stand_in: bool,
    pub structure: String,
    /// `structure:key=value,..` with what differs from the defaults.
    pub label: String,
    pub config: Value,
    pub triangle_test: String,
    /// Kind of the rays.
    pub rays: String,
    pub seed: u64,
    /// Rays judged; fewer than were made where the structure is slow.
    pub judged: u64,
    /// Whether these are a part of the rays.
    pub sampled: bool,
    /// Those that truly hit something.
    pub hits: u64,
    pub missed: u64,
    pub false_hits: u64,
    /// `t` off by more than 4 units in the last place and more than 1e-6.
    pub wrong_depth: u64,
    /// Hits at a primitive that is not among the nearest; not part of the error.
    pub wrong_primitive: u64,
    /// Share of the rays with a wrong answer: missed, false hit or wrong depth.
    pub error: f64,
    /// What the true share is below, with 95 % confidence.
    pub error_bound: f64,
    /// Of the true hits, with its bound; nothing where there is none.
    pub miss_rate: Option<[f64; 2]>,
    /// Of the rays that truly hit nothing, with its bound.
    pub false_hit_rate: Option<[f64; 2]>,
    /// Of the true hits, with its bound.
    pub wrong_depth_rate: Option<[f64; 2]>,
    /// Error of `t` where the primitive is right; infinite numbers are null.
    pub ulps: Option<Ulps>,
    /// Median of the samples, nanoseconds.
    pub ns_per_ray: f64,
    /// The longest that a single one of the timed rays takes when it is asked alone, nanoseconds; nothing in records of older versions.
    #[serde(default)]
    pub slowest_ns: Option<u64>,
    /// Rays of a sample.
    pub timed: usize,
    /// Samples.
    pub runs: usize,
    /// The label of a structure on the front that is at most as slow and at most as wrong; nothing for the front
    /// itself.
    pub dominated_by: Option<String>,
    /// Of the run, in an answer; a journal tells it of whole cases.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub provenance: Option<Provenance>,
}

impl AccuracyRecord {
    pub const SCHEMA: u32 = 1;

    /// Whether the other one is of the same scene and kind of rays.
    pub fn is_beside(&self, other: &Self) -> bool {
        self.rays == other.rays && self.scene == other.scene
    }

    /// Misses, false hits and wrong depths.
    pub fn errors(&self) -> u64 {
        self.missed + self.false_hits + self.wrong_depth
    }
}
