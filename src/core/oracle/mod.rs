//! Exact hits of rays, to check the hits of structures. The oracle is never timed.
//!
//! [`Oracle`] is fast; [`nearest`] is its brute-force reference, which tests every triangle exactly.

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
    /// The numbers of all triangles that are hit at `t`, ascending; at least one.
    pub ids: Vec<u32>,
}

impl Truth {
    /// The `f32` nearest to `t`, ties to even.
    pub fn rounded(&self) -> f32 {
        self.t.round()
    }

    /// Whether the primitive of `hit` is one of `ids`. The `t` of `hit` is ignored.
    pub fn names(&self, hit: Hit) -> bool {
        self.ids.binary_search(&hit.prim.index()).is_ok()
    }

    /// The rounded `t` and the lowest triangle number: the hit that an exact triangle test must return.
    pub fn first(&self) -> (f32, u32) {
        (self.rounded(), self.ids[0])
    }
}

/// Finds the exact hits of rays in one mesh, in some microseconds per ray.
///
/// It has three stages: a tree of boxes that loses no hit, `f64` arithmetic with a proven error bound, and exact sums
/// of floats ([`exact`]) if this bound does not decide. The triangle test [`Exact`](crate::triangle::Exact) uses the
/// same sums. Apart from these sums, the structures that the oracle checks share only the types of meshes, rays and
/// boxes with it. Unit tests compare the oracle and `Exact` with `exact::rational`.
pub struct Oracle {
    mesh: Arc<Mesh>,
    tree: tree::Tree,
}

impl Oracle {
    /// Builds the tree: some seconds for a million triangles.
    pub fn new(mesh: &Arc<Mesh>) -> Self {
        Self { mesh: mesh.clone(), tree: tree::Tree::new(mesh) }
    }

    /// The exact nearest hit of `ray` in its half-open interval, with all closed triangles that are hit at this `t`.
    ///
    /// `None` if the ray is invalid or hits nothing. A ray in the plane of a triangle misses this triangle.
    pub fn nearest(&self, ray: &Ray) -> Option<Truth> {
        if !ray.is_valid() {
            return None;
        }
        let mut search = nearest_search::NearestSearch::new(ray, &self.mesh);
        self.tree.visit(ray, ray.end(), |id| search.triangle(id));
        search.truth()
    }
}

/// Like [`Oracle::nearest`], but tests every triangle exactly: for small meshes, and as the reference for [`Oracle`].
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
