//! `study crossover`.

use super::epochs::{Field, cases, verdict};
use crate::cli::Verdict;
use crate::cli::terminal::Terminal;
use crate::measure::spread;
use crate::registry::Registry;
use crate::scene::{Scene, Workload, WorkloadKind};
use crate::study::StudyError;
use crate::study::crossover::{Case, NAME, PAIRS, ROOTS, complexity, member, result, rows, tables};

#[derive(Clone, Debug, clap::Args)]
pub struct Args {
    /// Leave out the members of more than this squared layers
    #[arg(long, value_name = "ROOT", default_value_t = ROOTS[ROOTS.len() - 1], value_parser = clap::value_parser!(u32).range(1..))]
    pub deepest: u32,
    #[command(flatten)]
    pub field: Field,
}

/// Rays of a kind that the depth complexity is measured on, at most.
const PROBES: usize = 2048;

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let options = &args.field.options;
    let files = options.exports.check()?;
    let mut structures = PAIRS.as_flattened().to_vec();
    structures.sort_unstable();
    structures.dedup();
    let kinds = [WorkloadKind::Primary, WorkloadKind::Random, WorkloadKind::Shadow, WorkloadKind::Ambient];
    let settings = args.field.settings(registry, &structures, &kinds)?;
    let chosen = |spec: &str| settings.structures.iter().any(|choice| choice.label == spec);
    anyhow::ensure!(
        PAIRS.iter().any(|[kd, bvh]| chosen(kd) && chosen(bvh)),
        "no KD-tree and BVH of a pair is among these structures; the pairs are: {}",
        PAIRS.map(|[kd, bvh]| format!("{kd} and {bvh}")).join("; ")
    );
    let roots: Vec<u32> = ROOTS.into_iter().filter(|&root| root <= args.deepest).collect();
    let scenes: Vec<Scene> = roots.iter().map(|&root| member(root)).collect::<Result<_, _>>()?;

    let wrap = |s: usize, epoch| {
        let scene = &scenes[s];
        let (structure, name) = (settings.guide.label.clone(), scene.name.clone());
        let guide =
            settings.guide.build(&scene.mesh).map_err(|cause| StudyError::Build { structure, scene: name, cause })?;
        let of =
            |workload: Workload| Some((workload.name, complexity(guide.as_ref(), &spread(&workload.rays, PROBES))?));
        let workloads = settings.asked.workloads(scene, settings.seed, guide.as_ref(), &mut |_| ());
        let complexity = workloads.into_iter().filter_map(of).collect();
        Ok(Case { layers: roots[s] * roots[s], complexity, epoch })
    };
    let (cases, provenance) = cases(NAME, options, &settings, &scenes, terminal, wrap, |case: &Case| &case.epoch)?;
    let races = result(&cases);
    let shown = tables(&races);
    let (mut foot, verdict) = verdict(cases.iter().map(|case| &case.epoch));
    foot.push(provenance.line());
    files.tell(terminal, (NAME, &provenance), &races, &rows(&races), &shown, &foot)?;
    Ok(verdict)
}
