//! The truth about a mesh: exact answers for whole rays. Used to adjudicate, where two answers differ; never timed.

use std::cmp::Ordering;

use crate::exact::{ExactT, hit};
use crate::geometry::{Mesh, Ray};

/// The nearest hit of `ray` within its interval, and the numbers of all triangles that are hit there, ascending.
///
/// Tests every triangle: for small meshes.
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

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn the_nearest_names_all_triangles_at_its_t() {
        let points = vec![
            Vec3::ZERO,
            Vec3::X,
            Vec3::Y,
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::new(0.0, 0.0, -1.0),
            Vec3::new(5.0, 0.0, -1.0),
            Vec3::new(0.0, 5.0, -1.0),
        ];
        let mesh = Mesh::new(points, vec![[4, 5, 6], [0, 1, 2], [0, 0, 1], [1, 2, 3]]).unwrap();
        let ray = Ray::new(Vec3::new(0.5, 0.5, 1.0), Vec3::NEG_Z);
        let (t, ids) = nearest(&ray, &mesh).unwrap();
        assert_eq!((t.round(), ids), (1.0, vec![1, 3]));
        assert_eq!(nearest(&ray.until(1.0), &mesh), None);
        assert_eq!(nearest(&ray.until(f32::NAN), &mesh), None);
    }
}
