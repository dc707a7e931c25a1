//! The measured data of one epoch of one scene.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::measure::Environment;
use super::{StudyError, Verdict};
use crate::accel::{DynAccel, Query, TreeShape};
use crate::measure::SubsetSamples;
use crate::registry::RUNNER;
use crate::report::Failure;
use crate::report::words::{each_once, scene_name};
use crate::request::{TWIN, known_defect};
use crate::triangle::{Exact, TriangleTest};
use crate::validate::{ErrorCounts, Kind, Validation};

/// In an epoch, all structures are rebuilt and measured in rounds. A round measures every structure on every workload
/// once. The workloads are in random order, and the structures of a workload are in random order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Epoch {
    pub scene: String,
    pub scene_hash: String,
    /// Whether a generated mesh replaces a real mesh.
    pub stand_in: bool,
    pub triangles: usize,
    /// Triangles without area.
    pub degenerate: usize,
    /// Counted from 0.
    pub epoch: usize,
    pub environment: Environment,
    /// In the order of `Case::structures`.
    pub structures: Vec<Structure>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Structure {
    /// `NAME` or `NAME:key=value,..`, without default values.
    pub label: String,
    /// The role in the study, for example [`TWIN`], or empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub role: String,
    /// Name in the registry.
    pub name: String,
    pub config: Value,
    pub triangle_test: String,
    /// The reason why the structure has no times, as a clause. If `Some`, `rays` is empty.
    pub refused: Option<String>,
    /// Whether the structure is refused because of wrong hits.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub wrong: bool,
    /// The median of up to three builds. For a runner, the build time that it reports.
    pub build_ns: u64,
    /// Peak memory during the build minus memory in use before the build. `None` if unknown, and after epoch 0.
    pub build_peak_bytes: Option<usize>,
    /// Elapsed time / reported time of a runner, as the median over the queries. `None` if all queries were too short,
    /// and for other structures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<f64>,
    pub shape: Shape,
    pub rays: Vec<Rays>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// Memory without the mesh.
    pub bytes: usize,
    pub inner_nodes: usize,
    /// Includes empty leaves.
    pub leaves: usize,
    pub empty_leaves: usize,
    pub references: usize,
    pub largest_leaf: usize,
    /// Edges from the root to the deepest leaf.
    pub depth: usize,
    pub sah_cost: Option<f64>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rays {
    pub workload: String,
    pub hash: String,
    pub query: Query,
    /// The number of rays of the workload.
    pub all: usize,
    /// The number of rays in a sample, at most `all`.
    pub rays: usize,
    /// Checksum of hits. The checksum covers only rays that all epochs trace.
    pub checksum: u64,
    /// The time of each sample. Entry `i` of every structure was measured in round `i`.
    pub ns: Vec<u64>,
    /// Times on subsets of the rays, for the comparison with slower structures.
    pub parts: Vec<SubsetSamples>,
    /// The reason why there is no time, as a clause.
    pub untimed: Option<String>,
    /// Whether the time is missing because of wrong hits.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub wrong: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub declined: Option<String>,
    /// Only in epoch 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checked: Option<Checked>,
    /// Only in epoch 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counts: Option<RayCounts>,
    /// Only in epoch 0 and with [`Check::Oracle`](super::Check::Oracle).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub errors: Option<ErrorCounts>,
    /// The longest time of a single ray. Only in epoch 0 and with [`Check::Oracle`](super::Check::Oracle).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slowest_ns: Option<u64>,
}

/// The result of the latest check of the hits.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Checked {
    pub rays: usize,
    /// Rays with a result that rounding cannot explain.
    pub errors: usize,
    /// Rays with a result that differs only by rounding of the triangle test.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rounded: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<Kind>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub example: Option<(String, String)>,
}

fn is_zero(n: &usize) -> bool {
    *n == 0
}

impl From<&Validation> for Checked {
    fn from(found: &Validation) -> Self {
        let Verdict { rays, wrong, rounded, fault } = found.into();
        let [rays, errors, rounded] = [rays, wrong, rounded].map(|n| n as usize);
        let example = found.worst_error().map(|worst| (worst.ray.to_string(), worst.to_string()));
        Self { rays, errors, rounded, fault, example }
    }
}

impl Checked {
    pub fn verdict(&self) -> Verdict {
        let [rays, wrong, rounded] = [self.rays, self.errors, self.rounded].map(|n| n as u64);
        Verdict { rays, wrong, rounded, fault: self.fault }
    }
}

/// Counts over evenly spread rays of a workload. The counts are equal on all machines. `None` marks a count that the
/// structure does not provide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RayCounts {
    pub rays: usize,
    pub hits: usize,
    /// For closest-hit queries, the checksum of the bits of all `t`. For any-hit queries, the checksum of hits and
    /// misses.
    pub distances: u64,
    pub tests: Option<u64>,
    /// A block is a group of triangles that are tested at once.
    pub blocks: Option<u64>,
    /// Inner nodes and leaves entered.
    pub steps: Option<u64>,
    pub leaves: Option<u64>,
    pub empty_leaves: Option<u64>,
    /// Counted only if `Settings::whole_counts` names the structure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub whole_tests: Option<u64>,
}

impl From<&dyn DynAccel> for Shape {
    fn from(accel: &dyn DynAccel) -> Self {
        let bytes = accel.footprint().total();
        let TreeShape { inner, leaves, empty, references, largest_leaf, depth, sah_cost } = accel.shape();
        Self { bytes, inner_nodes: inner, leaves, empty_leaves: empty, references, largest_leaf, depth, sah_cost }
    }
}

impl Structure {
    /// Changed or differing hits of such a structure exclude only the structure, not the scene. With `Settings::whole`,
    /// they exclude the scene.
    pub fn may_err(&self) -> bool {
        self.name == RUNNER || known_defect(&self.name).is_some()
    }

    /// A twin is a second build of a structure in the same epoch.
    pub fn is_twin(&self) -> bool {
        self.role == TWIN
    }
}

impl Rays {
    pub fn drop_times(&mut self, reason: String) {
        *self = Self { untimed: Some(reason), ns: vec![], parts: vec![], rays: 0, checksum: 0, ..self.clone() };
    }

    /// One value per sample. Empty if no subset of `rays` rays was timed.
    pub fn ns_per_ray(&self, rays: usize) -> Vec<f64> {
        let part = self.parts.iter().find(|part| part.rays == rays).map(|part| &part.ns);
        let ns = if rays == self.rays { Some(&self.ns) } else { part };
        ns.into_iter().flatten().map(|&ns| ns.max(1) as f64 / rays as f64).collect()
    }
}

impl RayCounts {
    pub fn per_ray(&self, n: Option<u64>) -> Option<f64> {
        Some(n? as f64 / self.rays.max(1) as f64)
    }

    pub fn tests_per_ray(&self) -> Option<f64> {
        self.per_ray(self.tests)
    }

    pub fn steps_per_ray(&self) -> Option<f64> {
        self.per_ray(self.steps)
    }

    /// The number of triangle tests divided by the minimum. The minimum is one test per ray that hits a triangle
    /// (Havran, Purgathofer 2003).
    pub fn tests_over_minimum(&self) -> Option<f64> {
        (self.hits > 0).then_some(self.tests? as f64 / self.hits as f64)
    }
}

impl Epoch {
    pub fn title(&self) -> String {
        scene_name(&self.scene, self.stand_in)
    }

    /// The number of rays in the smallest sample on the workload. 0 if no structure was timed.
    pub fn common_rays(&self, workload: &str) -> usize {
        let rays = self.structures.iter().filter(|structure| structure.refused.is_none()).flat_map(|s| &s.rays);
        let timed = rays.filter(|rays| rays.workload == workload && !rays.ns.is_empty());
        timed.map(|rays| rays.rays).min().unwrap_or(0)
    }

    pub fn has_no_rays(&self) -> bool {
        let is_idle = |structure: &Structure| structure.refused.is_none() && structure.rays.is_empty();
        self.structures.iter().all(is_idle)
    }

    pub fn failures(&self) -> Vec<Failure> {
        let scene = self.title();
        let mut failures: Vec<Failure> = vec![];
        for Structure { label, name, refused, wrong, rays, .. } in &self.structures {
            if let Some(why) = refused {
                let sentence = format!("{label} on {scene} has no result: {why}.");
                failures.push(Failure { structure: name.clone(), sentence, refused: true, wrong: *wrong });
            }
            for Rays { workload, untimed, wrong, .. } in rays {
                let Some(why) = untimed else { continue };
                let sentence = format!("{label} is not timed on the {workload} rays of {scene}: {why}.");
                failures.push(Failure { structure: name.clone(), sentence, refused: false, wrong: *wrong });
            }
        }
        each_once(failures)
    }

    /// Returns an error if a time is missing or the structures differ in a `t`. All structures must have the same
    /// triangle test.
    pub fn check_complete(&self) -> Result<(), StudyError> {
        if let Some(failure) = self.failures().into_iter().next() {
            return Err(StudyError::Missing { failure: failure.sentence, wrong: failure.wrong });
        }
        if self.structures.iter().any(|structure| structure.rays.is_empty()) {
            return Err(StudyError::NoRays { scene: self.title() });
        }
        self.agree(|_| Some(""))
    }

    /// Returns an error if structures with the exact triangle test differ in a `t`. Other tests are not compared.
    /// Rounding may place a hit outside the box of its triangle. Then one tree finds the hit and another tree culls it.
    pub fn check_agreement(&self) -> Result<(), StudyError> {
        self.agree(|structure| {
            Some(structure.triangle_test.as_str()).filter(|test| *test == Exact::NAME && !structure.may_err())
        })
    }

    /// Compares structures for which `group` returns equal values. Structures are skipped if `group` returns `None`.
    fn agree<'a>(&'a self, group: impl Fn(&'a Structure) -> Option<&'a str>) -> Result<(), StudyError> {
        let mut seen = BTreeMap::new();
        let all = self.structures.iter().filter(|structure| structure.refused.is_none());
        for (structure, own) in all.filter_map(|structure| Some((structure, group(structure)?))) {
            for rays in structure.rays.iter().filter(|rays| rays.untimed.is_none()) {
                let Some(counts) = rays.counts else { continue };
                // Only checksums over the same number of rays are comparable.
                let known = seen.entry((own, &rays.workload, counts.rays)).or_insert((structure, counts.distances));
                if known.1 != counts.distances {
                    let (one, other) = (known.0.label.clone(), structure.label.clone());
                    let (scene, rays) = (self.title(), rays.workload.clone());
                    return Err(StudyError::Disagree { one, other, scene, rays });
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub fn rays(workload: &str) -> Rays {
        Rays {
            workload: workload.into(),
            hash: "11".into(),
            all: 1000,
            rays: 1000,
            checksum: 1,
            checked: Some(Checked { rays: 100, ..Checked::default() }),
            counts: Some(RayCounts {
                rays: 1000,
                hits: 500,
                distances: 9,
                tests: Some(4000),
                blocks: Some(1000),
                steps: Some(10_000),
                ..RayCounts::default()
            }),
            ..Rays::default()
        }
    }

    /// An element of `structures` is (label, build time in ns, sample times in ns). A structure with a repeated label
    /// is a twin.
    pub fn example(scene: &str, triangles: usize, epoch: usize, structures: &[(&str, u64, &[u64])]) -> Epoch {
        let structure = |(place, &(label, build_ns, ns)): (usize, &(&str, u64, &[u64]))| Structure {
            label: label.into(),
            role: structures[..place].iter().find(|own| own.0 == label).map_or(String::new(), |_| TWIN.into()),
            name: label.split(':').next().unwrap().into(),
            config: Value::Object(Default::default()),
            triangle_test: if label.starts_with("obvhs") { "native".into() } else { Exact::NAME.into() },
            build_ns,
            shape: Shape { bytes: 100 * triangles, leaves: 8, references: 2 * triangles, depth: 3, ..Shape::default() },
            rays: vec![Rays { ns: ns.to_vec(), ..rays("primary") }],
            ..Structure::default()
        };
        Epoch {
            scene: scene.into(),
            scene_hash: scene.into(),
            stand_in: false,
            triangles,
            degenerate: 0,
            epoch,
            environment: Environment::default(),
            structures: structures.iter().enumerate().map(structure).collect(),
        }
    }
}
