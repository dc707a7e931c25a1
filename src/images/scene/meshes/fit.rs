//! Scales meshes to fill a given box exactly.

use glam::DVec3;

use crate::geometry::Aabb;
use crate::scene::Model;

/// The bounding box of the scaled model equals `bounds` exactly. Each corner gets the normal of its vertex.
pub fn fit(model: &mut Model, bounds: Aabb) {
    let from = Aabb::of_points(model.positions.iter().copied());
    let (low, high) = (from.min.as_dvec3(), from.max.as_dvec3());
    for p in &mut model.positions {
        *p = map_box(p.as_dvec3(), [low, high], bounds).as_vec3().clamp(bounds.min, bounds.max);
    }
    let scale = (bounds.max.as_dvec3() - bounds.min.as_dvec3()) / (high - low);
    for n in &mut model.normals {
        *n = (n.as_dvec3() / scale).normalize_or(DVec3::Y).as_vec3();
    }
    model.normal_indices = model.triangles.clone();
}

pub fn map_box(p: DVec3, [low, high]: [DVec3; 2], bounds: Aabb) -> DVec3 {
    let share = (p - low) / (high - low);
    bounds.min.as_dvec3() * (1.0 - share) + bounds.max.as_dvec3() * share
}
