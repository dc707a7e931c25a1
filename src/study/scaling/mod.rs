//! `scaling` measures how time, build and memory grow with the number of triangles.

mod growth;
mod section;
#[cfg(test)]
mod tests;

use std::ffi::OsString;

use clap::{ArgMatches, Args as _, Command, FromArgMatches};

use super::case::SLOWEST;
use super::{Dataset, Plan, PlannedScene, Presets, Settings, Study, claims};
use crate::registry::Registry;
use crate::report::Report;
use crate::request::{Measuring, Rays, SCENES, Scenes, Structures, scene_files, with_twin};
use crate::scene::spheres::FINEST;
use crate::scene::{Scene, WorkloadKind};
use growth::{FAMILY, LEVEL, MESHES, SPHERES, growths};

const NAME: &str = "scaling";

pub const STUDY: Study = Study {
    name: NAME,
    question: "Measure how time, build and memory grow with the number of triangles",
    presets: Presets { full: "", quick: "torus --finest 4 --rays 1024 --epochs 2 --runs 2 --budget 1" },
    options: || ScalingArgs::augment_args(Command::new(NAME)),
    plan,
    report,
};

const STRUCTURES: [&str; 7] =
    ["median-kd", "sah-kd", "sah-kd-wide", "sah-hybrid", "sah-bvh", "obvhs-bvh2", "obvhs-cwbvh"];

/// The default of `--finest`. The claims need the icosphere of level 8. All default structures together then take
/// about 1 GB.
const FINEST_BY_DEFAULT: u32 = 8;

#[derive(Clone, Debug, clap::Args)]
struct ScalingArgs {
    // Meshes in addition to the icospheres.
    #[command(flatten)]
    scenes: Scenes,
    /// Finest icosphere: level 0 has 20 triangles, each further level four times as many, except level 10, which has 16
    /// million
    #[arg(long, help_heading = SCENES, value_name = "LEVEL", default_value_t = FINEST_BY_DEFAULT, value_parser = clap::value_parser!(u32).range(0..=i64::from(FINEST)))]
    finest: u32,
    #[command(flatten)]
    structures: Structures,
    #[command(flatten)]
    rays: Rays,
    // The const parameters are the defaults of `--epochs`, `--runs` and `--budget` (in seconds).
    // All claims are judged together, which needs many epochs.
    #[command(flatten)]
    measuring: Measuring<8, 3, 5>,
}

fn plan(matches: &ArgMatches, registry: &Registry) -> anyhow::Result<Plan> {
    let args = ScalingArgs::from_arg_matches(matches)?;
    let structures = with_twin(args.structures.chosen(registry, &STRUCTURES)?);
    let workloads = args.rays.request(&[WorkloadKind::Primary, WorkloadKind::Random]);
    let settings = Settings { slowest: Some(SLOWEST), ..Settings::new(&args.measuring, registry)? };
    // Meshes are read before the spheres to report a missing file early.
    let meshes = args.scenes.read(registry, &["dragon", "lucy", "sponza"])?;
    let spheres = Scenes { scenes: (0..=args.finest).map(|level| format!("icosphere:{level}").into()).collect() };
    let spheres = spheres.read(registry, &[])?;

    let planned = |own: &(OsString, Scene), family: &str| {
        PlannedScene::new(own, &structures, &workloads, &settings, args.measuring.epochs.into())
            .labelled(FAMILY, family)
    };
    let levels = spheres.iter().zip(0_u32..);
    let mut all: Vec<PlannedScene> =
        levels.map(|(own, level)| planned(own, SPHERES).labelled(LEVEL, level.to_string())).collect();
    all.extend(meshes.iter().map(|own| planned(own, MESHES)));
    let scenes = spheres.iter().chain(&meshes).map(|(_, scene)| scene);
    let plan = Plan::by_epoch(NAME, &all).noting(scenes);
    Ok(Plan { inputs: scene_files(registry, &args.scenes.scenes), ..plan })
}

fn report(dataset: &Dataset, _: &ArgMatches) -> Report {
    let growths = growths(dataset);
    let findings = section::findings(&growths);
    Report {
        verdicts: claims::judge(NAME, &findings),
        findings,
        blocks: section::blocks(&growths),
        failures: dataset.failures(),
        data: section::data(&growths),
        ..Report::default()
    }
}
