//! Chooses a camera and a light for a mesh.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::{Camera, CameraError, CornerNormals, Light, Material, Model, Offset, Scene, SceneError};
use crate::geometry::{Aabb, Mesh, Transform};

/// The field of view of a camera outside the mesh, in degrees.
const VERTICAL_FOV: f32 = 40.0;

/// The field of view of a camera inside the mesh, in degrees.
const INSIDE_FOV: f32 = 75.0;

const TOWARDS_CAMERA: DVec3 = DVec3::new(0.5, 0.35, 1.0);

/// The box of the mesh fills at most this fraction of the image's width and height.
const FILLED: f64 = 0.95;

impl Scene {
    /// Makes a scene from `model`, with a camera and one light. The camera sees the whole box of the mesh. The up
    /// direction is y.
    ///
    /// # Errors
    /// If the model is not a valid mesh, or if `f32` cannot represent the camera or the light.
    pub fn framed(name: &str, model: Model) -> Result<Self, SceneError> {
        let mesh = Mesh::new(model.positions, model.triangles)
            .map_err(|cause| SceneError::Mesh { file: name.into(), cause })?;
        let bounds = if mesh.is_empty() { Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE } } else { mesh.bounds() };
        let (camera, light) =
            place(bounds).ok_or_else(|| SceneError::Extent { file: name.into(), min: bounds.min, max: bounds.max })?;

        let mut materials = model.materials;
        if materials.is_empty() {
            materials.push(Material::named("grey"));
        }
        let mut material_of = model.material_of;
        material_of.resize(mesh.len(), 0);
        let normals = (!model.normal_indices.is_empty()).then(|| {
            let unit = model.normals.iter().map(|&n| Transform::IDENTITY.normal(n)).collect();
            CornerNormals::new(unit, model.normal_indices)
        });
        Ok(Self {
            name: name.into(),
            normals,
            materials,
            material_of,
            lights: vec![light],
            camera,
            background: Vec3::new(0.2, 0.25, 0.3),
            recursion_limit: 8,
            // The formula of the fix depends on the unit of length.
            shadow_terminator_fix: false,
            offset: Offset::ErrorBounded,
            size: [512, 512],
            is_framed: true,
            stand_ins: Vec::new(),
            notes: model.notes,
            warnings: vec![],
            mesh: Arc::new(mesh),
        })
    }

    /// Moves the camera to the middle of the scene's box. The camera looks along the longer horizontal axis of the box.
    /// The light of a [framed](Scene::framed) scene moves into the box.
    ///
    /// # Errors
    /// If the mesh is empty or has no horizontal extent, or if `f32` cannot represent the camera.
    pub fn from_inside(mut self) -> Result<Self, CameraError> {
        let bounds = if self.mesh.is_empty() { return Err(CameraError::NoDirection) } else { self.mesh.bounds() };
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let (middle, extent) = ((min + max) / 2.0, max - min);
        let up = self.camera.up();
        let level = DVec3::AXES.into_iter().filter(|axis| axis.dot(up.as_dvec3().normalize()).abs() < 0.9);
        let along = level.max_by(|a, b| extent.dot(*a).total_cmp(&extent.dot(*b))).expect("two axes are not up");
        let target = middle + along * extent.dot(along) / 2.0;
        self.camera = Camera::new(middle.as_vec3(), target.as_vec3(), up, INSIDE_FOV)?;
        if self.is_framed {
            let above = DVec3::Y * extent.y * 0.3;
            self.lights.iter_mut().for_each(|light| light.position = (middle + above).as_vec3());
        }
        Ok(self)
    }
}

fn place(bounds: Aabb) -> Option<(Camera, Light)> {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let centre = (min + max) / 2.0;
    let towards = TOWARDS_CAMERA.normalize();
    let right = DVec3::Y.cross(towards).normalize();
    let up = towards.cross(right);
    let reach = libm::tan(f64::from(VERTICAL_FOV).to_radians() / 2.0) * FILLED;

    let fits = |corner: DVec3| corner.dot(right).abs().max(corner.dot(up).abs()) / reach + corner.dot(towards);
    let sign = |i: u32| if i == 0 { -0.5 } else { 0.5 };
    let corners = (0..8).map(|i| (max - min) * DVec3::new(sign(i & 1), sign(i & 2), sign(i & 4)));
    let distance = corners.map(fits).fold(f64::from(f32::MIN_POSITIVE), f64::max);
    // A box that is a single point has no extent: the distance depends on the coordinates.
    let distance = if max == min { centre.abs().max_element().max(1.0) } else { distance };

    let eye = centre + towards * distance;
    let light = centre + (towards + up * 0.8 + right * 0.4) * distance;
    let camera = Camera::new(eye.as_vec3(), centre.as_vec3(), Vec3::Y, VERTICAL_FOV).ok()?;
    let light = Light { position: light.as_vec3(), colour: Vec3::ONE, linear: 0.0, quadratic: 0.0 };
    light.position.is_finite().then_some((camera, light))
}
