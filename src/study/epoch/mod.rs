//! One epoch of one scene: what the studies of curves are made of.
//!
//! In an epoch all structures are built anew and timed on all kinds of rays in rounds, each round every case once, in random order, one kind of rays after the other.
//! A case of a journal is one epoch of one scene, so that a run that is killed loses one at most.

mod asked;
mod join;
mod line;
mod measure;
mod plan;
#[cfg(test)]
pub(crate) mod tests;
mod trouble;
mod watch;
mod whole;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::plan::scene_key;
use super::{StudyError, documented_defect};
use crate::accel::Query;
use crate::measure::{Part, Threads};
use crate::registry::{Choice, RUNNER};
use crate::report::CaseCounts;
use crate::report::words::scene_name;
use crate::scene::Scene;
use crate::triangle::{Exact, TriangleTest};

pub use asked::{Asked, PICTURE};
pub use join::{Joined, join, missing};
pub use line::{Line, Twins, lines, middles, scenes, twin_of, twins};
pub use measure::measure;
pub use plan::plan;
pub use trouble::troubles;
pub use watch::Circumstances;
pub use whole::WholeTimes;

/// What is measured, and for how long.
#[derive(Clone)]
pub struct Settings {
    /// The structures, in the order of the tables.
    pub structures: Vec<Choice>,
    /// The structure that tells where secondary rays start.
    pub guide: Choice,
    pub asked: Asked,
    /// Samples of every case in an epoch, at least 1; fewer where there is not time for them all.
    pub runs: usize,
    /// What the samples of an epoch of one scene may take together, nanoseconds: slow cases are timed on fewer rays to keep
    /// within it.
    pub budget_ns: u64,
    /// A structure that takes more than so many times as long as the median one is timed on fewer rays; infinite where none is.
    pub slowest: f64,
    /// Triangle tests that brute force may make to check a workload, about.
    pub check_tests: usize,
    /// Whether what only records tell is measured: the memory of builds, instructions, and what happens to the thread.
    pub detailed: bool,
    /// Seed of the workloads and of the order of samples.
    pub seed: u64,
    pub threads: Threads,
}

/// The settings as a journal keeps them: what its cases depend on.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Kept {
    structures: String,
    workloads: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    rays: Option<usize>,
    runs: usize,
    budget_ns: u64,
    seed: u64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    runners: Vec<Value>,
}

impl Settings {
    /// What a journal keeps of them.
    pub fn kept(&self) -> impl Serialize + use<> {
        let structures: Vec<&str> = self.structures.iter().map(|choice| choice.label.as_str()).collect();
        let (workloads, rays) = self.asked.kept();
        let runners = self.structures.iter().filter(|choice| choice.entry.name == RUNNER);
        Kept {
            structures: structures.join(" "),
            workloads,
            rays,
            runs: self.runs,
            budget_ns: self.budget_ns,
            seed: self.seed,
            runners: runners.map(|choice| choice.config.clone()).collect(),
        }
    }
}

/// As serde asks it of a number that is left out where it is 0.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_none(number: &usize) -> bool {
    *number == 0
}

/// One epoch of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Epoch {
    pub scene: String,
    /// [`Scene::hash`].
    pub scene_hash: String,
    /// Whether a mesh of our own stands in for a real one.
    pub stand_in: bool,
    pub triangles: usize,
    /// Those of them without area.
    #[serde(default, skip_serializing_if = "is_none")]
    pub degenerate: usize,
    /// Counted from 0.
    pub epoch: usize,
    /// In a detailed epoch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circumstances: Option<Circumstances>,
    /// In the order of the settings.
    pub structures: Vec<Structure>,
}

/// One structure in one epoch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Structure {
    /// As chosen.
    pub label: String,
    /// Name in the registry.
    pub name: String,
    /// Why it takes no part: a sentence. What follows is then empty.
    pub refused: Option<String>,
    /// Whether that is for wrong answers.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub wrong: bool,
    /// Nanoseconds of the build, seen from outside unless it times itself.
    pub build_ns: u64,
    /// How long its passes took as seen from outside, as a multiple of what it says itself, where it times itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<f64>,
    pub shape: Shape,
    pub rays: Vec<Rays>,
    /// In a detailed first epoch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub details: Option<StructureDetails>,
}

/// What records tell of a structure beyond that.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StructureDetails {
    /// The whole configuration.
    pub config: Value,
    pub triangle_test: String,
    /// Most bytes held during a build beyond those held before; nothing where they are not counted.
    pub build_peak_bytes: Option<usize>,
    /// Nothing is known of rays here.
    pub counts: CaseCounts,
}

/// What a structure is once it is built, the same in every epoch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// Memory of the finished structure, without the mesh.
    pub bytes: usize,
    /// Leaves, empty ones included.
    pub leaves: usize,
    /// References in leaves.
    pub references: usize,
    /// Edges from the root to the deepest leaf.
    pub depth: usize,
    /// As [`TreeShape::sah_cost`](crate::accel::TreeShape::sah_cost).
    pub sah_cost: Option<f64>,
}

/// One structure and one kind of rays in one epoch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    pub parts: Vec<Part>,
    /// Why there is no time: a clause.
    pub untimed: Option<String>,
    /// Whether that is for wrong answers.
    pub wrong: bool,
    /// Of epoch 0 alone; they do not change.
    pub counts: Option<RayCounts>,
    /// In a detailed first epoch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub details: Option<RayDetails>,
}

/// What records tell of a structure on one kind of rays beyond that.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RayDetails {
    /// Rays held against brute force.
    pub checked: usize,
    /// Those of them with a wrong answer.
    pub errors: usize,
    /// What of the rays the structure declines.
    pub declined: Option<String>,
    pub leaf_steps_per_ray: Option<f64>,
    pub empty_leaf_steps_per_ray: Option<f64>,
    pub tests_over_minimum: Option<f64>,
    pub instructions_per_ray: Option<f64>,
    #[serde(default)]
    pub branch_misses_per_ray: Option<f64>,
}

impl Structure {
    /// Whether other answers than before cost it its part alone: those of a program, or of a structure whose defects are
    /// documented.
    fn may_err(&self) -> bool {
        self.name == RUNNER || documented_defect(&self.name).is_some()
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

/// What no machine changes: of all rays of the workload, or an even sample of many.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RayCounts {
    /// Rays that are counted.
    pub rays: usize,
    pub hits: usize,
    /// Of the distances of the hits, bit by bit: the same for all structures over the exact triangle test.
    pub distances: u64,
    /// Triangles tested; nothing where the structure does not tell.
    pub tests: Option<u64>,
    /// Blocks of triangles that were tested at once, likewise.
    #[serde(default)]
    pub blocks: Option<u64>,
    /// Nodes and leaves entered, likewise.
    pub steps: Option<u64>,
}

impl RayCounts {
    /// Triangles tested for each ray.
    pub fn tests_per_ray(&self) -> Option<f64> {
        Some(self.tests? as f64 / self.rays as f64)
    }

    /// Blocks of triangles tested for each ray.
    pub fn blocks_per_ray(&self) -> Option<f64> {
        Some(self.blocks? as f64 / self.rays as f64)
    }

    /// Nodes and leaves entered for each ray.
    pub fn steps_per_ray(&self) -> Option<f64> {
        Some(self.steps? as f64 / self.rays as f64)
    }
}

impl Epoch {
    /// The scene as keys and tables name it.
    pub fn title(&self) -> String {
        scene_name(&self.scene, self.stand_in)
    }

    /// Rays of a workload on which all structures with a time are timed: as many as the slowest takes.
    pub fn common_rays(&self, workload: &str) -> usize {
        let rays = self.structures.iter().filter(|structure| structure.refused.is_none()).flat_map(|s| &s.rays);
        let timed = rays.filter(|rays| rays.workload == workload && !rays.ns.is_empty());
        timed.map(|rays| rays.rays).min().unwrap_or(0)
    }

    /// Whether no structure takes part in it for want of rays.
    pub fn says_nothing(&self) -> bool {
        let is_idle = |structure: &Structure| structure.refused.is_none() && structure.rays.is_empty();
        self.structures.iter().all(is_idle)
    }

    /// That every structure is timed on rays of all kinds, and that all of them, being over one triangle test, give the same answers to the bit.
    ///
    /// # Errors
    /// The first structure of which that is not true.
    pub fn is_whole(&self) -> Result<(), StudyError> {
        if let Some(trouble) = troubles([self]).into_iter().next() {
            return Err(StudyError::Missing { trouble: trouble.sentence, wrong: trouble.wrong });
        }
        if self.structures.iter().any(|structure| structure.rays.is_empty()) {
            return Err(StudyError::NoRays { scene: self.title() });
        }
        self.agree(|_| Some(""))
    }

    /// That structures over the exact triangle test give the same answers to the bit, to the rays that they are counted on: many times as many
    /// as are held against brute force. Over a test that rounds, an answer outside of a triangle's box is one tree's and not the other's. Those
    /// that are known to err, and those that have no time, are not asked.
    ///
    /// # Errors
    /// The first two that do not.
    pub fn is_unanimous(&self) -> Result<(), StudyError> {
        self.agree(|structure| {
            let test = structure.details.as_ref().map(|details| details.triangle_test.as_str());
            test.filter(|test| *test == Exact::NAME && !structure.may_err())
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

/// The key of an epoch of a scene.
pub fn key(scene: &Scene, epoch: usize) -> String {
    format!("{} epoch {epoch}", scene_key(scene))
}
