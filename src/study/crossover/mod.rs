//! `crossover`: is there a depth complexity beyond which a KD-tree is faster than a BVH?
//!
//! A family of scenes of one to hundreds of layers of perforated sheets, of always the same number of triangles
//! ([`meshes::sheets`](crate::scene::meshes::sheets)), and pairs of a KD-tree and a BVH. Their ratio of times is set against the depth
//! complexity that is measured: the surfaces that a ray would meet if none stopped it.
//!
//! # References
//! Vinkler, Havran, Bittner: Performance comparison of bounding volume hierarchies and kd-trees for GPU ray tracing, 2016: on GPUs the
//! BVH is faster on simple and moderate scenes, the KD-tree on those of high depth complexity.

mod complexity;
mod curve;
mod family;
mod result;
mod section;
mod table;
#[cfg(test)]
mod tests;

use super::args::{Measuring, Rays, Structures, with_twin};
use super::epoch::Epoch;
use super::{Context, Data, Plan, Study, StudyError, sources};
use crate::measure::spread;
use crate::registry::Registry;
use crate::report::document::Block;
use crate::report::{Statement, Table};
use crate::scene::{Scene, Workload, WorkloadKind};

pub use complexity::complexity;
pub use curve::Crossing;
pub use family::{ROOTS, member, name};
pub use result::{Member, MemberEpoch, PAIRS, Race, result};
pub use table::tables;
use table::verdict;

pub struct CrossoverStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct CrossoverArgs {
    /// Leave out the members of more than this squared layers
    #[arg(long, value_name = "ROOT", default_value_t = DEEPEST, value_parser = clap::value_parser!(u32).range(1..))]
    deepest: u32,
    #[command(flatten)]
    structures: Structures,
    #[command(flatten)]
    rays: Rays,
    #[command(flatten)]
    measuring: Measuring,
}

const DEEPEST: u32 = ROOTS[ROOTS.len() - 1];

const WORKLOADS: [WorkloadKind; 4] =
    [WorkloadKind::Primary, WorkloadKind::Random, WorkloadKind::Shadow, WorkloadKind::Ambient];

/// Rays of a kind that the depth complexity is measured on, at most.
const PROBES: usize = 2048;

impl Study for CrossoverStudy {
    const NAME: &'static str = "crossover";
    const QUESTION: &'static str = "Does a KD-tree overtake a BVH where rays would meet more surfaces?";
    const QUICK: &'static str = "--rays 1024 --epochs 2 --runs 2 --budget 1";

    type Args = CrossoverArgs;
    type Case = MemberEpoch;
    type Answer = Vec<Race>;

    fn plan(args: &CrossoverArgs, registry: &Registry) -> anyhow::Result<Plan<MemberEpoch>> {
        let mut own = PAIRS.as_flattened().to_vec();
        own.sort_unstable();
        own.dedup();
        let structures = with_twin(args.structures.chosen(registry, &own)?);
        let chosen = |spec: &str| structures.iter().any(|choice| choice.label == spec);
        anyhow::ensure!(
            PAIRS.iter().any(|[kd, bvh]| chosen(kd) && chosen(bvh)),
            "no KD-tree and BVH of a pair is among these structures; the pairs are: {}",
            PAIRS.map(|[kd, bvh]| format!("{kd} and {bvh}")).join("; ")
        );
        let settings = args.measuring.settings(registry, structures, args.rays.asked(&WORKLOADS))?;
        let is_wanted = |&root: &u32| root <= args.deepest && sources::wanted(&[name(root)]).next().is_some();
        let roots: Vec<u32> = ROOTS.into_iter().filter(is_wanted).collect();
        let scenes: Vec<Scene> = roots.iter().map(|&root| member(root)).collect::<Result<_, _>>()?;

        let (guide, asked, seed) = (settings.guide.clone(), settings.asked.clone(), settings.seed);
        let wrap = move |number: usize, scene: &Scene, epoch| {
            let guide = guide.build(&scene.mesh).map_err(StudyError::of_build(&guide.label, &scene.name))?;
            let of = |w: Workload| Some((w.name, complexity(guide.as_ref(), &spread(&w.rays, PROBES))?));
            let workloads = asked.workloads(scene, seed, guide.as_ref(), &mut |_| ());
            let complexity = workloads.into_iter().filter_map(of).collect();
            Ok(MemberEpoch { layers: roots[number] * roots[number], complexity, epoch })
        };
        Ok(settings.plan_of(scenes, args.measuring.epochs, wrap))
    }

    fn epoch(case: &mut MemberEpoch) -> Option<(&mut Epoch, usize)> {
        Some((&mut case.epoch, 0))
    }

    fn answer(cases: &[MemberEpoch], _: &Context<Self>) -> Vec<Race> {
        result(cases)
    }

    fn tables(answer: &Vec<Race>) -> Vec<Table> {
        tables(answer)
    }

    fn data(answer: &Vec<Race>) -> Vec<Data> {
        vec![Data::nested(Self::NAME, answer, &["kd", "bvh", "workload"], "members")]
    }

    fn statements(answer: &Vec<Race>) -> Vec<Statement> {
        section::statements(answer)
    }

    fn section(answer: &Vec<Race>, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }
}
