//! What is counted, and how.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::end_point_overlap::end_point_overlap;
use crate::accel::{DynAccel, Histogram, Query};
use crate::measure::Threads;
use crate::registry::Choice;
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use crate::study::args::Structures;
use crate::study::bench::check::declined;
use crate::study::bench::counted::{Counted, Events};
use crate::study::{PANICKED, Refused, Stage, StudyError, guarded};

pub(super) struct CountSettings {
    /// The structures, in the order of the tables.
    pub structures: Vec<Choice>,
    /// How they were asked for.
    pub named: Structures,
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

impl CountSettings {
    /// The structures that are counted about `scene`.
    pub fn of(&self, scene: &Scene) -> impl Iterator<Item = &Choice> {
        self.structures.iter().filter(|choice| !self.named.leaves_out(choice, scene.mesh.len()))
    }
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
    /// Branches that the processor predicts wrongly, the one number here that a machine changes; nothing where it does
    /// not count them.
    #[serde(default)]
    pub branch_misses_per_ray: Option<f64>,
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

/// Builds and counts every structure. One that cannot be built, or that panics, is refused; the others go on.
pub(super) fn count_scene(
    scene: &Scene,
    settings: &CountSettings,
    progress: &mut dyn FnMut(Stage),
) -> Result<Counts, StudyError> {
    let build = |choice: &Choice| settings.threads.install(|| choice.build(&Arc::clone(&scene.mesh)));
    progress(Stage::Build(&settings.guide.label));
    let guide = build(&settings.guide).map_err(StudyError::of_build(&settings.guide.label, &scene.name))?;
    progress(Stage::Rays("all"));
    let sampling = Sampling::some(scene, settings.rays as usize, settings.seed);
    let kinds = settings.workloads.iter().filter(|&&kind| kind != WorkloadKind::Mirror || scene.has_mirrors());
    let mut workloads: Vec<Workload> =
        kinds.map(|&kind| Workload::new(scene, kind, &sampling, guide.as_ref())).collect();
    workloads.retain(|workload| !workload.rays.is_empty());

    let mut counts = Counts::default();
    for choice in settings.of(scene) {
        progress(Stage::Build(&choice.label));
        let mut refuse = |reason: String| {
            let (label, scene) = (choice.label.clone(), scene.name.clone());
            counts.refused.push(Refused { label, scene, reason, wrong: false });
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
        branch_misses_per_ray: Events::of_thread().per_ray(accel, &workload.rays, workload.query).branch_misses,
    }
}
