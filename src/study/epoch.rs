//! One epoch of one scene, as it was measured: plain data.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::measure::Environment;
use super::{StudyError, Verdict};
use crate::accel::{Query, TreeShape};
use crate::measure::SubsetSamples;
use crate::registry::RUNNER;
use crate::report::Failure;
use crate::report::words::{each_once, scene_name};
use crate::request::{TWIN, known_defect};
use crate::triangle::{Exact, TriangleTest};
use crate::validate::{ErrorCounts, Kind, Validation};

/// One epoch of one scene: all structures are built anew and timed on all workloads in rounds, each round every pair
/// once, in random order, one workload after the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Epoch {
    pub scene: String,
    /// [`Scene::hash`](crate::scene::Scene::hash).
    pub scene_hash: String,
    /// Whether a mesh of our own stands in for a real one.
    pub stand_in: bool,
    pub triangles: usize,
    /// Those of them without area.
    pub degenerate: usize,
    /// Counted from 0.
    pub epoch: usize,
    pub environment: Environment,
    /// In the order of the case.
    pub structures: Vec<Structure>,
}

/// One structure in one epoch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Structure {
    /// As chosen.
    pub label: String,
    /// What it stands for in the study.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub role: String,
    /// Name in the registry.
    pub name: String,
    /// The whole configuration.
    pub config: Value,
    pub triangle_test: String,
    /// Why it has no times at all: a sentence. What follows is then empty.
    pub refused: Option<String>,
    /// Whether that is for wrong answers.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub wrong: bool,
    /// Nanoseconds of the build, seen from outside unless it times itself.
    pub build_ns: u64,
    /// Most bytes held during a build beyond those held before, counted in epoch 0; nothing where they are not counted.
    pub build_peak_bytes: Option<usize>,
    /// How long its passes took as seen from outside, as a multiple of what it says itself, where it times itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<f64>,
    pub shape: Shape,
    pub rays: Vec<Rays>,
}

/// What a structure is once it is built, the same in every epoch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// Memory of the finished structure, without the mesh.
    pub bytes: usize,
    pub inner_nodes: usize,
    /// Leaves, empty ones included.
    pub leaves: usize,
    pub empty_leaves: usize,
    /// References in leaves.
    pub references: usize,
    pub largest_leaf: usize,
    /// Edges from the root to the deepest leaf.
    pub depth: usize,
    /// As [`TreeShape::sah_cost`].
    pub sah_cost: Option<f64>,
}

/// One structure on one workload in one epoch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rays {
    pub workload: String,
    /// Of its rays, as [`Workload::hash`](crate::scene::Workload::hash).
    pub hash: String,
    pub query: Query,
    /// Rays of the workload.
    pub all: usize,
    /// Rays of a sample, fewer where the structure is slow.
    pub rays: usize,
    /// Of the answers to these rays, or to a few that another epoch is asked as well.
    pub checksum: u64,
    /// Nanoseconds of each sample; those of two structures with the same index are a pair. None where there is no time.
    pub ns: Vec<u64>,
    /// The same samples, for as many of their rays as slower structures are timed on.
    pub parts: Vec<SubsetSamples>,
    /// Why there is no time: a clause.
    pub untimed: Option<String>,
    /// Whether that is for wrong answers.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub wrong: bool,
    /// What of the rays the structure declines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub declined: Option<String>,
    /// Of epoch 0 alone; they do not change.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checked: Option<Checked>,
    /// Of epoch 0 alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counts: Option<RayCounts>,
    /// Error rates against the exact oracle, where the case asks for them; of epoch 0 alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub errors: Option<ErrorCounts>,
    /// The longest that a single ray takes when it is asked alone, nanoseconds; likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slowest_ns: Option<u64>,
}

/// Rays whose answers were checked: some against brute force, and all that are timed against another tree, with brute force
/// and exact arithmetic as the judges where the two differ.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Checked {
    pub rays: usize,
    /// Those of them with a wrong answer, which no rounding explains.
    pub errors: usize,
    /// Those with an answer that the triangle test rounds.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rounded: usize,
    /// The worst kind of wrong answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<Kind>,
    /// The ray with the worst answer, and what is wrong with that.
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

/// What no machine changes, but for the processor's own counters: of all rays of the workload, or an even sample of
/// many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RayCounts {
    /// Rays that are counted.
    pub rays: usize,
    pub hits: usize,
    /// Of the distances of the hits, bit by bit: the same for all structures over the exact triangle test.
    pub distances: u64,
    /// Triangles tested; nothing where the structure does not tell.
    pub tests: Option<u64>,
    /// Blocks of triangles that were tested at once, likewise.
    pub blocks: Option<u64>,
    /// Nodes and leaves entered, likewise.
    pub steps: Option<u64>,
    /// Leaves entered, likewise.
    pub leaves: Option<u64>,
    /// Leaves entered that hold nothing, likewise.
    pub empty_leaves: Option<u64>,
    /// Triangles tested for all rays of the workload, where the case asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub whole_tests: Option<u64>,
    /// Machine instructions a ray in user space; nothing where they are not counted.
    pub instructions_per_ray: Option<f64>,
    /// Branches that the processor predicted wrongly, a ray; likewise.
    pub branch_misses_per_ray: Option<f64>,
}

impl From<&TreeShape> for Shape {
    /// Without the memory.
    fn from(shape: &TreeShape) -> Self {
        Self {
            bytes: 0,
            inner_nodes: shape.inner,
            leaves: shape.leaves,
            empty_leaves: shape.empty,
            references: shape.references,
            largest_leaf: shape.largest_leaf,
            depth: shape.depth,
            sah_cost: shape.sah_cost,
        }
    }
}

impl Structure {
    /// Whether other answers than before cost it its own times alone: those of a program, or of a structure with known
    /// defects.
    pub fn may_err(&self) -> bool {
        self.name == RUNNER || known_defect(&self.name).is_some()
    }

    /// Whether it is built a second time, for the A/A noise.
    pub fn is_twin(&self) -> bool {
        self.role == TWIN
    }
}

impl Rays {
    /// Nanoseconds a ray in every sample, over the part of `rays` rays of it. None where those were not timed.
    pub fn paces(&self, rays: usize) -> Vec<f64> {
        let part = self.parts.iter().find(|part| part.rays == rays).map(|part| &part.ns);
        let ns = if rays == self.rays { Some(&self.ns) } else { part };
        ns.into_iter().flatten().map(|&ns| ns.max(1) as f64 / rays as f64).collect()
    }
}

impl RayCounts {
    /// `n` for each ray that is counted.
    fn per_ray(&self, n: Option<u64>) -> Option<f64> {
        Some(n? as f64 / self.rays.max(1) as f64)
    }

    /// Triangles tested for each ray.
    pub fn tests_per_ray(&self) -> Option<f64> {
        self.per_ray(self.tests)
    }

    /// Nodes and leaves entered for each ray.
    pub fn steps_per_ray(&self) -> Option<f64> {
        self.per_ray(self.steps)
    }

    /// Triangle tests as a multiple of the fewest that could do: one for each ray that hits, which a structure that knew
    /// the answer would still make, and none for the others (Havran, Purgathofer 2003). Nothing where no ray hits.
    pub fn tests_over_minimum(&self) -> Option<f64> {
        (self.hits > 0).then_some(self.tests? as f64 / self.hits as f64)
    }
}

impl Epoch {
    /// The scene as keys and tables name it.
    pub fn title(&self) -> String {
        scene_name(&self.scene, self.stand_in)
    }

    /// The structure in this role.
    pub fn in_role(&self, role: &str) -> Option<&Structure> {
        self.structures.iter().find(|structure| structure.role == role)
    }

    /// Rays of a workload on which all structures with a time are timed: as many as the slowest takes.
    pub fn common_rays(&self, workload: &str) -> usize {
        let rays = self.structures.iter().filter(|structure| structure.refused.is_none()).flat_map(|s| &s.rays);
        let timed = rays.filter(|rays| rays.workload == workload && !rays.ns.is_empty());
        timed.map(|rays| rays.rays).min().unwrap_or(0)
    }

    /// Whether no structure has rays, though none is refused.
    pub fn says_nothing(&self) -> bool {
        let is_idle = |structure: &Structure| structure.refused.is_none() && structure.rays.is_empty();
        self.structures.iter().all(is_idle)
    }

    /// Every structure without a time, once.
    pub fn failures(&self) -> Vec<Failure> {
        let mut failures: Vec<Failure> = vec![];
        for structure in &self.structures {
            let failure =
                |sentence, refused, wrong| Failure { structure: structure.name.clone(), sentence, refused, wrong };
            let on = format!("{} on {}", structure.label, self.title());
            let refusal = |why: &String| failure(format!("{on} has no result: {why}."), true, structure.wrong);
            let refused = structure.refused.iter().map(refusal);
            let untimed = structure.rays.iter().filter_map(|rays| {
                let why = rays.untimed.as_ref()?;
                Some(failure(format!("{on}, {} rays, has no time: {why}.", rays.workload), false, rays.wrong))
            });
            failures.extend(refused.chain(untimed));
        }
        each_once(failures)
    }

    /// That every structure is timed on all workloads, and that all of them, being over one triangle test, give the same
    /// answers to the bit.
    ///
    /// # Errors
    /// The first structure of which that is not true.
    pub fn is_whole(&self) -> Result<(), StudyError> {
        if let Some(failure) = self.failures().into_iter().next() {
            return Err(StudyError::Missing { failure: failure.sentence, wrong: failure.wrong });
        }
        if self.structures.iter().any(|structure| structure.rays.is_empty()) {
            return Err(StudyError::NoRays { scene: self.title() });
        }
        self.agree(|_| Some(""))
    }

    /// That structures over the exact triangle test give the same answers to the bit, to the rays that they are counted
    /// on: many times as many as are held against brute force. Over a test that rounds, an answer outside of a triangle's
    /// box is one tree's and not the other's. Those with known defects, and those that have no time, are left out.
    ///
    /// # Errors
    /// The first two that do not.
    pub fn is_unanimous(&self) -> Result<(), StudyError> {
        self.agree(|structure| {
            Some(structure.triangle_test.as_str()).filter(|test| *test == Exact::NAME && !structure.may_err())
        })
    }

    /// That all structures of which `group` gives the same text agree.
    fn agree<'a>(&'a self, group: impl Fn(&'a Structure) -> Option<&'a str>) -> Result<(), StudyError> {
        let mut seen: Vec<(&Structure, &Rays, &str, RayCounts)> = vec![];
        let all = self.structures.iter().filter_map(|structure| Some((structure, group(structure)?)));
        for (structure, own) in all.filter(|(structure, _)| structure.refused.is_none()) {
            for rays in structure.rays.iter().filter(|rays| rays.untimed.is_none()) {
                let Some(counts) = rays.counts else { continue };
                // Of those counted on as many rays: trees that test many triangles are counted on fewer.
                let is_same = |(_, other, group, known): &&(&Structure, &Rays, &str, RayCounts)| {
                    *group == own && other.workload == rays.workload && known.rays == counts.rays
                };
                match seen.iter().find(is_same) {
                    None => seen.push((structure, rays, own, counts)),
                    Some((one, _, _, known)) if known.distances != counts.distances => {
                        let (one, other) = (one.label.clone(), structure.label.clone());
                        let (scene, rays) = (self.title(), rays.workload.clone());
                        return Err(StudyError::Disagree { one, other, scene, rays });
                    }
                    Some(_) => {}
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// 1000 closest-hit rays of a workload as if they had been counted, not timed.
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

    /// An epoch as if it had been measured: a structure, its build, and nanoseconds of every round of 1000 primary rays.
    /// A label that stands there a second time is the twin of the first.
    pub fn example(scene: &str, triangles: usize, epoch: usize, structures: &[(&str, u64, &[u64])]) -> Epoch {
        let structure = |(place, &(label, build_ns, ns)): (usize, &(&str, u64, &[u64]))| Structure {
            label: label.into(),
            role: if structures[..place].iter().any(|(other, ..)| *other == label) {
                TWIN.into()
            } else {
                String::new()
            },
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
