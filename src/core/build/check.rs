//! Meshes and checks for the tests of the tree builders.

use std::fmt::Debug;

use glam::{DVec3, Vec3};
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

use super::binary_tree::{BinaryTree, Content};
use crate::geometry::{Aabb, Mesh};

pub fn unit(rng: &mut Pcg32) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|_| rng.next_u32() as f32 / u32::MAX as f32 * 2.0 - 1.0))
}

pub fn mesh(count: usize, corners: impl FnMut(usize) -> [Vec3; 3]) -> Mesh {
    let triangles: Vec<[Vec3; 3]> = (0..count).map(corners).collect();
    Mesh::from_triangles(&triangles).unwrap()
}

pub fn same_on_threads<R: Debug>(build: impl Fn() -> R + Sync) {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| format!("{:?}", build()))
    };
    let one = on(1);
    assert!(one == on(2) && one == on(3));
}

/// Triangles of very different sizes.
pub fn soup(count: usize, seed: u64) -> Mesh {
    mixed(count, seed, 50, 0.1)
}

/// Like [`soup`], with more large triangles.
pub fn straddling_soup(count: usize, seed: u64) -> Mesh {
    mixed(count, seed, 10, 0.2)
}

/// Triangles whose index is a multiple of `every` are large.
fn mixed(count: usize, seed: u64, every: usize, small: f32) -> Mesh {
    let mut rng = Pcg32::seed_from_u64(seed);
    mesh(count, |i| {
        let (centre, size) = (unit(&mut rng) * 4.0, if i.is_multiple_of(every) { 3.0 } else { small });
        std::array::from_fn(|_| centre + unit(&mut rng) * size)
    })
}

/// A plane near the origin cuts almost all needles.
pub fn needles(count: usize, seed: u64) -> Mesh {
    let mut rng = Pcg32::seed_from_u64(seed);
    mesh(count, |_| {
        let d = unit(&mut rng) * 10.0;
        [d, -d, -d + unit(&mut rng) * 1e-3]
    })
}

/// Axis-aligned walls of right triangles.
pub fn room(cells: usize) -> Mesh {
    let mut corners = vec![];
    for axis in 0..3 {
        for plane in [0.0, 1.0, 4.0, 5.0] {
            for (i, j) in (0..cells * cells).map(|k| (k / cells, k % cells)) {
                let at = |u: usize, v: usize| {
                    let mut p = Vec3::splat(plane);
                    p[(axis + 1) % 3] = u as f32 * 5.0 / cells as f32;
                    p[(axis + 2) % 3] = v as f32 * 5.0 / cells as f32;
                    p
                };
                corners.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                corners.push([at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]);
            }
        }
    }
    Mesh::from_triangles(&corners).unwrap()
}

pub fn point_in(rng: &mut Pcg32, corners: [Vec3; 3]) -> DVec3 {
    let [p, q, r] = corners.map(Vec3::as_dvec3);
    let (u, v) = (f64::from(rng.next_u32()) / 4294967295.0, f64::from(rng.next_u32()) / 4294967295.0);
    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
    p + (q - p) * u + (r - p) * v
}

pub fn holds(bounds: &Aabb, point: DVec3) -> bool {
    bounds.min.as_dvec3().cmple(point).all() && bounds.max.as_dvec3().cmpge(point).all()
}

/// Returns the boxes and references of all leaves. Checks the invariants of the tree. A leaf may have at most `most`
/// references.
pub fn leaves(tree: &BinaryTree, most: u32) -> Vec<(Aabb, &[u32])> {
    let mut found = vec![];
    let mut next = 0;
    // The pending nodes in depth-first order. The next node is on top.
    let mut stack = if tree.nodes.is_empty() { vec![] } else { vec![0] };
    for (at, node) in tree.nodes.iter().enumerate() {
        assert_eq!(stack.pop(), Some(at as u32), "nodes are in depth-first order");
        assert!(!node.bounds.is_empty());
        match node.content {
            Content::Inner([left, right]) => {
                stack.extend([right, left]);
                for child in [left, right] {
                    assert!(node.bounds.contains(&tree.nodes[child as usize].bounds));
                }
            }
            Content::Leaf { first, count } => {
                assert_eq!(first, next, "leaves take the references in order");
                next += count;
                assert!((1..=most).contains(&count), "{count}");
                found.push((node.bounds, &tree.references[first as usize..next as usize]));
            }
        }
    }
    assert_eq!(next as usize, tree.references.len());
    assert!(stack.is_empty(), "every child is a node of the tree");
    found
}

/// Each random point of a triangle must lie in a leaf with a reference to the triangle.
pub fn covers(tree: &BinaryTree, mesh: &Mesh, seed: u64) {
    let mut of = vec![vec![]; mesh.len()];
    for (bounds, ids) in leaves(tree, u32::MAX) {
        ids.iter().for_each(|&id| of[id as usize].push(bounds));
    }
    let mut rng = Pcg32::seed_from_u64(seed);
    for id in mesh.solid() {
        for _ in 0..20 {
            let x = point_in(&mut rng, mesh.corners(id));
            let boxes = &of[id as usize];
            assert!(boxes.iter().any(|b| holds(b, x)), "{x} of triangle {id} is in none of {boxes:?}");
        }
    }
}

/// Checks that no two leaf boxes have common volume.
pub fn disjoint(leaves: &[(Aabb, &[u32])]) {
    for (i, (a, _)) in leaves.iter().enumerate() {
        for (b, _) in &leaves[..i] {
            let common = a.intersection(*b);
            assert!(!common.min.cmplt(common.max).all(), "{a:?} and {b:?} have {common:?} in common");
        }
    }
}
