//! `replicate`: the source report's tables measured again, and the claim it ends with put to the test.
//!
//! The report times all rays of a picture, construction left out, on a machine of its own: seconds can be compared with its
//! seconds only in their ratios. `t'` is seconds / (rays x triangles).

pub(in crate::study) mod original;
mod replication;
mod statements;
mod tables;
#[cfg(test)]
mod tests;

use super::args::Measuring;
use super::epoch::{self, Asked, Epoch, Settings};
use super::{BRUTE_FORCE, Context, Data, Plan, REPORT_TREE, SAH_TREE, SceneId, Study, parameters, sources};
use crate::registry::Registry;
use crate::report::document::Block;
use crate::report::{Statement, Table};
use crate::scene::Scene;
use original::{HARD, main_scenes};
pub use replication::{Conclusion, Hard, Main, Rays, Replication, Seconds, Setting};
use statements::statements;
pub use tables::tables;

pub struct ReplicateStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct ReplicateArgs {
    // Claims are judged by these numbers, all of them together: few epochs leave what is sure to luck.
    #[command(flatten)]
    measuring: Measuring<8, 3, 5>,
}

impl Study for ReplicateStudy {
    const NAME: &'static str = "replicate";
    const QUESTION: &'static str = "Are the source report's tables found again, and is its conclusion true?";
    const WHOLE: bool = true;
    const QUICK: &'static str = "--epochs 2 --runs 2 --budget 1";

    type Args = ReplicateArgs;
    type Case = Epoch;
    type Answer = Replication;

    fn command() -> String {
        "sahara replicate".into()
    }

    fn plan(args: &ReplicateArgs, registry: &Registry) -> anyhow::Result<Plan<Epoch>> {
        let choose = |specs: &[&str]| specs.iter().map(|spec| registry.choose(spec)).collect::<Result<Vec<_>, _>>();
        let mut sweep = choose(&[BRUTE_FORCE, SAH_TREE])?;
        sweep.extend(parameters::structures(registry)?);
        let hard = choose(&[REPORT_TREE, SAH_TREE, REPORT_TREE])?;
        let settings = [(sweep, Asked::Picture), (hard, Asked::PrimaryPicture)]
            .map(|(structures, asked)| args.measuring.settings(registry, structures, asked))
            .into_iter()
            .collect::<anyhow::Result<Vec<Settings>>>()?;
        let names: Vec<&str> = main_scenes().into_iter().chain(HARD.iter().map(|row| row.scene)).collect();
        let scenes = sources::wanted(&names).map(sources::scene).collect::<anyhow::Result<Vec<Scene>>>()?;
        let is_hard = |scene: &Scene| usize::from(HARD.iter().any(|row| row.scene == scene.name));
        Ok(epoch::plan(settings, is_hard, scenes, args.measuring.epochs, |_, _, epoch| Ok(epoch)))
    }

    fn answer(cases: &[Epoch], _: &Context<Self>) -> Replication {
        Replication::of(cases)
    }

    fn tables(answer: &Replication) -> Vec<Table> {
        tables(answer)
    }

    fn data(answer: &Replication) -> Vec<Data> {
        vec![
            Data::new("main", &answer.main),
            Data::new("rays", &answer.rays),
            Data::new("settings", &answer.parameters),
            Data::new("hard", &answer.hard),
        ]
    }

    fn statements(answer: &Replication) -> Vec<Statement> {
        statements(answer)
    }

    fn section(answer: &Replication, command: &str) -> Vec<Block> {
        let text = "Rays, seconds and parameters as in the source report, ours beside its own. Seconds are of different machines \
                    and code: compare their ratios.";
        let tables = tables(answer).into_iter().map(|table| Block::table(table, command));
        std::iter::once(Block::Text(text.into())).chain(tables).collect()
    }

    fn scenes(answer: &Replication) -> Vec<SceneId> {
        answer.rays.iter().map(|rays| SceneId { name: rays.scene.clone(), hash: None }).collect()
    }
}
