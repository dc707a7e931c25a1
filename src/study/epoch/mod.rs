//! One epoch of one scene: what the studies of curves are made of.
//!
//! In an epoch all structures are built anew and timed on all kinds of rays in rounds, each round every case once, in random order.
//! A case of a journal is one epoch of one scene, so that a run that is killed loses one at most.

mod line;
mod measure;
#[cfg(test)]
pub(crate) mod tests;
mod trouble;

use serde::{Deserialize, Serialize};

use super::attribution::scene_name;
use crate::accel::Query;
use crate::measure::Threads;
use crate::registry::Choice;
use crate::scene::{Scene, WorkloadKind};

pub use line::{Draw, Draws, Line, centre, lines};
pub use measure::measure;
pub use trouble::{Trouble, troubles};

/// What is measured, and for how long.
pub struct Settings {
    /// The structures, in the order of the tables.
    pub structures: Vec<Choice>,
    /// The structure that tells where secondary rays start.
    pub guide: Choice,
    /// The kinds of rays; those that a scene has none of are left out.
    pub workloads: Vec<WorkloadKind>,
    /// Rays of a workload, at most.
    pub rays: u32,
    /// Samples of every case in an epoch, at least 1.
    pub runs: usize,
    /// What the samples of an epoch of one scene may take together, nanoseconds: slow cases are timed on fewer rays to keep
    /// within it.
    pub budget_ns: u64,
    /// What the check of the answers may take for each scene, nanoseconds.
    pub check_ns: u64,
    /// Seed of the workloads and of the order of samples.
    pub seed: u64,
    pub threads: Threads,
}

/// The settings as a journal keeps them: what its cases depend on.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Kept {
    structures: String,
    workloads: String,
    rays: u32,
    runs: usize,
    budget_ns: u64,
    seed: u64,
}

impl Settings {
    /// What a journal keeps of them.
    pub fn kept(&self) -> impl Serialize + use<> {
        let structures: Vec<&str> = self.structures.iter().map(|choice| choice.label.as_str()).collect();
        let workloads: Vec<&str> = self.workloads.iter().map(|kind| kind.name()).collect();
        Kept {
            structures: structures.join(" "),
            workloads: workloads.join(" "),
            rays: self.rays,
            runs: self.runs,
            budget_ns: self.budget_ns,
            seed: self.seed,
        }
    }
}

/// One epoch of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Epoch {
    /// Its name, and whether a mesh of our own stands in for a real one.
    pub scene: String,
    /// [`Scene::hash`].
    pub scene_hash: String,
    pub triangles: usize,
    /// Counted from 0.
    pub epoch: usize,
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
    /// Nanoseconds of the build, seen from outside.
    pub build_ns: u64,
    /// Memory of the finished structure, without the mesh.
    pub bytes: usize,
    /// Leaves, empty ones included.
    pub leaves: usize,
    pub rays: Vec<Rays>,
}

/// One structure and one kind of rays in one epoch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rays {
    pub workload: String,
    pub query: Query,
    /// Rays of a sample, fewer than the workload has where the structure is slow.
    pub rays: usize,
    /// Of the answers to these rays.
    pub checksum: u64,
    /// Nanoseconds of each sample; those of two structures with the same index are a pair. None where there is no time.
    pub ns: Vec<u64>,
    /// Why there is no time: a clause.
    pub untimed: Option<String>,
    /// Whether that is for wrong answers.
    pub wrong: bool,
    /// Of the first epoch; they do not change.
    pub counts: Option<RayCounts>,
}

/// What no machine changes, for each ray; nothing where the structure does not tell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RayCounts {
    /// Share of the rays that hit.
    pub hit_rate: f64,
    pub tests: Option<f64>,
    /// Nodes and leaves entered.
    pub steps: Option<f64>,
}

/// The key of an epoch of a scene.
pub fn key(scene: &Scene, epoch: usize) -> String {
    format!("{} {} epoch {epoch}", scene_name(&scene.name, !scene.stand_ins.is_empty()), &scene.hash()[..8])
}
