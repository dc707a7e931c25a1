//! Moves subtrees of a finished tree to reduce the total area of its nodes.
//!
//! # References
//! Bittner, Hapala, Havran: Fast Insertion-Based Optimization of Bounding Volume Hierarchies, Computer Graphics Forum
//! 2013. Meister, Bittner: Parallel Reinsertion for Bounding Volume Hierarchy Optimization, Computer Graphics Forum
//! 2018.
//!
//! Unlike in the second paper, the moves of a batch are made one after the other. A move that no longer saves area is
//! skipped. The result therefore does not depend on the number of threads. The number of nodes per pass also differs.
//! All passes use the order of the box areas before the first pass.

mod links;
mod search;

use rayon::prelude::*;

use crate::build::binary_tree::BinaryTree;
use links::Links;
use search::Search;

/// Number of nodes in the first batch of a pass. Each later batch has as many nodes as all earlier batches together.
/// Batches can grow because moves of small boxes rarely affect other moves.
const BATCH: usize = 64;

/// The first pass processes this share of all nodes, in descending order of box area. Pass `k` processes the first
/// `1/k` of these nodes.
const SHARE: f64 = 0.4;

/// Leaves keep their boxes and references.
pub(crate) fn reinsert(tree: BinaryTree, passes: u32) -> BinaryTree {
    if tree.nodes.len() < 2 || passes == 0 {
        return tree;
    }
    let mut links = Links::new(&tree);
    let order = largest(&links, ((tree.nodes.len() - 1) as f64 * SHARE) as usize);
    for pass in 1..=passes {
        let looked_at = (order.len() as f64 / f64::from(pass)) as usize;
        let mut done = 0;
        while done < looked_at {
            let end = looked_at.min(done + done.max(BATCH));
            // Search in tree order, because searches from neighbouring nodes read the same cache lines.
            let mut batch: Vec<(u32, usize)> = order[done..end].iter().copied().zip(done..end).collect();
            batch.par_sort_unstable();
            let search = |open: &mut Vec<_>, &(at, rank): &(u32, usize)| {
                Search::best(&links, at, open).map(|target| (rank, at, target))
            };
            let mut moves: Vec<(usize, u32, u32)> =
                batch.par_iter().map_init(Vec::new, search).flatten_iter().collect();
            moves.sort_unstable();
            for (_, at, target) in moves {
                links.relocate(at, target);
            }
            done = end;
        }
    }
    links.write(&tree)
}

/// The `count` largest nodes below the root, in descending order of box area.
fn largest(links: &Links, count: usize) -> Vec<u32> {
    // The ratio of two areas fits an `f32` at any scale of the mesh. For non-negative floats, an integer comparison of
    // the bits gives the same order.
    let whole = Some(links[0].area).filter(|&whole| whole > 0.0).unwrap_or(1.0);
    let key = |at: u32| {
        let share = (links[at].area / whole) as f32;
        u64::from(!share.to_bits()) << 32 | u64::from(at)
    };
    let mut keys: Vec<u64> = (1..links.0.len() as u32).into_par_iter().map(key).collect();
    keys.select_nth_unstable(count);
    keys.truncate(count);
    keys.par_sort_unstable();
    keys.into_iter().map(|key| key as u32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::Quality;
    use crate::build::check::{covers, disjoint, leaves, mesh, room, soup};
    use crate::build::extent::Extent;
    use crate::build::sbvh::{SbvhConfig, Splits, build};
    use glam::Vec3;

    fn area(tree: &BinaryTree) -> f64 {
        tree.nodes.iter().map(|node| Extent::from(node.bounds).half_area()).sum()
    }

    fn binary(mesh: &crate::geometry::Mesh, splits: Splits) -> BinaryTree {
        build(mesh, &SbvhConfig::new(splits, Quality::Balanced))
    }

    #[test]
    fn moves_save_area_and_leave_the_leaves_as_they_were() {
        // Reinsertion may leave the regular mesh `room` unchanged.
        for (mesh, irregular) in [(soup(4000, 21), true), (room(12), false)] {
            for splits in [Splits::Spatial, Splits::SpatialAndObject, Splits::Object] {
                let before = binary(&mesh, splits);
                let after = reinsert(before.clone(), 3);
                let (old, new) = (area(&before), area(&after));
                assert!(if irregular { new < old } else { new <= old }, "{splits:?}: {new} of {old}");
                let sorted = |tree: &BinaryTree| {
                    let mut all: Vec<String> = leaves(tree, 64).iter().map(|leaf| format!("{leaf:?}")).collect();
                    all.sort();
                    all
                };
                assert!(sorted(&after) == sorted(&before));
                covers(&after, &mesh, 22);
                if splits == Splits::Spatial {
                    disjoint(&leaves(&after, 64));
                }
            }
        }
    }

    fn slowly(tree: &BinaryTree, passes: u32) -> BinaryTree {
        let area = |at: u32| Extent::from(tree.nodes[at as usize].bounds).half_area();
        let mut order: Vec<u32> = (1..tree.nodes.len() as u32).collect();
        order.sort_by(|&a, &b| ((area(b) / area(0)) as f32).total_cmp(&((area(a) / area(0)) as f32)).then(a.cmp(&b)));
        order.truncate((order.len() as f64 * SHARE) as usize);
        let mut links = Links::new(tree);
        for pass in 1..=passes {
            let looked_at = (order.len() as f64 / f64::from(pass)) as usize;
            let mut ends = vec![0];
            while ends[ends.len() - 1] < looked_at {
                let last = ends[ends.len() - 1];
                ends.push(looked_at.min(if last == 0 { BATCH } else { 2 * last }));
            }
            for batch in ends.windows(2) {
                let before = links.clone();
                for &at in &order[batch[0]..batch[1]] {
                    if let Some(target) = Search::best(&before, at, &mut vec![]) {
                        links.relocate(at, target);
                    }
                }
            }
        }
        links.write(tree)
    }

    #[test]
    fn parallel_reinsertion_equals_sequential_reinsertion() {
        for splits in [Splits::Spatial, Splits::SpatialAndObject, Splits::Object] {
            for triangles in [3, 30, 300, 3000] {
                let tree = binary(&soup(triangles, 28), splits);
                let (fast, slow) = (reinsert(tree.clone(), 4), slowly(&tree, 4));
                assert!(format!("{fast:?}") == format!("{slow:?}"), "{splits:?}, {triangles} triangles");
                assert!(triangles < 300 || format!("{fast:?}") != format!("{tree:?}"), "at least one node moves");
            }
        }
    }

    #[test]
    fn the_search_finds_what_trying_every_place_finds() {
        let tree = binary(&soup(400, 23), Splits::Object);
        let links = Links::new(&tree);
        let total = |links: &Links| links.0.iter().map(|link| link.area).sum::<f64>();
        let before = total(&links);
        for at in 1..tree.nodes.len() as u32 {
            let gain = |target: u32| {
                let mut moved = links.clone();
                moved.relocate(at, target);
                before - total(&moved)
            };
            let most = (1..tree.nodes.len() as u32).map(gain).fold(0.0, f64::max);
            let found = Search::best(&links, at, &mut vec![]).map_or(0.0, gain);
            assert!((most - found).abs() <= 1e-12 * before, "{at}: {found} instead of {most}");
        }
    }

    #[test]
    fn small_nested_and_coincident_boxes_and_many_passes_make_no_chains_and_lose_nothing() {
        let nested = mesh(20_000, |i| [Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * 0.998f32.powi(i as i32)));
        let coincident = mesh(20_000, |_| [Vec3::X, Vec3::Y, Vec3::Z]);
        assert!(reinsert(BinaryTree::default(), 4).nodes.is_empty());
        let small = (1..40).map(|triangles| (soup(triangles, 26), 50));
        for (mesh, passes) in small.chain([(nested, 4), (coincident, 4)]) {
            let tree = reinsert(binary(&mesh, Splits::Object), passes);
            assert!(Links::new(&tree)[0].height <= links::DEEPEST);
            assert_eq!(tree.references.len(), mesh.solid().count());
            covers(&tree, &mesh, 25);
        }
    }
}
