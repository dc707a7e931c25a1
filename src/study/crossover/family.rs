use glam::Vec3;

use crate::scene::{Camera, Light, Scene, SceneError, meshes};

/// Square roots of the numbers of layers: 1 to 576 layers.
pub const ROOTS: [u32; 9] = [1, 2, 3, 4, 6, 8, 12, 16, 24];

/// Where the layers face, and two directions across.
const FACING: Vec3 = Vec3::new(2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0);
const ACROSS: Vec3 = Vec3::new(2.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0);
const UPWARD: Vec3 = Vec3::new(-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0);

/// What the member of `root * root` layers is called.
pub fn name(root: u32) -> String {
    let layers = root * root;
    format!("{layers} layer{}", if layers == 1 { "" } else { "s" })
}

/// The member of `root * root` layers, seen from before the first, a little from the side and so narrowly that every primary ray
/// passes all layers. The light is behind the last: shadow rays pass those that primary rays have not passed.
///
/// # Errors
/// None for the roots there are.
///
/// # Panics
/// As [`meshes::sheets`].
pub fn member(root: u32) -> Result<Scene, SceneError> {
    let name = name(root);
    let scene = Scene::framed(&name, meshes::sheets(root))?;
    let camera = Camera::new(FACING * 6.0 + ACROSS * 0.9, Vec3::ZERO, UPWARD, 12.0)
        .map_err(|cause| SceneError::Camera { file: name, cause })?;
    let position = FACING * -6.0 + UPWARD * 0.9;
    let light = Light { position, colour: Vec3::ONE, linear: 0.0, quadratic: 0.0 };
    Ok(Scene { camera, lights: vec![light], ..scene })
}
