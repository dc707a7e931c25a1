//! Scenes and structures by name, shared by the benches.

use std::sync::Arc;

use sahara::geometry::Mesh;
use sahara::registry::{Choice, Registry};
use sahara::scene::{Builtin, Scene};

/// Two easy scenes and the three hard ones, with their procedural meshes.
pub fn scenes() -> Vec<Scene> {
    ["sphere", "teapot", "dragon", "lucy", "sponza"].map(scene).into()
}

/// A built-in scene with its procedural mesh.
pub fn scene(name: &str) -> Scene {
    Builtin::find(name).and_then(|builtin| builtin.scene(None)).expect("a built-in scene is whole")
}

/// Every structure over its first triangle test. Brute force only if it finishes within seconds.
pub fn structures(mesh: &Arc<Mesh>) -> Vec<Choice> {
    let registry = Registry::builtin();
    let names = registry.names().into_iter().filter(|&name| name != "brute-force" || mesh.len() < 10_000);
    names.map(|name| registry.choose(name).expect("a registered name")).collect()
}
