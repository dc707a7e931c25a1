//! End-point overlap: the surface that lies in boxes which it does not belong to.

use rayon::prelude::*;

use crate::accel::Outline;
use crate::build::clipped_area;
use crate::geometry::Mesh;
use crate::measure::spread;

/// Triangles that are looked at, at most: of more than so many that have an area these, evenly spread, tell the overlap.
pub const MOST: usize = 1 << 20;

/// The end-point overlap of a tree over `mesh`, in triangle tests: what a ray that ends at a random point of the surface pays for
/// the boxes that hold the point and not its triangle. Each node costs what it costs in
/// [`TreeShape::sah_cost`](crate::accel::TreeShape::sah_cost).
///
/// The sum over all nodes of their cost times the area of the triangles inside of their box, faces included, that are not below
/// them; over the area of all triangles that have one, or of [`MOST`] of them. 0 by construction where nodes are disjoint cells. Nothing
/// where the mesh has no area. Takes some microseconds for each box that a triangle reaches into, on all threads.
///
/// # References
/// Aila, Karras, Laine: On quality metrics of bounding volume hierarchies, 2013.
pub fn end_point_overlap(outline: &Outline, mesh: &Mesh) -> Option<f64> {
    of_some(outline, mesh, MOST)
}

/// That of at most so many triangles.
fn of_some(outline: &Outline, mesh: &Mesh, most: usize) -> Option<f64> {
    let asked = spread(&mesh.solid().collect::<Vec<u32>>(), most);
    let total: f64 = asked.iter().map(|&id| area(mesh, id)).sum();
    if total.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) || !total.is_finite() {
        return None;
    }
    if outline.disjoint {
        return Some(0.0);
    }

    // Where each triangle stands among the references, in order.
    let mut places: Vec<(u32, u32)> = outline.references.iter().copied().zip(0..).collect();
    places.par_sort_unstable();
    let of = |&id: &u32| {
        let start = places.partition_point(|&(other, _)| other < id);
        let own = &places[start..][..places[start..].partition_point(|&(other, _)| other == id)];
        of_triangle(outline, mesh, id, own)
    };
    // Summed in the order of the triangles, whatever the number of threads.
    let overlaps: Vec<f64> = asked.par_iter().map(of).collect();
    Some(overlaps.iter().sum::<f64>() / total)
}

/// The cost of all boxes that triangle `id`, which stands at `places`, reaches into without being below them, times its area there.
fn of_triangle(outline: &Outline, mesh: &Mesh, id: u32, places: &[(u32, u32)]) -> f64 {
    let (corners, bounds) = (mesh.corners(id), mesh.triangle_bounds(id));
    let (mut sum, mut at) = (0.0, 0);
    while let Some(node) = outline.nodes.get(at) {
        if node.bounds.intersection(bounds).is_empty() {
            at = node.end;
            continue;
        }
        let next = places.partition_point(|&(_, place)| (place as usize) < node.first);
        let below = places.get(next).is_some_and(|&(_, place)| (place as usize) < node.last);
        if !below {
            let inside = clipped_area(corners, &node.bounds);
            if inside == 0.0 {
                at = node.end;
                continue;
            }
            sum += node.cost() * inside;
        }
        at += 1;
    }
    sum
}

fn area(mesh: &Mesh, id: u32) -> f64 {
    clipped_area(mesh.corners(id), &mesh.triangle_bounds(id))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::sync::Arc;

    use glam::Vec3;
    use rand_core::{RngCore, SeedableRng};
    use rand_pcg::Pcg32;

    use super::*;
    use crate::accel::{Accel, Part};
    use crate::bvh8::{Bvh8, Bvh8Config, Partition};
    use crate::external::obvhs::{Native, ObvhsBvh2, ObvhsConfig, ObvhsCwBvh};
    use crate::geometry::Aabb;
    use crate::kdtree::{KdConfig, KdTree};
    use crate::triangle::MollerTrumbore;

    /// The definition, box by box.
    fn naive(outline: &Outline, mesh: &Mesh) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for id in mesh.solid() {
            total += area(mesh, id);
        }
        for node in &outline.nodes {
            let below: BTreeSet<u32> = outline.references[node.first..node.last].iter().copied().collect();
            for id in mesh.solid().filter(|id| !below.contains(id)) {
                sum += node.cost() * clipped_area(mesh.corners(id), &node.bounds);
            }
        }
        sum / total
    }

    /// Small triangles at random places.
    fn soup(triangles: u32) -> Arc<Mesh> {
        let mut random = Pcg32::seed_from_u64(5);
        let mut point = || Vec3::from_array(std::array::from_fn(|_| random.next_u32() as f32 / u32::MAX as f32));
        let mut positions = vec![];
        for _ in 0..triangles {
            let place = point() * 4.0;
            positions.extend([place + point(), place + point(), place + point()]);
        }
        let triangles = (0..triangles).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Arc::new(Mesh::new(positions, triangles).unwrap())
    }

    #[test]
    fn a_square_in_the_box_of_its_neighbour_is_overlap() {
        // A diagonal triangle whose box holds half of the square beside it.
        let points =
            [[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [1., 1., 0.], [3., 1., 0.], [1., 2., 0.]].map(Vec3::from_array);
        let mesh = Mesh::new(points.to_vec(), vec![[0, 1, 2], [3, 4, 5]]).unwrap();
        let boxes = [0, 1].map(|id| mesh.triangle_bounds(id));
        let root = (None, boxes[0].union(boxes[1]));
        let outline = Outline::of(Some(root), |leaf, _, references| match leaf {
            Some(id) => {
                references.push(id);
                Part::Leaf
            }
            None => Part::Inner([0, 1].map(|id| (Some(id), boxes[id as usize])).into()),
        });
        // The first, x >= y up to 2, has the area 2; half a unit of it lies in [1, 3] x [1, 2]. Of the second, with the area 1, what
        // has x <= 2 lies in [0, 2]^2: all but a triangle of legs 1 and 0.5.
        let expected = (0.5 + 0.75) / 3.0;
        assert!((end_point_overlap(&outline, &mesh).unwrap() - expected).abs() < 1e-12);
        assert!((naive(&outline, &mesh) - expected).abs() < 1e-12);
    }

    #[test]
    fn the_walk_gives_what_the_definition_gives() {
        let mesh = soup(250);
        let wide = |partition| Bvh8::<MollerTrumbore>::build(&mesh, &Bvh8Config::new(partition)).unwrap().outline();
        let bvh2 = ObvhsBvh2::<Native>::build(&mesh, &ObvhsConfig::default()).unwrap().outline();
        let cwbvh = ObvhsCwBvh::<Native>::build(&mesh, &ObvhsConfig::default()).unwrap().outline();
        let outlines = [wide(Partition::Objects), wide(Partition::Hybrid), bvh2, cwbvh].map(Option::unwrap);
        for outline in &outlines {
            let (fast, slow) = (end_point_overlap(outline, &mesh).unwrap(), naive(outline, &mesh));
            assert!(fast > 0.0 && (fast - slow).abs() <= 1e-12 * slow, "{fast} {slow}");
        }
        // Everything is below the root.
        assert!(outlines.iter().all(|outline| outline.nodes[0].last == outline.references.len()));
    }

    #[test]
    fn some_of_many_triangles_tell_the_overlap_of_all() {
        let mesh = soup(4000);
        let tree = Bvh8::<MollerTrumbore>::build(&mesh, &Bvh8Config::new(Partition::Objects)).unwrap();
        let outline = tree.outline().unwrap();
        let [all, some] = [MOST, 1000].map(|most| of_some(&outline, &mesh, most).unwrap());
        assert_eq!(end_point_overlap(&outline, &mesh), Some(all));
        assert!(some != all && (some / all - 1.0).abs() < 0.1, "{some} in place of {all}");
    }

    #[test]
    fn cells_share_no_surface() {
        let mesh = soup(200);
        let tree = KdTree::<MollerTrumbore>::build(&mesh, &KdConfig::SAH).unwrap();
        assert_eq!(end_point_overlap(&tree.outline().unwrap(), &mesh), Some(0.0));
        // As tight boxes of the cells they share what rounding lets them share.
        let wide = Bvh8::<MollerTrumbore>::build(&mesh, &Bvh8Config::new(Partition::Tight)).unwrap();
        let overlap = end_point_overlap(&wide.outline().unwrap(), &mesh).unwrap();
        let objects = Bvh8::<MollerTrumbore>::build(&mesh, &Bvh8Config::new(Partition::Objects)).unwrap();
        assert!(overlap < 1e-3 * end_point_overlap(&objects.outline().unwrap(), &mesh).unwrap(), "{overlap}");
    }

    #[test]
    fn a_mesh_without_area_has_no_overlap_to_speak_of() {
        let empty = Arc::new(Mesh::new(vec![], vec![]).unwrap());
        let tree = Bvh8::<MollerTrumbore>::build(&empty, &Bvh8Config::default()).unwrap();
        assert_eq!(end_point_overlap(&tree.outline().unwrap(), &empty), None);
        assert_eq!(tree.shape().leaves, 1);
    }

    #[test]
    fn a_triangle_is_cut_to_the_part_in_a_box() {
        let corners = [[0., 0., 0.], [4., 0., 0.], [0., 4., 0.]].map(Vec3::from_array);
        let unit = Aabb { min: Vec3::splat(-1.0), max: Vec3::ONE };
        assert!((clipped_area(corners, &unit) - 1.0).abs() < 1e-12);
        assert_eq!(clipped_area(corners, &Aabb { min: Vec3::splat(3.0), max: Vec3::splat(4.0) }), 0.0);
    }
}
