use crate::scene::{Scene, SceneError, meshes};

/// Square roots of the numbers of layers: 1 to 576 layers.
pub const ROOTS: [u32; 9] = [1, 2, 3, 4, 6, 8, 12, 16, 24];

/// The member of `root * root` layers.
///
/// # Errors
/// None for the roots there are.
///
/// # Panics
/// As [`meshes::sheets`].
pub fn member(root: u32) -> Result<Scene, SceneError> {
    let layers = root * root;
    Scene::framed(&format!("{layers} layer{}", if layers == 1 { "" } else { "s" }), meshes::sheets(root))
}
