//! From a skin to a model that fills a given box exactly.

use glam::{DVec3, Vec3};

use super::Skin;
use crate::{geometry::Aabb, scene::Model};

impl Skin {
    /// This skin, scaled and moved along each axis so that its box is `bounds` to the last bit.
    pub fn into_model(self, bounds: Aabb) -> Model {
        let mut model = self.into_bare_model();
        fit(&mut model.positions, &mut model.normals, bounds);
        model
    }

    /// This skin where it is.
    pub fn into_bare_model(self) -> Model {
        let Self { positions, triangles, normals } = self;
        Model { positions, normal_indices: triangles.clone(), triangles, normals, ..Model::default() }
    }
}

/// Maps the box of `positions` onto `bounds`, and turns unit `normals` with it.
pub fn fit(positions: &mut [Vec3], normals: &mut [Vec3], bounds: Aabb) {
    let from = Aabb::of_points(positions.iter().copied());
    let (low, high) = (from.min.as_dvec3(), from.max.as_dvec3());
    let (to_low, to_high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let scale = (to_high - to_low) / (high - low);
    for p in positions {
        let share = (p.as_dvec3() - low) / (high - low);
        let mapped: DVec3 = to_low * (1.0 - share) + to_high * share;
        *p = mapped.as_vec3().clamp(bounds.min, bounds.max);
    }
    for n in normals {
        *n = (n.as_dvec3() / scale).normalize_or(DVec3::Y).as_vec3();
    }
}
