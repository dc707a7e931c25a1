//! `scaling`: how do time, build and memory grow with the number of triangles?
//!
//! Icospheres of 20 to 16 million triangles, seen alike, so that nothing changes but how finely one surface is
//! divided; and the meshes that are named, which differ in more than their number of triangles, so that their exponent
//! says less. Powers are fitted to medians on logarithms, over the meshes on which the structure has more than one
//! leaf: a single leaf is brute force.

mod growth;
mod section;
mod spheres;
mod table;
#[cfg(test)]
mod tests;

use super::args::{Measuring, Rays, Scenes, Structures, with_twin};
use super::bench::room::may_fit;
use super::epoch::Epoch;
use super::{Context, Data, Plan, Study, sources};
use crate::registry::Registry;
use crate::report::document::Block;
use crate::report::number::count;
use crate::report::{Statement, Table};
use crate::scene::{Scene, WorkloadKind};

pub use growth::{Family, FamilyEpoch, Growth, LEVEL_8, Point, result};
pub use spheres::{FINEST, name, sphere, triangles};
use table::{exponents, groups, points};

const STRUCTURES: [&str; 7] =
    ["median-kd", "sah-kd", "sah-kd-wide", "sah-hybrid", "sah-bvh", "obvhs-bvh2", "obvhs-cwbvh"];

/// Epochs of meshes of more than [`LEVEL_8`] triangles, at most: the builds of the finest sphere alone take minutes in
/// each.
const EPOCHS_OF_FINEST: usize = 3;

pub struct ScalingStudy;

/// The finest level of which `fits` says that its triangles have room; the coarsest where none has.
fn finest(fits: impl Fn(usize) -> bool) -> u32 {
    (0..=FINEST).rev().find(|&level| fits(triangles(level))).unwrap_or(0)
}

#[derive(Clone, Debug, clap::Args)]
pub struct ScalingArgs {
    // Beside the icospheres.
    #[command(flatten)]
    scenes: Scenes,
    /// The finest icosphere: 0 has 20 triangles, each next one four times as many, and the last one, 10, 16 million
    /// [default: the last one whose trees fit into memory together]
    #[arg(long, value_name = "LEVEL", value_parser = clap::value_parser!(u32).range(0..=i64::from(FINEST)))]
    finest: Option<u32>,
    #[command(flatten)]
    structures: Structures,
    #[command(flatten)]
    rays: Rays,
    // Claims are judged by these numbers, all of them together: few epochs leave what is sure to luck.
    #[command(flatten)]
    measuring: Measuring<8, 3, 5>,
}

impl Study for ScalingStudy {
    const NAME: &'static str = "scaling";
    const QUESTION: &'static str = "How do time, build and memory grow with the number of triangles?";
    const QUICK: &'static str = "torus --finest 4 --rays 1024 --epochs 2 --runs 2 --budget 1";

    type Args = ScalingArgs;
    type Case = FamilyEpoch;
    type Answer = Vec<Growth>;

    fn plan(args: &ScalingArgs, registry: &Registry) -> anyhow::Result<Plan<FamilyEpoch>> {
        let structures = with_twin(args.structures.chosen(registry, &STRUCTURES)?);
        let asked = args.rays.asked(&[WorkloadKind::Primary, WorkloadKind::Random]);
        let finest = args.finest.unwrap_or_else(|| finest(|triangles| may_fit(structures.len(), triangles)));
        let settings = args.measuring.settings(registry, structures, asked)?;
        // Before the spheres, for they may not be there.
        let meshes = args.scenes.read(&["dragon", "lucy", "sponza"])?;
        let levels: Vec<String> = (0..=finest).map(name).collect();
        // The finest take seconds to make.
        let wanted = sources::wanted(&levels).filter_map(|name| levels.iter().position(|level| level == name));
        let mut scenes: Vec<Scene> = wanted.map(|level| sphere(level as u32)).collect::<Result<_, _>>()?;
        let spheres = scenes.len();
        scenes.extend(meshes);
        let family = move |scene: usize| if scene < spheres { Family::Spheres } else { Family::Meshes };
        let wrap = move |scene, _: &Scene, epoch| Ok(FamilyEpoch { family: family(scene), epoch });
        let epochs = |scene: &Scene| Self::planned_epochs(args.measuring.epochs.into(), scene.mesh.len());
        let epochs: Vec<usize> = scenes.iter().map(epochs).collect();
        let mut plan = settings.plan_of(scenes, args.measuring.epochs, wrap);
        let all = plan.cases.len();
        plan.cases.retain(|case| case.epoch < epochs[case.scene]);
        if plan.cases.len() < all {
            plan.notes.push(format!(
                "Meshes of more than {} triangles are measured in {EPOCHS_OF_FINEST} epochs, for their builds take minutes.",
                count(LEVEL_8 as u64)
            ));
        }
        if args.finest.is_none() {
            plan.decided = vec!["--finest".into(), finest.to_string()];
            if finest < FINEST {
                let note = format!(
                    "Icospheres of more than {} triangles are left out, for the trees over them do not fit into the memory of this machine \
                     together.",
                    count(triangles(finest) as u64)
                );
                plan.warnings.push(note.clone());
                plan.notes.push(note);
            }
        }
        Ok(Plan { inputs: args.scenes.files(), ..plan })
    }

    fn epoch(case: &mut FamilyEpoch) -> Option<(&mut Epoch, usize)> {
        Some((&mut case.epoch, case.family as usize))
    }

    fn planned_epochs(most: usize, triangles: usize) -> usize {
        if triangles > LEVEL_8 { most.min(EPOCHS_OF_FINEST) } else { most }
    }

    fn answer(cases: &[FamilyEpoch], _: &Context<Self>) -> Vec<Growth> {
        result(cases)
    }

    fn tables(answer: &Vec<Growth>) -> Vec<Table> {
        groups(answer).iter().flat_map(|group| [exponents(group), points(group)]).collect()
    }

    fn data(answer: &Vec<Growth>) -> Vec<Data> {
        vec![Data::nested(Self::NAME, answer, &["family", "structure", "workload"], "points")]
    }

    fn statements(answer: &Vec<Growth>) -> Vec<Statement> {
        section::statements(answer)
    }

    fn section(answer: &Vec<Growth>, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }
}
