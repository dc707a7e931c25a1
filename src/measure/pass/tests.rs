use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use glam::Vec3;

use super::*;
use crate::accel::{Accel, Counts, Footprint, Observed, TreeShape};
use crate::brute_force::BruteForce;
use crate::geometry::{Hit, Mesh};
use crate::measure::tiles::rays_at;
use crate::measure::{Clock, SystemClock};
use crate::triangle::MollerTrumbore;

fn triangle() -> Box<dyn DynAccel> {
    let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).unwrap();
    Box::new(BruteForce::<MollerTrumbore>::build(&Arc::new(mesh), &Default::default()).unwrap())
}

fn rays(n: usize) -> Vec<Ray> {
    (0..n).map(|i| Ray::new(Vec3::new(0.2, 0.2, if i % 2 == 0 { -1.0 } else { 1.0 }), Vec3::Z)).collect()
}

#[test]
fn a_pass_answers_the_rays_of_its_tiles_on_any_number_of_threads() {
    let (accel, rays, clock) = (triangle(), rays(9000), SystemClock::start());
    let threads = [1, 3].map(Threads::unstarted);
    for query in [Query::Closest, Query::Any] {
        for (levels, epoch) in [(&[0][..], 5), (&[0, 1, 3], 5), (&[1], 0), (&[2, 4], 5), (&[3], 1), (&[6], 2)] {
            let sums = threads.each_ref().map(|threads| {
                let mut pass = Pass::new(accel.as_ref(), &rays, query, threads);
                pass.choose(levels, epoch);
                pass.clear();
                pass.lead_in();
                assert_eq!(pass.run(&Stopwatch::new(&clock)).len(), levels.len());
                let own = || tiles(9000, levels[0], epoch).into_iter().flatten();
                assert_eq!((pass.rays(), own().count()), (9000, rays_at(9000, levels[0])));
                let hits = match &pass.results {
                    QueryResults::Closest(hits) => hits.iter().flatten().count(),
                    QueryResults::Any(hits) => hits.iter().filter(|hit| **hit).count(),
                };
                assert_eq!(hits, own().filter(|i| i % 2 == 0).count());
                assert!(!pass.contradicts_itself());
                pass.checksum()
            });
            assert_eq!(sums[0], sums[1]);
        }
    }
}

#[test]
fn a_pass_without_results_changes_its_checksum() {
    let (accel, rays, threads) = (triangle(), rays(10), Threads::unstarted(1));
    for query in [Query::Closest, Query::Any] {
        let mut pass = Pass::new(accel.as_ref(), &rays, query, &threads);
        let [first, second] = [(); 2].map(|()| {
            pass.clear();
            pass.checksum()
        });
        assert_ne!(first, second);
    }
}

/// The x coordinate of a ray's origin is the tracing time in nanoseconds.
struct Slow<'a>(&'a AtomicU64, Box<dyn DynAccel>);

/// The clock, the number of rays, and the tracing time in nanoseconds.
struct Taken<'a>(&'a AtomicU64, usize, u64);

struct Now<'a>(&'a AtomicU64);

impl Clock for Now<'_> {
    fn now_ns(&self) -> u64 {
        self.0.fetch_add(7, Relaxed)
    }
}

impl Loaded for Taken<'_> {
    fn closest_hits(&self, hits: &mut [Option<Hit>]) {
        assert_eq!(hits.len(), self.1);
        self.0.fetch_add(self.2, Relaxed);
    }

    fn any_hits(&self, _: &mut [bool]) {
        unreachable!("only closest hits are queried")
    }
}

impl DynAccel for Slow<'_> {
    fn closest_hits(&self, _: &[Ray], _: &mut [Option<Hit>]) {}
    fn any_hits(&self, _: &[Ray], _: &mut [bool]) {}
    fn closest_hits_counted(&self, _: &[Ray], _: &mut [Option<Hit>], _: &mut Counts) {}
    fn any_hits_counted(&self, _: &[Ray], _: &mut [bool], _: &mut Counts) {}
    fn observed(&self) -> Observed {
        self.1.observed()
    }
    fn footprint(&self) -> Footprint {
        self.1.footprint()
    }
    fn shape(&self) -> TreeShape {
        self.1.shape()
    }
    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        let ns = rays.iter().map(|ray| ray.origin.x as u64).sum();
        Box::new(Taken(self.0, rays.len(), ns))
    }
}

#[test]
fn the_time_of_a_part_is_that_of_its_rays_and_lead_ins_are_not_timed() {
    let now = AtomicU64::new(0);
    let slow = Slow(&now, triangle());
    let rays: Vec<Ray> = (0..9000).map(|i| Ray::new(Vec3::splat(i as f32), Vec3::X)).collect();
    let (threads, clock) = (Threads::unstarted(1), Now(&now));
    for (levels, epoch) in [(&[0][..], 0), (&[0, 1, 3], 1), (&[1, 2], 2), (&[4], 3)] {
        let mut pass = Pass::new(&slow, &rays, Query::Closest, &threads);
        pass.choose(levels, epoch);
        pass.clear();
        pass.lead_in();
        let expected =
            levels.iter().map(|&level| tiles(9000, level, epoch).into_iter().flatten().sum::<usize>() as u64);
        assert_eq!(pass.run(&Stopwatch::new(&clock)), expected.collect::<Vec<_>>());
    }
}

#[test]
fn rays_are_picked_one_from_each_part() {
    let all: Vec<Ray> = (0..10).map(|i| Ray::new(Vec3::splat(i as f32), Vec3::X)).collect();
    let parts: Vec<usize> =
        spread(&all, 4).iter().map(|ray| [0, 0, 1, 1, 1, 2, 2, 3, 3, 3][ray.origin.x as usize]).collect();
    assert_eq!(parts, [0, 1, 2, 3]);
    assert_eq!(spread(&all, 20), all);
}
