//! Makes a scene around a bare mesh.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::{Camera, CameraError, CornerNormals, Light, Material, Model, Offset, Scene, SceneError};
use crate::geometry::{Aabb, Mesh, Transform};

/// The field of view of a camera outside the mesh, in degrees.
const VERTICAL_FOV: f32 = 40.0;

/// The field of view of a camera inside the mesh, in degrees.
const INSIDE_FOV: f32 = 75.0;

/// The direction from the mesh to the camera: to the right and a little up.
const TOWARDS_CAMERA: DVec3 = DVec3::new(0.5, 0.35, 1.0);

/// The largest fraction of the image's width or height that the box of the mesh fills.
const FILLED: f64 = 0.95;

impl Scene {
    /// A scene called `name` around `model`. Its up direction is y, its camera sees the whole box of the mesh, and it
    /// has one light. A model without materials is grey.
    ///
    /// The shadow terminator fix is off, because it depends on the unit of length.
    ///
    /// # Errors
    /// If the model is not a valid mesh, or if `f32` cannot represent the camera and the light.
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

    /// The same scene with its camera in the middle of the scene's box. The camera looks along the longer horizontal
    /// axis of the box. In a [framed](Scene::framed) scene, the light moves into the box as well.
    ///
    /// # Errors
    /// If the mesh is empty or has no extent along this axis, or if `f32` cannot represent the camera.
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

/// A camera that sees all eight corners of `bounds`, and a light to the right of the camera and above it; `None` if
/// `f32` cannot represent them.
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
    // If the box is a single point, use a distance in proportion to its coordinates.
    let distance = corners.map(fits).fold(f64::from(f32::MIN_POSITIVE), f64::max);
    let distance = if max == min { centre.abs().max_element().max(1.0) } else { distance };

    let eye = centre + towards * distance;
    let light = centre + (towards + up * 0.8 + right * 0.4) * distance;
    let camera = Camera::new(eye.as_vec3(), centre.as_vec3(), Vec3::Y, VERTICAL_FOV).ok()?;
    let light = Light { position: light.as_vec3(), colour: Vec3::ONE, linear: 0.0, quadratic: 0.0 };
    light.position.is_finite().then_some((camera, light))
}
