//! Surface materials.

use glam::Vec3;

/// A Phong material. Colours are linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub name: String,
    /// `Ka`: ambient factor, multiplied by `diffuse`.
    pub ambient: Vec3,
    /// `Kd`: Lambert reflection.
    pub diffuse: Vec3,
    /// `Ks`: Blinn-Phong highlight.
    pub specular: Vec3,
    /// `Ns`: exponent of the highlight.
    pub shininess: f32,
    /// `r`: weight of the mirror ray, 0 to 1.
    pub mirror: f32,
}

impl Material {
    /// A light grey material.
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ambient: Vec3::splat(0.15),
            diffuse: Vec3::splat(0.75),
            specular: Vec3::splat(0.1),
            shininess: 20.0,
            mirror: 0.0,
        }
    }
}
