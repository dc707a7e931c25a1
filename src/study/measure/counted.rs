//! Counts the triangle tests and node visits of queries.

use crate::accel::{Counts, DynAccel, Observed, Query};
use crate::geometry::Ray;
use crate::measure::{checksum, spread};
use crate::study::epoch::RayCounts;

/// The maximum number of counted rays of a workload.
const RAYS: usize = 16384;

/// The approximate maximum number of triangle tests for the counted rays of a workload.
const TESTS: u64 = 1 << 24;

const FEW: usize = 512;
const FEWEST: usize = 32;
const FEW_TESTS: u64 = 1 << 20;

/// The number of rays depends on the triangle tests of a pilot, not on time. Every run counts the same rays.
pub fn affordable(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> RayCounts {
    let counted = |count: usize| all(accel, &spread(rays, count), query);
    let pilot = counted(64);
    let affordable = (TESTS * pilot.rays as u64 / pilot.tests.unwrap_or(0).max(1)) as usize;
    if affordable >= RAYS { counted(RAYS) } else { counted(1 << affordable.max(64).ilog2()) }
}

pub fn few(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> RayCounts {
    let counted = |count: usize| all(accel, &spread(rays, count), query);
    let first = counted(FEWEST);
    let affordable = FEW_TESTS * first.rays as u64 / first.tests.unwrap_or(0).max(1);
    if affordable >= FEW as u64 { counted(FEW) } else { first }
}

pub fn all(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> RayCounts {
    let mut counts = Counts::default();
    let distances: Vec<Option<u32>> = match query {
        Query::Closest => {
            let mut hits = vec![None; rays.len()];
            accel.closest_hits_counted(rays, &mut hits, &mut counts);
            // Adding 0 turns -0 into 0, so equal depths have equal bits.
            hits.iter().map(|hit| hit.map(|hit| (hit.t + 0.0).to_bits())).collect()
        }
        Query::Any => {
            let mut hits = vec![false; rays.len()];
            accel.any_hits_counted(rays, &mut hits, &mut counts);
            hits.iter().map(|hit| hit.then_some(0)).collect()
        }
    };
    let counts = observed(&counts, accel.observed());
    let hits = distances.iter().flatten().count();
    let distances = checksum(distances.iter().map(|bits| bits.map_or(u64::MAX, u64::from)));
    RayCounts { rays: rays.len(), hits, distances, ..counts }
}

/// Some trees have no separate leaf nodes. Such a tree counts triangle tests but no leaves.
fn observed(counts: &Counts, Observed { tests, steps }: Observed) -> RayCounts {
    let sees_leaves = steps && (counts.leaves > 0 || counts.tests == 0);
    RayCounts {
        tests: tests.then_some(counts.tests),
        blocks: tests.then_some(counts.blocks),
        steps: steps.then_some(counts.steps()),
        leaves: sees_leaves.then_some(counts.leaves),
        empty_leaves: sees_leaves.then_some(counts.empty_leaves),
        ..RayCounts::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_counted_once_however_many_triangles_it_holds() {
        use crate::accel::Accel;
        use crate::brute_force::BruteForce;
        use crate::kdtree::{KdConfig, KdTree};
        use crate::triangle::MollerTrumbore;
        let scene = crate::builtin::Builtin::find("cube").unwrap().scene(None).unwrap();
        // The twelve triangles are a block of eight and a block of four.
        let ray = Ray::new(glam::Vec3::new(0.01, 0.02, 9.0), glam::Vec3::new(0.0, 0.0, -1.0));
        let brute = BruteForce::<MollerTrumbore>::build(&scene.mesh, &Default::default()).unwrap();
        let counts = all(&brute, &[ray; 3], Query::Closest);
        assert_eq!((counts.tests, counts.blocks), (Some(36), Some(6)));
        let tree = KdTree::<MollerTrumbore>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let counts = all(&tree, &[ray; 3], Query::Closest);
        assert!(counts.blocks > Some(0) && counts.blocks < counts.tests, "{counts:?}");
    }

    #[test]
    fn leaves_are_known_where_they_are_nodes_of_their_own() {
        let leaves = |leaves, tests, seen| {
            observed(&Counts { inner: 30, leaves, empty_leaves: 0, tests, blocks: 20 }, seen).leaves
        };
        assert_eq!((leaves(20, 100, Observed::ALL), leaves(0, 0, Observed::ALL)), (Some(20), Some(0)));
        assert_eq!((leaves(0, 100, Observed::ALL), leaves(20, 100, Observed::TESTS)), (None, None));
    }
}
