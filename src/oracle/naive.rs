use std::cmp::Ordering;

use crate::exact::{ExactT, hit};
use crate::geometry::{Mesh, Ray};

/// The nearest hit of `ray` within its interval, and the numbers of all triangles that are hit there, ascending.
///
/// Tests every triangle exactly: for small meshes, and as the reference for [`Oracle`](super::Oracle).
pub fn nearest(ray: &Ray, mesh: &Mesh) -> Option<(ExactT, Vec<u32>)> {
    if !ray.is_valid() {
        return None;
    }
    let mut nearest: Option<(ExactT, Vec<u32>)> = None;
    for id in mesh.solid() {
        let Some(t) = hit(ray, mesh.corners(id)).filter(|t| t.is_within(ray)) else { continue };
        match nearest.as_mut().map(|(best, ids)| (t.cmp(best), ids)) {
            Some((Ordering::Greater, _)) => {}
            Some((Ordering::Equal, ids)) => ids.push(id),
            Some((Ordering::Less, _)) | None => nearest = Some((t, vec![id])),
        }
    }
    nearest
}
