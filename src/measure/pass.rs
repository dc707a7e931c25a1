//! One structure answering one batch of rays.

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;

use super::pin::{self, Pin};
use super::{RandomOrder, Timed, machine};
use crate::accel::{DynAccel, Loaded, Query};
use crate::geometry::{Hit, PrimId, Ray};

/// The threads that build and trace; a clone is the same threads.
#[derive(Clone)]
pub struct Threads {
    pool: Arc<rayon::ThreadPool>,
    count: usize,
    /// The core of each, where they are bound.
    cores: Option<Vec<usize>>,
}

impl Threads {
    /// Threads that run where the system likes.
    ///
    /// # Errors
    /// If the system does not give that many threads; the sentence is its own.
    pub fn new(count: usize) -> Result<Self, String> {
        Self::on(count, None)
    }

    /// Threads each of which is bound to a core of its own, where the system allows that and has as many: to measure.
    ///
    /// # Errors
    /// As [`Threads::new`].
    pub fn pinned(count: usize) -> Result<Self, String> {
        Self::on(count, pin::choose(count))
    }

    fn on(count: usize, cores: Option<Vec<usize>>) -> Result<Self, String> {
        // What the load was before these threads made some.
        machine::load_at_start();
        let own = cores.clone();
        let bind = move |i: usize| {
            if let Some(cores) = &own {
                pin::bind(&cores[i..=i]);
            }
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).start_handler(bind);
        Ok(Self { pool: Arc::new(pool.build().map_err(|error| error.to_string())?), count, cores })
    }

    /// The core of each thread; nothing where they are not bound.
    pub fn cores(&self) -> Option<&[usize]> {
        self.cores.as_deref()
    }

    /// Binds the calling thread, which traces when there is but one, until the guard is dropped. Nothing if these threads are not bound.
    pub fn pin(&self) -> Option<Pin> {
        if self.count == 1 { Pin::to(*self.cores.as_ref()?.first()?) } else { None }
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// Runs `work` on these threads: all parallel iterators in it stay on them.
    pub fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.pool.install(work)
    }
}

/// The answers to a batch.
enum Answers {
    Closest(Vec<Option<Hit>>),
    Any(Vec<bool>),
}

/// A structure, a batch of rays and a query: what is timed.
pub struct Pass<'a> {
    accel: &'a dyn DynAccel,
    threads: &'a Threads,
    all: &'a [Ray],
    /// Rays of a pass.
    count: usize,
    /// The rays as the structure takes them: all at once on one thread, else in chunks. Nothing before the first pass over them.
    loaded: Vec<Box<dyn Loaded + 'a>>,
    answers: Answers,
    /// What `clear` fills in changes each time: a pass that leaves an answer as it was cannot give the same sum twice.
    filled: bool,
}

/// Rays that a thread takes at once: enough to hide the hand-over, few enough to share out evenly.
const CHUNK: usize = 1024;

impl<'a> Pass<'a> {
    /// # Panics
    /// If there are no rays.
    pub fn new(accel: &'a dyn DynAccel, rays: &'a [Ray], query: Query, threads: &'a Threads) -> Self {
        assert!(!rays.is_empty(), "a pass has rays");
        let answers = match query {
            Query::Closest => Answers::Closest(vec![None; rays.len()]),
            Query::Any => Answers::Any(vec![false; rays.len()]),
        };
        Self { accel, threads, all: rays, count: rays.len(), loaded: vec![], answers, filled: false }
    }

    /// Hands the rays over to the structure.
    fn load(&mut self) {
        let chunk = if self.threads.count == 1 { self.count } else { CHUNK };
        self.loaded = if self.count == self.all.len() {
            self.all.chunks(chunk).map(|rays| self.accel.load(Cow::Borrowed(rays))).collect()
        } else {
            spread_in_runs(self.all, self.count)
                .chunks(chunk)
                .map(|rays| self.accel.load(Cow::Owned(rays.to_vec())))
                .collect()
        };
    }

    /// Rays of the last pass that hit something.
    pub fn hits(&self) -> usize {
        match &self.answers {
            Answers::Closest(hits) => hits.iter().flatten().count(),
            Answers::Any(hits) => hits.iter().filter(|hit| **hit).count(),
        }
    }
}

/// `count` of `rays`, in order: one from each of `count` parts of equal length, at a seeded random place in it, so that the
/// rows and columns of an image are not favoured. All rays when there are not more.
pub fn spread(rays: &[Ray], count: usize) -> Vec<Ray> {
    if count >= rays.len() {
        return rays.to_vec();
    }
    let mut random = RandomOrder::new(0);
    let part = |i: usize| (i as u128 * rays.len() as u128 / count as u128) as usize;
    (0..count).map(|i| rays[part(i) + random.below(part(i + 1) - part(i))]).collect()
}

/// FNV-1a over numbers (Fowler, Noll, Vo).
pub fn checksum(numbers: impl Iterator<Item = u64>) -> u64 {
    numbers.fold(0xcbf2_9ce4_8422_2325, |sum, number| (sum ^ number).wrapping_mul(0x0000_0100_0000_01b3))
}

/// Rays that lie side by side and stay together where a part of them is timed: workloads go tile by tile, four by four.
const TOGETHER: usize = 16;

/// As [`spread`], but in runs of neighbours: what a ray costs depends on what the one before it has brought into the caches, and rays
/// picked one by one would be dearer the fewer of them there are.
pub fn spread_in_runs(rays: &[Ray], count: usize) -> Vec<Ray> {
    let runs = count / TOGETHER;
    if count >= rays.len() || runs < TOGETHER || !count.is_multiple_of(TOGETHER) {
        return spread(rays, count);
    }
    let mut random = RandomOrder::new(0);
    let all = rays.len() / TOGETHER;
    let part = |i: usize| (i as u128 * all as u128 / runs as u128) as usize;
    let run = |i: usize| {
        let first = (part(i) + random.below(part(i + 1) - part(i))) * TOGETHER;
        rays[first..first + TOGETHER].iter().copied()
    };
    (0..runs).flat_map(run).collect()
}

impl Timed for Pass<'_> {
    fn rays(&self) -> usize {
        self.all.len()
    }

    fn restrict(&mut self, rays: usize) {
        let rays = rays.min(self.all.len());
        if rays != self.count {
            (self.count, self.loaded) = (rays, vec![]);
        }
        match &mut self.answers {
            Answers::Closest(hits) => hits.resize(rays, None),
            Answers::Any(hits) => hits.resize(rays, false),
        }
    }

    /// Here the rays are loaded, before the first pass over them: [`clear`](Timed::clear) is not timed.
    fn clear(&mut self) {
        if self.loaded.is_empty() {
            self.load();
        }
        self.filled = !self.filled;
        let nowhere = Hit { t: f32::NAN, prim: PrimId::new(0) };
        match &mut self.answers {
            Answers::Closest(hits) => hits.fill(self.filled.then_some(nowhere)),
            Answers::Any(hits) => hits.fill(self.filled),
        }
    }

    fn run(&mut self) {
        let loaded = &self.loaded[..];
        assert!(!loaded.is_empty(), "a pass is cleared before it is run");
        match (&mut self.answers, self.threads.count) {
            (Answers::Closest(hits), 1) => loaded[0].closest_hits(hits),
            (Answers::Any(hits), 1) => loaded[0].any_hits(hits),
            (Answers::Closest(hits), _) => self.threads.install(|| {
                let chunks = loaded.par_iter().zip(hits.par_chunks_mut(CHUNK));
                chunks.for_each(|(rays, hits)| rays.closest_hits(hits));
            }),
            (Answers::Any(hits), _) => self.threads.install(|| {
                let chunks = loaded.par_iter().zip(hits.par_chunks_mut(CHUNK));
                chunks.for_each(|(rays, hits)| rays.any_hits(hits));
            }),
        }
    }

    fn checksum(&self) -> u64 {
        let number = |hit: &Hit| u64::from(hit.t.to_bits()) << 32 | u64::from(hit.prim.index());
        match &self.answers {
            Answers::Closest(hits) => checksum(hits.iter().map(|hit| hit.as_ref().map_or(u64::MAX, number))),
            Answers::Any(hits) => checksum(hits.iter().map(|&hit| hit.into())),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::accel::Accel;
    use crate::geometry::Mesh;
    use crate::structures::BruteForce;
    use crate::triangle::MollerTrumbore;

    fn triangle() -> Box<dyn DynAccel> {
        let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).unwrap();
        Box::new(BruteForce::<MollerTrumbore>::build(&Arc::new(mesh), &Default::default()).unwrap())
    }

    /// `n` rays of which every second hits.
    fn rays(n: usize) -> Vec<Ray> {
        (0..n).map(|i| Ray::new(Vec3::new(0.2, 0.2, if i % 2 == 0 { -1.0 } else { 1.0 }), Vec3::Z)).collect()
    }

    #[test]
    fn any_number_of_threads_gives_the_same_answers() {
        let (accel, rays) = (triangle(), rays(5000));
        let (one, three) = (Threads::new(1).unwrap(), Threads::new(3).unwrap());
        for query in [Query::Closest, Query::Any] {
            let sums = [&one, &three].map(|threads| {
                let mut pass = Pass::new(accel.as_ref(), &rays, query, threads);
                pass.clear();
                pass.run();
                assert_eq!(pass.hits(), 2500);
                pass.checksum()
            });
            assert_eq!(sums[0], sums[1]);
        }
    }

    #[test]
    fn a_pass_that_answers_nothing_is_unsteady() {
        let (accel, rays, threads) = (triangle(), rays(10), Threads::new(1).unwrap());
        for query in [Query::Closest, Query::Any] {
            let mut pass = Pass::new(accel.as_ref(), &rays, query, &threads);
            let idle: Vec<u64> = (0..2)
                .map(|_| {
                    pass.clear();
                    pass.checksum()
                })
                .collect();
            assert_ne!(idle[0], idle[1]);
        }
    }

    #[test]
    fn a_restricted_pass_spreads_its_rays() {
        let all: Vec<Ray> = (0..10).map(|i| Ray::new(Vec3::splat(i as f32), Vec3::X)).collect();
        let parts: Vec<usize> =
            spread(&all, 4).iter().map(|ray| [0, 0, 1, 1, 1, 2, 2, 3, 3, 3][ray.origin.x as usize]).collect();
        assert_eq!(parts, [0, 1, 2, 3]);
        assert_eq!(spread(&all, 20), all);

        let (accel, rays, threads) = (triangle(), rays(9), Threads::new(1).unwrap());
        let mut pass = Pass::new(accel.as_ref(), &rays, Query::Any, &threads);
        pass.restrict(3);
        pass.clear();
        pass.run();
        assert_eq!(pass.rays(), 9);
        assert_eq!(pass.hits(), spread(&rays, 3).iter().filter(|ray| ray.origin.z < 0.0).count());
    }

    #[test]
    fn many_rays_are_spread_in_runs_of_neighbours() {
        let all: Vec<Ray> = (0..16 * 100 + 7).map(|i| Ray::new(Vec3::splat(i as f32), Vec3::X)).collect();
        let part = spread_in_runs(&all, 512);
        assert_eq!(part.len(), 512);
        for (i, run) in part.chunks(16).enumerate() {
            let first = run[0].origin.x as usize;
            assert!(
                first.is_multiple_of(16) && (i * 50 / 16..).contains(&(first / 16)) && first / 16 < (i + 1) * 50 / 16
            );
            assert!(run.iter().enumerate().all(|(k, ray)| ray.origin.x as usize == first + k));
        }
        assert_eq!(spread_in_runs(&all, 128), spread(&all, 128));
        assert_eq!(spread_in_runs(&all, 5000), all);
    }
}
