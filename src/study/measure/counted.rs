//! Counts the work of queries.

use crate::accel::{Counts, DynAccel, Observed, Query};
use crate::geometry::Ray;
use crate::measure::{checksum, spread};
use crate::study::epoch::RayCounts;

/// The counts of one pass of a structure over a batch of rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted {
    /// Rays of the pass.
    pub rays: usize,
    /// Rays that hit.
    pub hits: usize,
    /// See [`RayCounts::distances`].
    pub distances: u64,
    pub counts: Counts,
    pub observed: Observed,
}

/// The maximum number of counted rays of a workload; they are evenly spread.
const RAYS: usize = 16384;

/// Approximate maximum of triangle tests per count: structures with more tests per ray are counted on fewer rays.
const TESTS: u64 = 1 << 24;

/// Rays for estimating the cost of a ray, fewer if they are expensive, and the limit of triangle tests for more.
const FEW: usize = 512;
const FEWEST: usize = 32;
const FEW_TESTS: u64 = 1 << 20;

impl Counted {
    /// Counts over as many evenly spread `rays` as are affordable; the same ones in every run.
    pub fn affordable(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> Self {
        let counted = |count: usize| Self::new(accel, &spread(rays, count), query);
        let pilot = counted(64);
        let affordable = (TESTS * pilot.rays as u64 / pilot.counts.tests.max(1)) as usize;
        if affordable >= RAYS { counted(RAYS) } else { counted(1 << affordable.max(64).ilog2()) }
    }

    /// Counts over a few evenly spread `rays`, which show the cost of a ray at negligible cost.
    pub fn few(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> Self {
        let counted = |count: usize| Self::new(accel, &spread(rays, count), query);
        let first = counted(FEWEST);
        let affordable = FEW_TESTS * first.rays as u64 / first.counts.tests.max(1);
        if affordable >= FEW as u64 { counted(FEW) } else { first }
    }

    /// Traces all `rays` with `query` and counts.
    pub fn new(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> Self {
        let mut counts = Counts::default();
        let distances: Vec<Option<u32>> = match query {
            Query::Closest => {
                let mut hits = vec![None; rays.len()];
                accel.closest_hits_counted(rays, &mut hits, &mut counts);
                // Give `t` = 0 one sign.
                hits.iter().map(|hit| hit.map(|hit| (hit.t + 0.0).to_bits())).collect()
            }
            Query::Any => {
                let mut hits = vec![false; rays.len()];
                accel.any_hits_counted(rays, &mut hits, &mut counts);
                hits.iter().map(|hit| hit.then_some(0)).collect()
            }
        };
        Self {
            rays: rays.len(),
            hits: distances.iter().flatten().count(),
            distances: checksum(distances.iter().map(|bits| bits.map_or(u64::MAX, u64::from))),
            counts,
            observed: accel.observed(),
        }
    }

    /// Whether leaves are observed: in some trees they are not separate nodes. If leaves are counted, every structure
    /// that tests triangles has entered one.
    pub fn sees_leaves(&self) -> bool {
        self.observed.steps && (self.counts.leaves > 0 || self.counts.tests == 0)
    }

    /// The exported counts of the pass.
    pub fn in_export(&self) -> RayCounts {
        let Self { observed, counts, .. } = self;
        RayCounts {
            rays: self.rays,
            hits: self.hits,
            distances: self.distances,
            tests: observed.tests.then_some(counts.tests),
            blocks: observed.tests.then_some(counts.blocks),
            steps: observed.steps.then_some(counts.steps()),
            leaves: self.sees_leaves().then_some(counts.leaves),
            empty_leaves: self.sees_leaves().then_some(counts.empty_leaves),
            whole_tests: None,
        }
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
        // Twelve triangles: a block of eight and a block of four.
        let ray = Ray::new(glam::Vec3::new(0.01, 0.02, 9.0), glam::Vec3::new(0.0, 0.0, -1.0));
        let brute = BruteForce::<MollerTrumbore>::build(&scene.mesh, &Default::default()).unwrap();
        let counts = Counted::new(&brute, &[ray; 3], Query::Closest).counts;
        assert_eq!((counts.tests, counts.blocks), (36, 6));
        let tree = KdTree::<MollerTrumbore>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let counts = Counted::new(&tree, &[ray; 3], Query::Closest).counts;
        assert!(counts.blocks > 0 && counts.blocks < counts.tests, "{counts:?}");
    }

    #[test]
    fn leaves_are_known_where_they_are_nodes_of_their_own() {
        let seen = |leaves, tests, observed| {
            let counts = Counts { inner: 30, leaves, empty_leaves: 0, tests, blocks: 20 };
            Counted { rays: 10, hits: 4, distances: 0, counts, observed }.sees_leaves()
        };
        assert!(seen(20, 100, Observed::ALL) && seen(0, 0, Observed::ALL));
        assert!(!seen(0, 100, Observed::ALL) && !seen(20, 100, Observed::TESTS));
    }
}
