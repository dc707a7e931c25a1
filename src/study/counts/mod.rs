//! `counts`: the measures of a structure that no machine changes.
//!
//! # References
//! Havran, Purgathofer: On comparing ray shooting algorithms, 2003. Aila, Karras, Laine: On quality metrics of bounding volume
//! hierarchies, 2013.

mod end_point_overlap;
mod table;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::args::{Scenes, Structures, WORKLOADS};
use super::check::declined;
use super::counted::Counted;
use super::plan::Measure;
use super::{Context, Data, Effort, PANICKED, Plan, Refused, Stage, Study, StudyError, Trouble, guarded, sources};
use crate::accel::{DynAccel, Histogram, Query};
use crate::measure::{Provenance, Threads};
use crate::registry::{Choice, Registry};
use crate::report::words::scene_name;
use crate::report::{Export, Table, to_json};
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use end_point_overlap::end_point_overlap;

pub use table::tables;
use table::{LEGEND, histogram_tables};

/// What is counted.
struct CountSettings {
    /// The structures, in the order of the tables.
    pub structures: Vec<Choice>,
    /// The structure that tells where secondary rays start.
    pub guide: Choice,
    /// The kinds of rays; those that a scene has none of are left out.
    pub workloads: Vec<WorkloadKind>,
    /// Rays of a workload, at most.
    pub rays: u32,
    /// Seed of the workloads.
    pub seed: u64,
    /// Those that build.
    pub threads: Threads,
    /// Whether end-point overlap, which takes seconds for a million triangles, is computed.
    pub overlap: bool,
}

/// Everything counted of one structure over one scene. What is not known is nothing, never 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    pub scene: String,
    pub triangles: usize,
    /// Triangles without area, which no structure holds.
    pub degenerate: usize,
    pub stand_in: bool,
    /// As chosen.
    pub structure: String,
    pub triangle_test: String,
    pub tree: TreeMeasures,
    pub rays: Vec<RayMeasures>,
}

/// Of the structure itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TreeMeasures {
    pub inner_nodes: usize,
    /// Leaves, empty ones included.
    pub leaves: usize,
    pub empty_leaves: usize,
    /// (leaf, triangle) pairs.
    pub references: usize,
    /// References for each triangle with an area.
    pub duplication: Option<f64>,
    /// References for each leaf that is not empty.
    pub mean_leaf: Option<f64>,
    pub largest_leaf: usize,
    /// Edges from the root to the deepest leaf.
    pub depth: usize,
    /// As in [`TreeShape::sah_cost`](crate::accel::TreeShape::sah_cost).
    pub sah_cost: Option<f64>,
    /// As in the end-point overlap of Aila, Karras and Laine (2013).
    pub end_point_overlap: Option<f64>,
    /// Memory of the finished structure, without the mesh.
    pub bytes: usize,
    /// Leaves by their number of references; nothing where it is not known.
    pub leaf_sizes: Histogram,
    /// Leaves by depth; nothing where it is not known.
    pub leaf_depths: Histogram,
}

/// Of the rays of one kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RayMeasures {
    pub workload: String,
    pub query: Query,
    pub rays: usize,
    pub hits: usize,
    /// Share of the rays that hit: of the scene, not of the structure.
    pub hit_rate: f64,
    pub tests_per_ray: Option<f64>,
    /// Nodes and leaves entered.
    pub steps_per_ray: Option<f64>,
    pub leaf_steps_per_ray: Option<f64>,
    pub empty_leaf_steps_per_ray: Option<f64>,
    /// Tests as a multiple of the fewest possible, which are one for each ray that hits and none for the others.
    pub tests_over_minimum: Option<f64>,
}

/// What came of one scene, or of all.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    pub measures: Vec<Measures>,
    /// The structures without measures.
    pub refused: Vec<Refused>,
    /// Whether leaves are printed in numbers.
    #[serde(skip)]
    pub histograms: bool,
}

/// The study.
pub struct CountsStudy;

/// Its options.
#[derive(Clone, Debug, clap::Args)]
pub struct CountsArgs {
    #[command(flatten)]
    scenes: Scenes,
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
    /// Leave out end-point overlap, which takes seconds for a million triangles
    #[arg(long)]
    no_overlap: bool,
    /// Print the leaves by size and by depth in numbers
    #[arg(long)]
    histograms: bool,
}

const RAYS: u32 = 16384;

/// What the counts depend on.
#[derive(Serialize)]
struct Kept {
    structures: String,
    workloads: String,
    rays: u32,
    seed: u64,
    overlap: bool,
}

impl Study for CountsStudy {
    const NAME: &'static str = "counts";
    const QUESTION: &'static str =
        "What of a structure does no machine change: nodes, references, overlap, steps and tests?";
    const SCENE_BY_SCENE: bool = true;
    const KEPT: bool = false;

    type Args = CountsArgs;
    type Case = Counts;
    type Answer = Counts;

    fn command() -> String {
        format!("sahara study {} --dir runs", Self::NAME)
    }

    fn args(effort: Effort) -> CountsArgs {
        let (scenes, rays) = match effort {
            Effort::Full => (Scenes::default(), RAYS),
            Effort::Quick => (Scenes::named(&["cube", "torus"]), 1024),
        };
        let (structures, workload) = (Structures::default(), vec![]);
        CountsArgs { scenes, structures, workload, rays, seed: 1, threads: 1, no_overlap: false, histograms: false }
    }

    fn plan(args: &CountsArgs, registry: &Registry) -> anyhow::Result<Plan<Counts>> {
        let scenes = args.scenes.read(&[])?;
        let threads = Threads::new(args.threads.into()).map_err(anyhow::Error::msg)?;
        let settings = CountSettings {
            structures: args.structures.chosen(registry, &[])?,
            guide: sources::guide(registry)?,
            workloads: if args.workload.is_empty() { WORKLOADS.into() } else { args.workload.clone() },
            rays: args.rays,
            seed: args.seed,
            threads: threads.clone(),
            overlap: !args.no_overlap,
        };
        let labels: Vec<&str> = settings.structures.iter().map(|choice| choice.label.as_str()).collect();
        let kinds: Vec<&str> = settings.workloads.iter().map(|kind| kind.name()).collect();
        let kept = Kept {
            structures: labels.join(" "),
            workloads: kinds.join(" "),
            rays: args.rays,
            seed: args.seed,
            overlap: settings.overlap,
        };
        let key =
            |scene: &Scene| format!("{} {}", scene_name(&scene.name, !scene.stand_ins.is_empty()), &scene.hash()[..16]);
        let names: Vec<(String, String)> = scenes.iter().map(|scene| (scene.name.clone(), key(scene))).collect();
        let notes = scenes.iter().flat_map(|scene| scene.notes.iter().map(|note| format!("{}: {note}", scene.name)));
        let notes: Vec<String> = notes.collect();
        let measure: Measure<Counts> =
            Box::new(move |number, _, _, progress| count_scene(&scenes[number], &settings, progress));
        Ok(Plan { notes, inputs: args.scenes.files(), ..Plan::of_scenes(&kept, threads, names, measure) })
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

/// Builds and counts every structure. One that cannot be built, or that panics, is refused; the others go on.
///
/// # Errors
/// If the guide cannot be built.
fn count_scene(scene: &Scene, settings: &CountSettings, progress: &mut dyn FnMut(Stage)) -> Result<Counts, StudyError> {
    let build = |choice: &Choice| settings.threads.install(|| choice.build(&Arc::clone(&scene.mesh)));
    progress(Stage::Rays("all"));
    let guide = build(&settings.guide).map_err(|cause| StudyError::Build {
        structure: settings.guide.label.clone(),
        scene: scene.name.clone(),
        cause,
    })?;
    let sampling = Sampling::some(scene, settings.rays as usize, settings.seed);
    let kinds = settings.workloads.iter().filter(|&&kind| kind != WorkloadKind::Mirror || scene.has_mirrors());
    let mut workloads: Vec<Workload> =
        kinds.map(|&kind| Workload::new(scene, kind, &sampling, guide.as_ref())).collect();
    workloads.retain(|workload| !workload.rays.is_empty());

    let mut counts = Counts::default();
    for choice in &settings.structures {
        progress(Stage::Build(&choice.label));
        let mut refuse = |reason: String| {
            counts.refused.push(Refused { label: choice.label.clone(), scene: scene.name.clone(), reason })
        };
        let accel = match build(choice) {
            Ok(accel) => accel,
            Err(cause) => {
                refuse(cause.to_string());
                continue;
            }
        };
        progress(Stage::Check(&choice.label));
        let asked = workloads.iter().filter(|workload| declined(accel.as_ref(), workload).is_none());
        let rays: Option<Vec<RayMeasures>> =
            asked.map(|workload| guarded(|| of_rays(accel.as_ref(), workload))).collect();
        let Some(rays) = rays else {
            refuse(PANICKED.into());
            continue;
        };
        counts.measures.push(Measures {
            scene: scene.name.clone(),
            triangles: scene.mesh.len(),
            degenerate: scene.mesh.degenerate().len(),
            stand_in: !scene.stand_ins.is_empty(),
            structure: choice.label.clone(),
            triangle_test: choice.triangle_test().into(),
            tree: of_tree(accel.as_ref(), scene, settings.overlap),
            rays,
        });
    }
    Ok(counts)
}

fn of_tree(accel: &dyn DynAccel, scene: &Scene, overlap: bool) -> TreeMeasures {
    let shape = accel.shape();
    let share = |n: usize, of: usize| (of > 0).then(|| n as f64 / of as f64);
    let outline = overlap.then(|| accel.outline()).flatten();
    TreeMeasures {
        inner_nodes: shape.inner,
        leaves: shape.leaves,
        empty_leaves: shape.empty,
        references: shape.references,
        duplication: share(shape.references, scene.mesh.solid().count()),
        mean_leaf: share(shape.references, shape.leaves - shape.empty.min(shape.leaves)),
        largest_leaf: shape.largest_leaf,
        depth: shape.depth,
        sah_cost: shape.sah_cost,
        end_point_overlap: outline.and_then(|outline| end_point_overlap(&outline, &scene.mesh)),
        bytes: accel.footprint().total(),
        leaf_sizes: shape.leaf_sizes,
        leaf_depths: shape.leaf_depths,
    }
}

fn of_rays(accel: &dyn DynAccel, workload: &Workload) -> RayMeasures {
    let counted = Counted::new(accel, &workload.rays, workload.query);
    RayMeasures {
        workload: workload.name.clone(),
        query: workload.query,
        rays: counted.rays,
        hits: counted.hits,
        hit_rate: counted.hit_rate(),
        tests_per_ray: counted.tests_per_ray(),
        steps_per_ray: counted.steps_per_ray(),
        leaf_steps_per_ray: counted.leaf_steps_per_ray(),
        empty_leaf_steps_per_ray: counted.empty_leaf_steps_per_ray(),
        tests_over_minimum: counted.tests_over_minimum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;
    use crate::scene::Builtin;

    #[test]
    fn a_cube_is_counted_as_one_would_by_hand() {
        let registry = Registry::builtin();
        let choose = |spec: &str| registry.choose(spec).unwrap();
        let settings = CountSettings {
            structures: ["brute-force", "median-kd", "obvhs-bvh2", "sah-bvh"].map(choose).into(),
            guide: choose("sah-kd"),
            workloads: vec![WorkloadKind::Primary, WorkloadKind::Mirror],
            rays: 400,
            seed: 1,
            threads: Threads::new(1).unwrap(),
            overlap: true,
        };
        let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
        let Counts { measures, refused, .. } = count_scene(&scene, &settings, &mut |_| ()).unwrap();
        assert_eq!((measures.len(), refused.len()), (4, 0));

        // Twelve triangles are fewer than the report's 100: both are one leaf.
        for one in &measures[..2] {
            assert_eq!((one.tree.inner_nodes, one.tree.leaves, one.tree.references), (0, 1, 12), "{one:?}");
            assert_eq!((one.tree.mean_leaf, one.tree.duplication, one.tree.depth), (Some(12.0), Some(1.0), 0));
            assert_eq!(one.tree.end_point_overlap, Some(0.0));
            assert_eq!(one.tree.leaf_sizes.iter().collect::<Vec<_>>(), [(12, 1)]);
            // The cube casts no mirror rays.
            assert_eq!(one.rays.len(), 1);
            let rays = &one.rays[0];
            assert_eq!(rays.leaf_steps_per_ray.map(|n| n <= 1.0), Some(true));
            let hits = rays.hit_rate * rays.rays as f64;
            assert!(
                (rays.tests_over_minimum.unwrap() * hits - rays.tests_per_ray.unwrap() * rays.rays as f64).abs() < 1e-6
            );
        }
        assert_eq!(measures[0].rays[0].tests_per_ray, Some(12.0));
        // Both triangles of a side have the same box, which holds the other one.
        assert!(measures[2].tree.end_point_overlap.unwrap() > 0.0);
        assert!(measures.iter().all(|one| one.rays[0].hits == measures[0].rays[0].hits));
        assert!(!tables(&measures, &[]).is_empty() && !histogram_tables(&measures).is_empty());
    }
}
