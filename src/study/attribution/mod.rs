//! `attribution`: the shares of split plane, stop rule and traversal in the SAH speedup.
//!
//! The design is factorial: six split planes, three stop rules and two traversals in all combinations. Two trees are
//! built twice, for the A/A check. The role of a second build is `twin`.

mod design;
mod findings;
mod result;
mod tables;
#[cfg(test)]
mod tests;

use clap::{ArgMatches, Args as _, Command, FromArgMatches};

use super::{Dataset, Plan, PlannedScene, Presets, Settings, Study, claims};
use crate::registry::Registry;
use crate::report::Report;
use crate::report::words::listed;
use crate::request::{
    Measuring, RAYS, SCENES, STRUCTURES, Scenes, StructureRequest, WorkloadRequest, known_tests, rays_or_all,
    scene_files,
};
use crate::scene::WorkloadKind;
use design::{Treatment, trees};

const NAME: &str = "attribution";

pub const STUDY: Study = Study {
    name: NAME,
    question: "Attribute the SAH speedup to the split plane, the stop rule and the traversal",
    presets: Presets { full: "", quick: "torus --rays 1024 --epochs 2 --runs 2 --budget 1" },
    options: || AttributionArgs::augment_args(Command::new(NAME)),
    plan,
    report,
};

#[derive(Clone, Debug, clap::Args)]
struct AttributionArgs {
    #[command(flatten)]
    scenes: Scenes,
    /// Fail if the real mesh of a scene is missing [default: measure its stand-in]
    #[arg(long, help_heading = SCENES, value_parser = ["real"])]
    meshes: Option<String>,
    /// Workload (see `sahara list`)
    #[arg(long, short, help_heading = RAYS, value_name = "WORKLOAD", default_value = "primary")]
    workload: WorkloadKind,
    /// Maximum number of rays to time, in whole tiles of the scene's picture
    #[arg(long, help_heading = RAYS, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    rays: usize,
    /// Triangle test of all trees (see `sahara list`)
    #[arg(long, short, help_heading = STRUCTURES, value_name = "NAME", default_value = "exact")]
    test: String,
    // Default epochs, default runs, and default budget in seconds.
    // All claims are judged together, which needs many epochs.
    #[command(flatten)]
    measuring: Measuring<8, 3, 5>,
}

fn plan(matches: &ArgMatches, registry: &Registry) -> anyhow::Result<Plan> {
    let args = AttributionArgs::from_arg_matches(matches)?;
    known_tests(registry, std::slice::from_ref(&args.test))?;
    let request = |(cell, role): (Treatment, String)| {
        anyhow::Ok(StructureRequest::new(registry.choose(&cell.spec(&args.test))?.label, role))
    };
    let structures = trees().map(request).collect::<anyhow::Result<Vec<_>>>()?;
    let workloads = WorkloadRequest::of_scene(vec![args.workload], args.rays);
    let settings = Settings { whole: true, ..Settings::new(&args.measuring, registry)? };
    let scenes = args.scenes.read(registry, &[])?;
    let stand_ins =
        scenes.iter().filter(|(_, scene)| !scene.stand_ins.is_empty()).map(|(_, scene)| scene.name.as_str());
    let stand_ins = listed(&stand_ins.collect::<Vec<_>>());
    let missing = format!(
        "The real meshes of {stand_ins} are missing: `sahara fetch` downloads them; SAHARA_DATA sets their folder."
    );
    anyhow::ensure!(
        args.meshes.is_none() || stand_ins.is_empty(),
        "{missing} Omit `--meshes real` to measure stand-ins."
    );
    let epochs = args.measuring.epochs.into();
    let planned = scenes.iter().map(|scene| PlannedScene::new(scene, &structures, &workloads, &settings, epochs));
    let mut plan = Plan::by_epoch(NAME, &planned.collect::<Vec<_>>()).noting(scenes.iter().map(|(_, scene)| scene));
    plan.notes.extend((!stand_ins.is_empty()).then_some(missing));
    Ok(Plan { inputs: scene_files(registry, &args.scenes.scenes), ..plan })
}

fn report(dataset: &Dataset, _: &ArgMatches) -> Report {
    let results = result::results(dataset);
    let findings = findings::findings(&results);
    Report {
        verdicts: claims::judge(NAME, &findings),
        findings,
        blocks: tables::blocks(&results),
        failures: dataset.failures(),
        data: tables::trees(&results),
        ..Report::default()
    }
}
