//! One sphere at several subdivision levels: the scenes `icosphere:LEVEL`.

use glam::Vec3;

use super::{Camera, Light, Scene, meshes};

/// Segments per edge of the icosahedron, by level. With 1024 segments per edge, structures would exceed the
/// memory of many machines.
const STEPS: [u32; 11] = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 895];

pub const FINEST: u32 = STEPS.len() as u32 - 1;

pub fn triangles(level: u32) -> usize {
    20 * (STEPS[level as usize] as usize).pow(2)
}

/// All levels have the camera and the light of the sphere in the source report.
///
/// # Errors
/// If `parameters` is not a level.
pub fn generate(parameters: &str) -> anyhow::Result<Scene> {
    let level = parameters.parse::<u32>().ok().filter(|level| *level <= FINEST);
    let level = level.ok_or_else(|| anyhow::anyhow!("give a level from 0 to {FINEST}, such as icosphere:5"))?;
    let scene = Scene::framed(&format!("icosphere {level}"), meshes::icosphere(STEPS[level as usize]))?;
    let camera = Camera::new(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 60.0)?;
    let light = Light { position: Vec3::new(2.0, 5.0, 3.0), colour: Vec3::ONE, linear: 0.0, quadratic: 0.0 };
    Ok(Scene { camera, lights: vec![light], ..scene })
}
