//! Inputs of several commands: scenes, structures, rays and views.

mod measuring;
mod os_text;
mod ray_kind;
mod rays;
mod runners;
mod scenes;
mod structures;
mod view;

pub use measuring::{Limit, Measuring, Seconds};
pub use ray_kind::RayKind;
pub use rays::{RaySource, Rays, WORKLOADS, WorkloadRequest, each_kind, rays_or_all, recorded, replayed};
pub use runners::{RUNNER_LIMIT, RunnerRequest, runner, runners};
pub use scenes::{SceneRequest, Scenes, named_notes, output, scene, scene_files, scenes, stand_in, words};
pub use structures::{
    ALL, BRUTE_FORCE, QUALITIES, REPORT_TREE, SAH_TREE, StructureRequest, Structures, TWIN, brute_force_note,
    is_external, is_large, is_obvhs, known_defect, known_tests, secondary_ray_structure, specs, structures,
    structures_at, with_twin,
};
pub use view::ViewArgs;

// Headings of option groups in the help text.
pub const SCENES: &str = "Scenes";
pub const STRUCTURES: &str = "Structures";
pub const RAYS: &str = "Rays";
pub const MEASURING: &str = "Measuring";
pub const OUTPUT: &str = "Output";
