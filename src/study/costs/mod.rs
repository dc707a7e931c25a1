//! `costs`: what does a step, and what does a test of a block of triangles cost on this machine?
//!
//! The time of a ray is taken for a constant, a cost for each node or leaf entered and one for each block of triangles
//! that is tested at once, however many of its eight places are taken, and these are found by regression over many
//! cases: the performance model of Havran and Purgathofer (2003), which the surface area heuristic builds on.

mod regression;
mod result;
mod section;
mod table;
#[cfg(test)]
mod tests;

use super::args::{QUICK_EPOCHS, WORKLOADS};
use super::epoch::Epoch;
use super::epoch_args::EpochArgs;
use super::{Context, Data, Plan, Study};
use crate::registry::Registry;
use crate::report::Table;
use crate::report::document::Block;

pub use result::{Family, Observation, Off, result};
use table::LEGEND;
pub use table::tables;

/// The structures compared unless others are named: of every family several, whose steps and tests are in different
/// proportion.
const STRUCTURES: [&str; 14] = [
    "brute-force",
    "median-kd",
    "median-kd:leaf=20",
    "median-kd:leaf=300",
    "sah-kd",
    "sah-kd:intersection_cost=0.2",
    "sah-kd:intersection_cost=3",
    "sah-kd-wide",
    "sah-hybrid",
    "sah-bvh",
    "sah-bvh:block_cost=0.3",
    "sah-bvh:block_cost=4",
    "obvhs-bvh2",
    "obvhs-cwbvh",
];

pub struct CostsStudy;

impl Study for CostsStudy {
    const NAME: &'static str = "costs";
    const QUESTION: &'static str = "What does a step, and what does a triangle test cost on this machine?";
    const BOTH_MESHES: bool = true;
    const QUICK: &'static str = QUICK_EPOCHS;

    type Args = EpochArgs;
    type Case = Epoch;
    type Answer = Vec<Family>;

    fn plan(args: &EpochArgs, registry: &Registry) -> anyhow::Result<Plan<Epoch>> {
        args.plan(registry, &STRUCTURES, &WORKLOADS)
    }

    fn answer(cases: &[Epoch], _: &Context<Self>) -> Vec<Family> {
        result(cases)
    }

    fn tables(answer: &Vec<Family>) -> Vec<Table> {
        tables(answer)
    }

    fn legend(_: &Vec<Family>) -> Vec<String> {
        LEGEND.map(String::from).into()
    }

    fn data(answer: &Vec<Family>) -> Vec<Data> {
        vec![Data::nested(Self::NAME, answer, &["family"], "observations")]
    }

    fn section(answer: &Vec<Family>, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }
}
