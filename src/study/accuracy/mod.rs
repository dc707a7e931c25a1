//! `accuracy`: error and speed of every structure with every triangle test. Exact arithmetic judges the hits.

mod figure;
mod findings;
mod judged;
mod table;
#[cfg(test)]
mod tests;

use std::ffi::OsString;

use anyhow::Context as _;
use clap::{ArgMatches, Args as _, Command, FromArgMatches as _};

use super::{Check, Dataset, Plan, PlannedScene, Presets, Settings, Study};
use crate::registry::Registry;
use crate::report::number::count;
use crate::report::words::{each_once, each_once_by};
use crate::report::{Block, Failure, Report};
use crate::request::{
    BRUTE_FORCE, MEASURING, RAYS, RayKind, RaySource, STRUCTURES, Scenes, Seconds, StructureRequest, WorkloadRequest,
    each_kind, known_defect, known_tests, replayed, scene_files, secondary_ray_structure, specs,
};
use crate::scene::Scene;
use crate::triangle::{Exact, TriangleTest};
use judged::{JudgedRays, judged};

pub const STUDY: Study = Study {
    name: "accuracy",
    question: "Measure error rates and speed of every structure with every triangle test",
    presets: Presets {
        full: "dragon cornellbox -w uniform -w vertex -w grazing",
        quick: "cube -w vertex --rays 500 --runs 2 --budget 1",
    },
    options: || AccuracyArgs::augment_args(Command::new("accuracy")),
    plan,
    report,
};

#[derive(Clone, Debug, clap::Args)]
struct AccuracyArgs {
    #[command(flatten)]
    scenes: Scenes,
    /// Structure with options; measured with all triangle tests unless `test=` is given; may be repeated [default: all;
    /// brute-force only on meshes of at most 5,000 triangles]
    #[arg(long, short, help_heading = STRUCTURES, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// Triangle test; may be repeated [default: all]
    #[arg(long, short, help_heading = STRUCTURES, value_name = "NAME")]
    test: Vec<String>,
    /// Workload: uniform, edge, vertex, axis, grazing, scale, offset or surface; may be repeated [default: all]
    #[arg(long, short, help_heading = RAYS, value_name = "WORKLOAD")]
    workload: Vec<RayKind>,
    /// Rays per workload (0 errors in n rays: error rate below about 3/n with 95 % confidence), or a ray file to replay
    #[arg(long, help_heading = RAYS, value_name = "N|F.rays", default_value = "20000")]
    rays: RaySource,
    /// Samples per structure and workload
    #[arg(long, help_heading = MEASURING, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    /// Time budget in seconds for the samples of one scene; to stay within it, slow structures are timed on fewer rays
    #[arg(long, help_heading = MEASURING, value_name = "SECONDS", default_value_t = BUDGET, allow_negative_numbers = true)]
    budget: Seconds,
    /// Seed of the rays and of the sample order
    #[arg(long, help_heading = MEASURING, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// The default of `--budget`.
const BUDGET: Seconds = Seconds::whole(40);

/// Maximum number of triangles for brute force in the default selection.
const SMALL: usize = 5000;

const HEADLINES: usize = 3;

/// The value of [`Settings::slowest`].
const SLOWEST: f64 = 30.0;

fn plan(matches: &ArgMatches, registry: &Registry) -> anyhow::Result<Plan> {
    let args = AccuracyArgs::from_arg_matches(matches)?;
    let structures = structures(registry, &args.structure, &args.test)?;
    let (scenes, workloads) = match replayed(registry, &args.rays, &args.scenes.scenes, &args.workload, None)? {
        Some((scene, rays)) => (vec![scene], rays),
        None => {
            let (kinds, count) = (each_kind(&args.workload, &RayKind::ALL), args.rays.number()?);
            (args.scenes.read(registry, &[])?, WorkloadRequest::Hard { kinds, count })
        }
    };
    let settings = Settings {
        runs: args.runs.into(),
        budget_ns: Some(args.budget.ns()),
        slowest: Some(SLOWEST),
        check: Check::Oracle,
        seed: args.seed,
        ..Settings::one_sample(secondary_ray_structure(registry)?.label)
    };

    let leaves_out = |own: &(OsString, Scene)| args.structure.is_empty() && own.1.mesh.len() > SMALL;
    let is_left_out = |structure: &StructureRequest| structure.name() == BRUTE_FORCE;
    let planned = |own: &(OsString, Scene)| {
        let mut structures = structures.clone();
        structures.retain(|structure| !leaves_out(own) || !is_left_out(structure));
        PlannedScene::new(own, &structures, &workloads, &settings, 1)
    };
    let planned: Vec<PlannedScene> = scenes.iter().map(planned).collect();
    let mut plan = Plan::by_epoch(STUDY.name, &planned).by_scene().noting(scenes.iter().map(|(_, scene)| scene));
    if scenes.iter().any(leaves_out) && structures.iter().any(is_left_out) {
        plan.notes.push(format!(
            "{BRUTE_FORCE} is skipped on meshes of more than {} triangles; pass --structure {BRUTE_FORCE} to run it on a \
             subset of the rays.",
            count(SMALL as u64)
        ));
    }
    plan.inputs = scene_files(registry, &args.scenes.scenes);
    plan.inputs.extend(args.rays.file().map(Into::into));
    Ok(plan)
}

fn structures(registry: &Registry, named: &[String], tests: &[String]) -> anyhow::Result<Vec<StructureRequest>> {
    known_tests(registry, tests)?;
    let mut chosen: Vec<StructureRequest> = vec![];
    for spec in specs(registry, named) {
        let choice = registry.choose(&spec)?;
        let keys = spec.split_once(':').map_or("", |(_, keys)| keys);
        let names_test = keys.split(',').any(|key| key.starts_with("test="));
        for entry in registry.entries().iter().filter(|entry| entry.name == choice.entry.name) {
            let test = entry.triangle_test;
            let is_named = tests.is_empty() || tests.iter().any(|own| own.eq_ignore_ascii_case(test));
            let with_test = match (names_test, keys) {
                _ if !is_named => continue,
                (true, _) if test != choice.triangle_test() => continue,
                (true, _) => spec.clone(),
                (false, "") => format!("{}:test={test}", entry.name),
                (false, keys) => format!("{}:{keys},test={test}", entry.name),
            };
            chosen.push((&registry.choose(&with_test)?).into());
        }
    }
    let chosen = each_once_by(chosen, |one, other| one.spec == other.spec);
    chosen.first().context("no structure is available with these triangle tests: see `sahara list`")?;
    Ok(chosen)
}

fn report(dataset: &Dataset, _: &ArgMatches) -> Report {
    let all = judged(dataset);
    let kinds = each_once(all.iter().map(|of_kind| (of_kind.kind, of_kind.description())));
    let kinds: Vec<String> = kinds.iter().map(|(kind, description)| format!("{kind}: {description}")).collect();
    let text = "Exact arithmetic gives the true hit of every ray. A result is wrong if the hit is missed, invented or \
                at a wrong depth; a range of shares is over our structures. Errors on different workloads are never \
                pooled, because they have different causes. The front contains the structures that no other one beats \
                in both speed and error.";
    let mut blocks = vec![Block::Text(text.into())];
    blocks.extend((!kinds.is_empty()).then(|| Block::Text(format!("Workloads: {}.", kinds.join("; ")))));
    for (i, of_kind) in all.iter().enumerate() {
        blocks.extend([Block::figure(figure::figure(i, of_kind)), Block::Table(table::table(of_kind))]);
    }
    blocks.extend(table::LEGEND.map(|words| Block::Note(words.into())));
    let of_kinds = all.iter().filter_map(findings::finding);
    let findings = of_kinds.map(|own| if all.len() > HEADLINES { own.detail() } else { own }).collect();
    Report { findings, blocks, failures: failures(dataset, &all), data: table::data(&all), ..Report::default() }
}

fn failures(dataset: &Dataset, all: &[JudgedRays]) -> Vec<Failure> {
    let mut failures = vec![];
    for judged in all.iter().flat_map(|of_kind| &of_kind.structures) {
        let own = judged.structure;
        let must_be_exact = own.triangle_test == Exact::NAME && known_defect(&own.name).is_none();
        if must_be_exact && judged.errors.errors() + judged.errors.wrong_primitive > 0 {
            // The sentence is empty, because the tables show the errors.
            failures.push(Failure { structure: own.name.clone(), wrong: true, ..Failure::default() });
        }
    }
    failures.dedup();
    failures.extend(dataset.failures());
    failures
}
