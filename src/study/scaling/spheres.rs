use std::ops::RangeInclusive;

use glam::Vec3;

use crate::scene::{Camera, Light, Scene, SceneError, meshes};

/// Subdivisions of the icospheres: 20 to 1,310,720 triangles.
pub const LEVELS: RangeInclusive<u32> = 0..=8;

/// What the icosphere of a level is called.
pub fn name(level: u32) -> String {
    format!("icosphere {level}")
}

/// The icosphere of a level before the camera and the light of the report's sphere: of all levels the same view.
///
/// # Errors
/// None for the levels there are.
///
/// # Panics
/// As [`meshes::icosphere`].
pub fn sphere(level: u32) -> Result<Scene, SceneError> {
    let name = name(level);
    let scene = Scene::framed(&name, meshes::icosphere(level))?;
    let camera = Camera::new(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 60.0)
        .map_err(|cause| SceneError::Camera { file: name, cause })?;
    let light = Light { position: Vec3::new(2.0, 5.0, 3.0), colour: Vec3::ONE, linear: 0.0, quadratic: 0.0 };
    Ok(Scene { camera, lights: vec![light], ..scene })
}
