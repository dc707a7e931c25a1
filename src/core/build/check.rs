//! What the tests of all partitions need: meshes, and what every binary tree must keep.

use glam::{DVec3, Vec3};
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

use super::binary_tree::{BinaryTree, Content};
use crate::geometry::{Aabb, Mesh};

pub fn unit(rng: &mut Pcg32) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|_| rng.next_u32() as f32 / u32::MAX as f32 * 2.0 - 1.0))
}

pub fn mesh(count: usize, mut corners: impl FnMut(usize) -> [Vec3; 3]) -> Mesh {
    let positions = (0..count).flat_map(&mut corners).collect();
    Mesh::new(positions, (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()).unwrap()
}

/// What `build` gives must not depend on the number of threads.
pub fn same_on_threads<R: PartialEq + Send>(build: impl Fn() -> R + Sync) {
    let on = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(&build);
    let one = on(1);
    assert!(one == on(2) && one == on(3));
}

/// Triangles of very different sizes.
pub fn soup(count: usize, seed: u64) -> Mesh {
    let mut rng = Pcg32::seed_from_u64(seed);
    mesh(count, |i| {
        let (centre, size) = (unit(&mut rng) * 4.0, if i % 50 == 0 { 3.0 } else { 0.1 });
        std::array::from_fn(|_| centre + unit(&mut rng) * size)
    })
}

/// A room: walls, floor and tables of right-angled triangles in planes of the axes, as buildings have them.
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
    mesh(corners.len(), |i| corners[i])
}

/// The boxes and references of all leaves, after checking what holds for every tree: leaves of at most `most` references.
pub fn leaves(tree: &BinaryTree, most: u32) -> Vec<(Aabb, &[u32])> {
    let mut found = vec![];
    let mut next = 0;
    // What must come next, depth first.
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
    assert!(stack.is_empty(), "every node is there");
    found
}

/// Every point of every triangle lies in a leaf that holds it, as far as points at random tell.
pub fn covers(tree: &BinaryTree, mesh: &Mesh, seed: u64) {
    let mut of = vec![vec![]; mesh.len()];
    for (bounds, ids) in leaves(tree, u32::MAX) {
        ids.iter().for_each(|&id| of[id as usize].push(bounds));
    }
    let mut rng = Pcg32::seed_from_u64(seed);
    for id in mesh.solid() {
        let [p, q, r] = mesh.corners(id).map(Vec3::as_dvec3);
        for _ in 0..20 {
            let (u, v) = (f64::from(rng.next_u32()) / 4294967295.0, f64::from(rng.next_u32()) / 4294967295.0);
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let x: DVec3 = p + (q - p) * u + (r - p) * v;
            let inside = |b: &Aabb| b.min.as_dvec3().cmple(x).all() && b.max.as_dvec3().cmpge(x).all();
            let boxes = &of[id as usize];
            assert!(boxes.iter().any(inside), "{x} of triangle {id} is in none of {boxes:?}");
        }
    }
}

/// No two leaves have a volume in common.
pub fn disjoint(leaves: &[(Aabb, &[u32])]) {
    for (i, (a, _)) in leaves.iter().enumerate() {
        for (b, _) in &leaves[..i] {
            let common = a.intersection(*b);
            assert!(!common.min.cmplt(common.max).all(), "{a:?} and {b:?} have {common:?} in common");
        }
    }
}
