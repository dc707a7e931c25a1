//! The truth about a mesh: exact answers for whole rays. Used to judge answers; never timed.
//!
//! [`Oracle`] is fast, [`nearest`] its slow twin: every triangle in integers.

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
/// Three stages, each of which only passes on what it cannot decide: a tree of boxes that loses no hit, `f64`
/// arithmetic with a proven error bound, integers ([`exact`](crate::exact)). It shares no code with the structures and
/// triangle tests that it judges, but for the integers with [`Exact`](crate::triangle::Exact): both are held against
/// [`rational`](crate::exact::rational) in tests.
pub struct Oracle {
    mesh: Arc<Mesh>,
    tree: tree::Tree,
}

impl Oracle {
    /// Takes some seconds a million triangles.
    pub fn new(mesh: &Arc<Mesh>) -> Self {
        Self { mesh: mesh.clone(), tree: tree::Tree::new(mesh) }
    }

    /// The exact nearest hit of `ray` in its half-open interval, on closed triangles, with all triangles that are hit
    /// there.
    ///
    /// Nothing for a ray that is not valid. A ray in the plane of a triangle misses it.
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
