//! `replicate` reproduces the tables and tests the conclusion of the source report, a student report.
//!
//! The source report used another machine, so only ratios of seconds are comparable. One of the tables shows `t'`,
//! which is seconds / (rays x triangles).

mod findings;
mod original;
mod replication;
mod tables;
#[cfg(test)]
mod tests;

use std::ffi::OsString;

use clap::{ArgMatches, Args as _, Command, FromArgMatches as _};

use super::{Dataset, Plan, PlannedScene, Presets, Settings, Study, claims};
use crate::registry::Registry;
use crate::report::{Block, Report};
use crate::request::{BRUTE_FORCE, Measuring, REPORT_TREE, SAH_TREE, Scenes, StructureRequest, TWIN, WorkloadRequest};
use crate::scene::Scene;
use findings::findings;
use original::{CROWDED, DEFAULT, HARD, MAIN, Row, SWEEP, SweepRow};
use replication::{BRUTE, SAH, TREE, replicated};

pub const STUDY: Study = Study {
    name: "replicate",
    question: "Reproduce the source report's tables and test its conclusion",
    presets: Presets { full: "", quick: "--epochs 2 --runs 2 --budget 1" },
    options: || Options::augment_args(Command::new("replicate")),
    plan,
    report,
};

// The const parameters are the defaults of `--epochs`, `--runs` and `--budget` (in seconds).
// All claims are judged together, which needs many epochs.
type Options = Measuring<8, 3, 5>;

/// Secondary rays start at the hits of this structure. The triangle test of this structure is in single precision, as
/// in the source report. The exact test decides edges differently, which changes a few rays.
const SECONDARY_RAY_STRUCTURE: &str = "sah-kd:test=moller-trumbore";

fn plan(matches: &ArgMatches, registry: &Registry) -> anyhow::Result<Plan> {
    let measuring = Options::from_arg_matches(matches)?;
    let secondary_ray_structure = registry.choose(SECONDARY_RAY_STRUCTURE)?.label;
    let settings = Settings { whole: true, secondary_ray_structure, ..Settings::new(&measuring, registry)? };
    let rows: Vec<&Row> = MAIN.iter().chain(&HARD).collect();
    let scenes = Scenes::default().read(registry, &rows.iter().map(|row| row.scene).collect::<Vec<_>>())?;
    let planned = |(own, row): (&(OsString, Scene), &&Row)| {
        let (workloads, table) =
            if row.is_hard() { (WorkloadRequest::PrimaryPicture, "hard") } else { (WorkloadRequest::Picture, "main") };
        let counted = if row.scene == CROWDED.0 { &[DEFAULT, CROWDED.1][..] } else { &[] };
        let settings = Settings { whole_counts: counted.iter().map(SweepRow::spec).collect(), ..settings.clone() };
        let structures = structures(registry, row)?;
        let planned = PlannedScene::new(own, &structures, &workloads, &settings, measuring.epochs.into());
        anyhow::Ok(planned.labelled("table", table))
    };
    let planned = scenes.iter().zip(&rows).map(planned).collect::<anyhow::Result<Vec<_>>>()?;
    Ok(Plan::by_epoch(STUDY.name, &planned).noting(scenes.iter().map(|(_, scene)| scene)))
}

fn structures(registry: &Registry, row: &Row) -> anyhow::Result<Vec<StructureRequest>> {
    let first = if row.is_hard() { (REPORT_TREE, TREE) } else { (BRUTE_FORCE, BRUTE) };
    let mut roles = [first, (SAH_TREE, SAH)].map(|(spec, role)| (spec.to_owned(), role.to_owned())).to_vec();
    roles.extend(SWEEP.iter().filter(|_| !row.is_hard()).map(|setting| (setting.spec(), setting.role())));
    roles.push((DEFAULT.spec(), TWIN.into()));
    roles.into_iter().map(|(spec, role)| Ok(StructureRequest::new(registry.choose(&spec)?.label, role))).collect()
}

fn report(dataset: &Dataset, _: &ArgMatches) -> Report {
    let all = replicated(dataset);
    let (main, hard) = all.split_at(all.partition_point(|own| !own.report.is_hard()));
    let text = "The tables compare rays, seconds and settings of the source report with ours. The seconds come from \
                different machines and code: compare only their ratios.";
    let tables = tables::tables(&all, main, hard).into_iter().map(Block::Table);
    let findings = findings(main, hard);
    Report {
        blocks: std::iter::once(Block::Text(text.into())).chain(tables).collect(),
        verdicts: claims::judge(STUDY.name, &findings),
        failures: dataset.failures(),
        data: tables::data(&all),
        findings,
        ..Report::default()
    }
}
