//! Exact answers for whole rays, to check the answers of structures with; never timed.
//!
//! [`Oracle`] is fast; [`nearest`] is its brute-force reference, which tests every triangle exactly.

mod filter;
mod naive;
mod query;
mod tree;
mod truth;

use std::sync::Arc;

use crate::geometry::{Mesh, Ray};

pub use naive::nearest;
pub use truth::Truth;

/// Answers rays over one mesh exactly: some microseconds a ray.
///
/// It has three stages: a tree of boxes that loses no hit; `f64` arithmetic with a proven error bound; and, for what
/// that cannot decide, exact sums of floats ([`exact`](crate::exact)). It shares no code with the structures and triangle tests
/// that it checks, except those sums with [`Exact`](crate::triangle::Exact). Tests compare both with
/// [`rational`](crate::exact::rational).
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
    /// None for a ray that is not valid. A ray in the plane of a triangle misses it.
    pub fn nearest(&self, ray: &Ray) -> Option<Truth> {
        if !ray.is_valid() {
            return None;
        }
        let mut query = query::Query::new(ray, &self.mesh);
        self.tree.visit(ray, &mut query);
        query.truth()
    }
}

#[cfg(test)]
mod tests;
