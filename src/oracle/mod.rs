//! Exact hits of rays, to check the hits of structures; never timed.
//!
//! [`Oracle`] is fast; [`nearest`] is its brute-force reference, which tests every triangle exactly.

mod filter;
mod naive;
mod nearest_search;
mod tree;
mod truth;

use std::sync::Arc;

use crate::geometry::{Mesh, Ray};

pub use naive::nearest;
pub use truth::Truth;

/// Finds the exact hits of rays in one mesh, in some microseconds per ray.
///
/// It has three stages: a tree of boxes that loses no hit, `f64` arithmetic with a proven error bound, and exact sums
/// of floats ([`exact`](crate::exact)) if that bound does not decide. It shares these sums with the triangle test
/// [`Exact`](crate::triangle::Exact), and no other code with the structures and tests that it checks. The tests compare
/// both with `exact::rational`.
pub struct Oracle {
    mesh: Arc<Mesh>,
    tree: tree::Tree,
}

impl Oracle {
    /// Builds the tree: some seconds for a million triangles.
    pub fn new(mesh: &Arc<Mesh>) -> Self {
        Self { mesh: mesh.clone(), tree: tree::Tree::new(mesh) }
    }

    /// The exact nearest hit of `ray` in its half-open interval, on closed triangles, with all triangles that are hit
    /// there.
    ///
    /// `None` for a ray that is not valid. A ray in the plane of a triangle misses it.
    pub fn nearest(&self, ray: &Ray) -> Option<Truth> {
        if !ray.is_valid() {
            return None;
        }
        let mut search = nearest_search::NearestSearch::new(ray, &self.mesh);
        self.tree.visit(ray, &mut search);
        search.truth()
    }
}

#[cfg(test)]
mod tests;
