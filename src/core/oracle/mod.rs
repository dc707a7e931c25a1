//! Exact hits of rays, to check the hits of structures. The oracle shares only the module `exact` and the types of
//! meshes, rays and boxes with the structures.

mod filter;
mod nearest_search;
mod outcome;
mod tree;

use std::cmp::Ordering;
use std::sync::Arc;

use crate::exact::{self, ExactT};
use crate::geometry::{Hit, Mesh, Ray};

pub use outcome::{DepthRule, Outcome, outcome, ulp};

/// The exact nearest hit of a ray.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Truth {
    /// The exact `t`.
    pub t: ExactT,
    /// The triangle numbers of all hits at `t`, in ascending order. The list is not empty.
    pub ids: Vec<u32>,
}

impl Truth {
    /// The `f32` nearest to `t`, ties to even.
    pub fn rounded(&self) -> f32 {
        self.t.round()
    }

    /// Whether the primitive of `hit` is one of `ids`.
    pub fn names(&self, hit: Hit) -> bool {
        self.ids.binary_search(&hit.prim.index()).is_ok()
    }

    /// The rounded `t` and the lowest triangle number.
    pub fn first(&self) -> (f32, u32) {
        (self.rounded(), self.ids[0])
    }
}

/// Finds the exact hits of rays in one mesh.
pub struct Oracle {
    mesh: Arc<Mesh>,
    tree: tree::Tree,
}

impl Oracle {
    /// Builds a bounding volume hierarchy over the triangles of `mesh`.
    pub fn new(mesh: &Arc<Mesh>) -> Self {
        Self { mesh: mesh.clone(), tree: tree::Tree::new(mesh) }
    }

    /// The exact nearest hit of `ray` in its half-open interval.
    ///
    /// The result is `None` if the ray is invalid or hits no triangle. Edges and corners are parts of a triangle. A ray
    /// in the plane of a triangle misses this triangle.
    pub fn nearest(&self, ray: &Ray) -> Option<Truth> {
        if !ray.is_valid() {
            return None;
        }
        let mut search = nearest_search::NearestSearch::new(ray, &self.mesh);
        self.tree.visit(ray, ray.end(), |id| search.triangle(id));
        search.truth()
    }
}

/// The exact nearest hit of `ray`, by an exact test of every triangle.
pub fn nearest(ray: &Ray, mesh: &Mesh) -> Option<Truth> {
    if !ray.is_valid() {
        return None;
    }
    let mut nearest: Option<Truth> = None;
    for id in mesh.solid() {
        let Some(t) = exact::hit(ray, mesh.corners(id)).filter(|t| t.is_within(ray)) else { continue };
        match nearest.as_mut().map(|best| (t.cmp(&best.t), best)) {
            Some((Ordering::Greater, _)) => {}
            Some((Ordering::Equal, best)) => best.ids.push(id),
            Some((Ordering::Less, _)) | None => nearest = Some(Truth { t, ids: vec![id] }),
        }
    }
    nearest
}

#[cfg(test)]
mod tests;
