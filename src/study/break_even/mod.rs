//! `break-even`: after how many rays does a dearer build pay?

mod interval;
mod payoff;
mod result;
mod section;
mod table;
#[cfg(test)]
mod tests;

use super::args::QUICK_EPOCHS;
use super::epoch::Epoch;
use super::epoch_args::EpochArgs;
use super::{Context, Data, Plan, Study};
use crate::registry::Registry;
use crate::report::Table;
use crate::report::document::Block;
use crate::scene::WorkloadKind;

pub use payoff::Payoff;
pub use result::{Market, Offer, Pair, Row, Stretch, result, rows};
use table::{LEGEND, table};

const STRUCTURES: [&str; 8] =
    ["brute-force", "median-kd", "sah-kd", "sah-kd-wide", "sah-hybrid", "sah-bvh", "obvhs-bvh2", "obvhs-cwbvh"];

pub struct BreakEvenStudy;

impl Study for BreakEvenStudy {
    const NAME: &'static str = "break-even";
    const QUESTION: &'static str = "After how many rays does a dearer build pay?";
    const BOTH_MESHES: bool = true;
    const QUICK: &'static str = QUICK_EPOCHS;

    type Args = EpochArgs;
    type Case = Epoch;
    type Answer = Vec<Market>;

    fn plan(args: &EpochArgs, registry: &Registry) -> anyhow::Result<Plan<Epoch>> {
        args.plan(registry, &STRUCTURES, &[WorkloadKind::Primary, WorkloadKind::Diffuse])
    }

    fn answer(cases: &[Epoch], _: &Context<Self>) -> Vec<Market> {
        result(cases)
    }

    fn tables(answer: &Vec<Market>) -> Vec<Table> {
        answer.iter().map(table).collect()
    }

    fn legend(_: &Vec<Market>) -> Vec<String> {
        LEGEND.map(String::from).into()
    }

    fn data(answer: &Vec<Market>) -> Vec<Data> {
        vec![Data::new(Self::NAME, &rows(answer))]
    }

    fn section(answer: &Vec<Market>, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }
}
