//! `replicate`: the source report's tables measured again, and the claim it ends with put to the test.
//!
//! The report times all rays of a picture, construction left out, on a machine of its own: seconds can be compared with its
//! seconds only in their ratios. `t'` is seconds / (rays x triangles).

mod findings;
mod original;
mod replication;
mod tables;
#[cfg(test)]
mod tests;

use clap::{ArgMatches, Args as _, Command, FromArgMatches as _};

use super::{Check, Dataset, Plan, PlannedScene, Presets, Settings, Study, claims};
use crate::registry::Registry;
use crate::report::{Block, Report};
use crate::request::{BRUTE_FORCE, Measuring, REPORT_TREE, SAH_TREE, Scenes, StructureRequest, TWIN, WorkloadRequest};
use crate::scene::Scene;
use findings::findings;
use original::{CROWDED, DEFAULT, HARD, MAIN, SWEEP};
use replication::replicated;

pub const STUDY: Study = Study {
    name: "replicate",
    question: "Reproduce the source report's tables and test its conclusion",
    presets: Presets { full: "", quick: "--epochs 2 --runs 2 --budget 1" },
    options,
    plan,
    report,
};

#[derive(Clone, Debug, clap::Args)]
struct ReplicateArgs {
    // Claims are judged by these numbers, all of them together: few epochs leave what is sure to luck.
    #[command(flatten)]
    measuring: Measuring<8, 3, 5>,
}

/// Roles of structures. The settings of the sweep have [roles](original::SweepRow::role) of their own.
const BRUTE: &str = "brute force";
const SAH: &str = "sah";
/// The report's tree on a hard scene.
const TREE: &str = "tree";

/// Tells where secondary rays start: over a triangle test in single precision, as the report's program has one. The exact
/// test decides edges otherwise, and with them a few rays.
const GUIDE: &str = "sah-kd:test=moller-trumbore";

fn options() -> Command {
    ReplicateArgs::augment_args(Command::new(STUDY.name))
}

fn plan(matches: &ArgMatches, registry: &Registry) -> anyhow::Result<Plan> {
    let ReplicateArgs { measuring } = ReplicateArgs::from_arg_matches(matches)?;
    let label = |spec: &str| Ok::<_, anyhow::Error>(registry.choose(spec)?.label);
    let structure = |spec: &str, role: &str| Ok::<_, anyhow::Error>(StructureRequest::new(label(spec)?, role));
    let mut main = vec![structure(BRUTE_FORCE, BRUTE)?, structure(SAH_TREE, SAH)?];
    for row in &SWEEP {
        main.push(structure(&row.spec(), &row.role())?);
    }
    main.push(structure(&DEFAULT.spec(), TWIN)?);
    let hard = [structure(REPORT_TREE, TREE)?, structure(SAH_TREE, SAH)?, structure(REPORT_TREE, TWIN)?];
    let settings = Settings {
        runs: measuring.runs.into(),
        budget_ns: measuring.budget.ns(),
        slowest: None,
        check: Check::default(),
        build_limit_s: None,
        whole_counts: vec![],
        whole: true,
        guide: label(GUIDE)?,
        seed: measuring.seed,
        threads: measuring.threads.into(),
    };
    let counted =
        Settings { whole_counts: vec![label(&DEFAULT.spec())?, label(&CROWDED.1.spec())?], ..settings.clone() };

    let names: Vec<&str> = MAIN.iter().map(|row| row.scene).chain(HARD.iter().map(|row| row.scene)).collect();
    let scenes = Scenes::default().read(registry, &names)?;
    let planned = |own: &(String, Scene)| {
        let epochs = measuring.epochs.into();
        let settings = if own.1.name == CROWDED.0 { &counted } else { &settings };
        if HARD.iter().any(|row| row.scene == own.1.name) {
            PlannedScene::new(own, &hard, &WorkloadRequest::PrimaryPicture, settings, epochs).labelled("table", "hard")
        } else {
            PlannedScene::new(own, &main, &WorkloadRequest::Picture, settings, epochs).labelled("table", "main")
        }
    };
    let planned: Vec<PlannedScene> = scenes.iter().map(planned).collect();
    Ok(Plan::by_epoch(STUDY.name, &planned).noting(scenes.iter().map(|(_, scene)| scene)))
}

fn report(dataset: &Dataset, _: &ArgMatches) -> Report {
    let [main, hard] = [&MAIN[..], &HARD].map(|rows| replicated(dataset, rows));
    let text = "Rays, seconds and settings as in the source report, ours beside its own. Seconds are of different machines \
                and code: compare their ratios.";
    let tables = tables::tables(&main, &hard).into_iter().map(Block::Table);
    let findings = findings(&main, &hard);
    Report {
        blocks: std::iter::once(Block::Text(text.into())).chain(tables).collect(),
        verdicts: claims::judge(STUDY.name, &findings),
        failures: dataset.failures(),
        data: tables::data(main.iter().chain(&hard)),
        findings,
        ..Report::default()
    }
}
