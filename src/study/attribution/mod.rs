//! `attribution`: what of a SAH tree's speed is due to the split plane, what to the stop rule and what to the traversal?
//!
//! One kind of tree in every combination of six planes, three stop rules and two traversals, over one triangle test, on the
//! same rays: the factorial [`design`]. In every epoch all trees are built anew and timed in rounds, each round every tree once, in
//! random order; the report's tree and the SAH tree are built twice, and what the twins differ by is the noise floor. A case of the
//! journal is one epoch of one scene.

pub mod design;
pub mod effects;
mod measure;
mod result;
mod table;
#[cfg(test)]
pub(crate) mod tests;

use serde::{Deserialize, Serialize};

use crate::measure::Threads;
use crate::scene::{Scene, WorkloadKind};
use crate::study::trial::Epoch;

pub use measure::measure;
pub use result::{Attribution, CellResult, Effect, Part, Row, Split, Term, attribute, result, rows};
pub use table::{headlines, tables};

/// What is measured, and for how long.
pub struct Settings {
    pub workload: WorkloadKind,
    /// Rays of the workload, at most.
    pub rays: u32,
    /// Samples of every tree in an epoch, at least 1.
    pub runs: usize,
    /// What the samples of an epoch of one scene may take together, nanoseconds: slow trees are timed on fewer rays to keep
    /// within it.
    pub budget_ns: u64,
    /// What the check of the answers may take for each scene, nanoseconds.
    pub check_ns: u64,
    /// The triangle test of all trees.
    pub test: String,
    /// Seed of the workload and of the order of samples.
    pub seed: u64,
    pub threads: Threads,
}

/// The settings as a journal keeps them: what its cases depend on.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Kept<'a> {
    workload: &'a str,
    rays: u32,
    runs: usize,
    budget_ns: u64,
    test: &'a str,
    seed: u64,
}

impl Settings {
    /// What a journal keeps of them.
    pub fn kept(&self) -> impl Serialize {
        Kept {
            workload: self.workload.name(),
            rays: self.rays,
            runs: self.runs,
            budget_ns: self.budget_ns,
            test: &self.test,
            seed: self.seed,
        }
    }
}

/// One epoch of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    pub scene: String,
    /// [`Scene::hash`].
    pub scene_hash: String,
    pub triangles: usize,
    /// Whether a mesh of our own stands in for a real one.
    pub stand_in: bool,
    /// Kind of rays.
    pub workload: String,
    pub workload_hash: String,
    /// Rays of the workload.
    pub workload_rays: usize,
    /// The cells of the design in their order, then the twins of the report's tree and of the SAH tree.
    pub epoch: Epoch,
}

/// Name of the study, and of its journal.
pub const NAME: &str = "attribution";

/// The scene as keys and tables name it.
pub fn scene_name(name: &str, stand_in: bool) -> String {
    if stand_in { format!("{name} (stand-in)") } else { name.into() }
}

/// The key of an epoch of a scene.
pub fn key(scene: &Scene, epoch: usize) -> String {
    format!("{} {} epoch {epoch}", scene_name(&scene.name, !scene.stand_ins.is_empty()), &scene.hash()[..8])
}
