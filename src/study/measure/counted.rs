//! What answers cost, counted.

use rayon::prelude::*;

use super::built::Built;

use super::guarded::guarded;
use super::pair::Pair;
use crate::accel::{Counts, DynAccel, Observed, Query};
use crate::geometry::Ray;
use crate::measure::{EventCounter, checksum, spread};
use crate::scene::Workload;
use crate::study::epoch::RayCounts;

/// Of one pass of a structure over a batch of rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted {
    /// Rays of the pass.
    pub rays: usize,
    /// Those that hit.
    pub hits: usize,
    /// Of the distances of all hits, bit by bit, and of where there is none: the same for all structures over the exact
    /// triangle test.
    pub distances: u64,
    pub counts: Counts,
    pub observed: Observed,
}

/// Rays of a workload that are counted, at most; spread evenly.
const RAYS: usize = 16384;

/// Triangle tests that a count may take, about: structures that test more for each ray are counted on fewer.
const TESTS: u64 = 1 << 24;

/// Rays that tell what a ray costs, those where triangle tests are many, and the tests that the former may take.
const FEW: usize = 512;
const FEWEST: usize = 32;
const FEW_TESTS: u64 = 1 << 20;

/// Counts, for each pair, what `count` chooses of its rays, on all threads; nothing where the structure could not be
/// built or panics.
pub fn count_all(
    pairs: &[Pair],
    built: &[Option<Built>],
    workloads: &[Workload],
    count: fn(&dyn DynAccel, &[Ray], Query) -> Counted,
) -> Vec<Option<Counted>> {
    let of = |pair: &Pair| {
        let (built, workload) = (built[pair.structure].as_ref()?, &workloads[pair.workload]);
        guarded(|| count(built.accel.as_ref(), &workload.rays, workload.query))
    };
    pairs.par_iter().map(of).collect()
}

/// The processor's counters of events, those that it has.
pub struct Events {
    instructions: Option<EventCounter>,
    branch_misses: Option<EventCounter>,
}

/// Means of a pass in which no observer takes part; nothing where there is no counter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EventsPerRay {
    pub instructions: Option<f64>,
    pub branch_misses: Option<f64>,
}

impl Events {
    /// Of this thread.
    pub fn of_thread() -> Self {
        Self { instructions: EventCounter::instructions(), branch_misses: EventCounter::branch_misses() }
    }

    /// Counts while `accel` answers all `rays`.
    pub fn per_ray(&mut self, accel: &dyn DynAccel, rays: &[Ray], query: Query) -> EventsPerRay {
        let (mut hits, mut any) = (vec![None; rays.len()], vec![false; rays.len()]);
        let mut pass = || match query {
            Query::Closest => accel.closest_hits(rays, &mut hits),
            Query::Any => accel.any_hits(rays, &mut any),
        };
        let per_ray = |events: u64| events as f64 / rays.len() as f64;
        let instructions = self.instructions.as_mut().and_then(|counter| counter.count(&mut pass)).map(per_ray);
        // Misses are those of a predictor that has been trained, whether or not instructions were counted.
        let branch_misses = self.branch_misses.as_mut().and_then(|counter| {
            pass();
            counter.count(&mut pass).map(per_ray)
        });
        EventsPerRay { instructions, branch_misses }
    }
}

impl Counted {
    /// Of as many of `rays` as are worth it, evenly spread: a number that no clock decides, so that another run counts
    /// the same.
    pub fn affordable(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> Self {
        let counted = |count: usize| Self::new(accel, &spread(rays, count), query);
        let pilot = counted(64);
        let affordable = (TESTS * pilot.rays as u64 / pilot.counts.tests.max(1)) as usize;
        if affordable >= RAYS { counted(RAYS) } else { counted(1 << affordable.max(64).ilog2()) }
    }

    /// Of a few of `rays`, evenly spread: what tells their cost, and costs nothing to speak of itself.
    pub fn few(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> Self {
        let counted = |count: usize| Self::new(accel, &spread(rays, count), query);
        let first = counted(FEWEST);
        let affordable = FEW_TESTS * first.rays as u64 / first.counts.tests.max(1);
        if affordable >= FEW as u64 { counted(FEW) } else { first }
    }

    /// Asks `query` of all `rays`, and watches.
    pub fn new(accel: &dyn DynAccel, rays: &[Ray], query: Query) -> Self {
        let mut counts = Counts::default();
        let distances: Vec<Option<u32>> = match query {
            Query::Closest => {
                let mut hits = vec![None; rays.len()];
                accel.closest_hits_counted(rays, &mut hits, &mut counts);
                // The same distance has one sign at the origin, too.
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

    /// Whether leaves are observed: in some trees they are no nodes of their own. Whoever tests triangles has entered a
    /// leaf, if leaves are counted.
    pub fn sees_leaves(&self) -> bool {
        self.observed.steps && (self.counts.leaves > 0 || self.counts.tests == 0)
    }

    /// What an export says of the pass, with what the processor counts.
    pub fn in_export(&self, accel: &dyn DynAccel, workload: &Workload, events: Option<&mut Events>) -> RayCounts {
        let rays = spread(&workload.rays, self.rays);
        let events = events.filter(|_| accel.remote().is_none());
        let events = events.map(|events| events.per_ray(accel, &rays, workload.query)).unwrap_or_default();
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
            instructions_per_ray: events.instructions,
            branch_misses_per_ray: events.branch_misses,
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
        let scene = crate::scene::Builtin::find("cube").unwrap().scene(None).unwrap();
        // Twelve triangles: a block of eight and one of four.
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
