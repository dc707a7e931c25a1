//! Scenes and structures that the benches share.

use std::sync::Arc;

use sahara::builtin::Builtin;
use sahara::geometry::Mesh;
use sahara::registry::{Choice, Registry};
use sahara::scene::{Scene, WorkloadKind};

pub const KINDS: [WorkloadKind; 4] =
    [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse, WorkloadKind::Random];

/// Scenes of the function `slices` in `benches/traverse.rs`.
pub const SLICED: [&str; 2] = ["dragon", "lucy"];
pub const BATCHES: [&str; 2] = ["single", "packets"];

pub fn scenes() -> Vec<Scene> {
    ["sphere", "teapot", "dragon", "lucy", "sponza"].map(scene).into()
}

/// A built-in scene with generated meshes.
pub fn scene(name: &str) -> Scene {
    Builtin::find(name).and_then(|builtin| builtin.scene(None)).expect("built-in scenes are valid")
}

/// Prints the minimum duration of a bench target.
pub fn announce(target: &str, scenes: &[Scene]) {
    // Unlike `cargo test`, `cargo bench` passes the argument `--bench`.
    let mut arguments = std::env::args().skip(1);
    if arguments.next().as_deref() != Some("--bench") || arguments.next().is_some() {
        return;
    }
    let structures: usize = scenes.iter().map(|scene| structures(&scene.mesh).len()).sum();
    let slices = SLICED.len() * BATCHES.len() * KINDS.len();
    // Criterion needs at least eight seconds per benchmark.
    let minutes = |benches: usize| (8 * benches).div_ceil(60);
    let [build, traverse] = [structures, structures * KINDS.len() + slices].map(minutes);
    let own = if target == "build" { build } else { traverse };
    eprintln!(
        "{target}: at least {own} minutes; all benches, with kernels and load: more than {}. This takes two:\n    \
         cargo bench --bench traverse -- traverse/dragon/primary\n",
        build + traverse
    );
}

pub fn structures(mesh: &Arc<Mesh>) -> Vec<Choice> {
    let registry = Registry::builtin();
    let names = registry.names().into_iter().filter(|&name| name != "brute-force" || mesh.len() < 10_000);
    let choices = names.map(|name| registry.choose(name).expect("a registered name"));
    choices.filter(|choice| choice.entry.absence().is_none()).collect()
}
