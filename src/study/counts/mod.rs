//! `counts`: the measures of a structure that no machine changes.
//!
//! # References
//! Havran, Purgathofer: On comparing ray shooting algorithms, 2003. Aila, Karras, Laine: On quality metrics of bounding volume
//! hierarchies, 2013.

mod end_point_overlap;
mod measures;
mod table;
#[cfg(test)]
mod tests;

use serde_json::json;

use super::args::{Scenes, Structures, WORKLOADS, kinds};
use super::plan::{Measure, named_notes, scene_key};
use super::{Context, Data, Plan, Refused, Study, Trouble, ViewArgs, left_out, sources};
use crate::measure::{Provenance, Threads};
use crate::registry::Registry;
use crate::report::number::count;
use crate::report::{Export, Table, to_json};
use crate::scene::{Scene, WorkloadKind};
use end_point_overlap::MOST;
use measures::{CountSettings, count_scene};
pub use measures::{Counts, Measures, RayMeasures, TreeMeasures};
pub use table::tables;
use table::{LEGEND, histogram_tables};

pub struct CountsStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct CountsArgs {
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    from: ViewArgs,
    #[command(flatten)]
    structures: Structures,
    /// A kind of rays; may be repeated [default: primary, shadow, diffuse, random]
    #[arg(long, short, value_name = "KIND")]
    workload: Vec<WorkloadKind>,
    /// Rays of a workload, at most
    #[arg(long, value_name = "N", default_value_t = RAYS, value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    rays: u32,
    /// Seed of the rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Threads that build; the trees do not depend on it
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Leave out end-point overlap, which takes seconds for a million triangles; of more than that it is estimated
    #[arg(long)]
    no_overlap: bool,
    /// Print the leaves by size and by depth in numbers
    #[arg(long)]
    histograms: bool,
}

const RAYS: u32 = 16384;

/// Said of a scene with so many triangles that some of them tell the overlap.
fn estimated_note(scene: &Scene) -> String {
    format!(
        "{}: EPO is estimated from {} of its triangles, evenly spread, since all would take minutes",
        scene.name,
        count(MOST as u64)
    )
}

impl Study for CountsStudy {
    const NAME: &'static str = "counts";
    const QUESTION: &'static str =
        "What of a structure does no machine change: nodes, references, overlap, steps and tests?";
    const SCENE_BY_SCENE: bool = true;
    const KEPT: bool = false;
    const QUICK: &'static str = "cube torus --rays 1024";

    type Args = CountsArgs;
    type Case = Counts;
    type Answer = Counts;

    fn plan(args: &CountsArgs, registry: &Registry) -> anyhow::Result<Plan<Counts>> {
        let scenes = args.scenes.read(&[])?.into_iter().map(|scene| args.from.of(scene));
        let scenes = scenes.collect::<anyhow::Result<Vec<Scene>>>()?;
        let threads = Threads::new(args.threads.into()).map_err(anyhow::Error::msg)?;
        let settings = CountSettings {
            structures: args.structures.chosen(registry, &[])?,
            named: args.structures.clone(),
            guide: sources::guide(registry)?,
            workloads: kinds(&args.workload, &WORKLOADS),
            rays: args.rays,
            seed: args.seed,
            threads: threads.clone(),
            overlap: !args.no_overlap,
        };
        let labels: Vec<&str> = settings.structures.iter().map(|choice| choice.label.as_str()).collect();
        let kinds: Vec<&str> = settings.workloads.iter().map(|kind| kind.name()).collect();
        let kept = json!({
            "structures": labels.join(" "),
            "workloads": kinds.join(" "),
            "rays": args.rays,
            "seed": args.seed,
            "overlap": settings.overlap,
        });
        let names: Vec<(String, String)> = scenes.iter().map(|scene| (scene.name.clone(), scene_key(scene))).collect();
        let mut notes = named_notes(&scenes, |scene| &scene.notes);
        let estimated = |scene: &&Scene| settings.overlap && scene.mesh.solid().count() > MOST;
        notes.extend(scenes.iter().filter(estimated).map(estimated_note));
        let warnings = named_notes(&scenes, |scene| &scene.warnings);
        let leaves_out = |scene: &&Scene| settings.of(scene).count() < settings.structures.len();
        notes.extend(scenes.iter().filter(leaves_out).map(left_out));
        let measure: Measure<Counts> =
            Box::new(move |case, _, progress| count_scene(&scenes[case.scene], &settings, progress));
        Ok(Plan { notes, warnings, inputs: args.scenes.files(), ..Plan::of_scenes(&kept, threads, names, measure) })
    }

    fn answer(cases: &[Counts], context: &Context<Self>) -> Counts {
        let mut all = Counts { histograms: context.args.is_some_and(|args| args.histograms), ..Counts::default() };
        for case in cases {
            all.measures.extend(case.measures.iter().cloned());
            all.refused.extend(case.refused.iter().cloned());
        }
        all
    }

    fn tables(answer: &Counts) -> Vec<Table> {
        let mut all = vec![];
        let of = |scene: &str| answer.refused.iter().filter(|r| r.scene == scene).cloned().collect::<Vec<Refused>>();
        for measures in answer.measures.chunk_by(|a, b| a.scene == b.scene) {
            all.extend(tables(measures, &of(&measures[0].scene)));
            if answer.histograms {
                all.extend(histogram_tables(measures));
            }
        }
        if answer.measures.is_empty() { tables(&[], &answer.refused) } else { all }
    }

    fn legend(_: &Counts) -> Vec<String> {
        LEGEND.map(String::from).into()
    }

    fn troubles(cases: &[Counts]) -> Vec<Trouble> {
        cases.iter().flat_map(|case| &case.refused).map(Refused::trouble).collect()
    }

    fn data(answer: &Counts) -> Vec<Data> {
        vec![Data::new(Self::NAME, &answer.measures)]
    }

    fn json(answer: &Counts, provenance: &Provenance) -> Vec<u8> {
        to_json(&Export::new(Self::NAME, provenance, &answer.measures))
    }
}
