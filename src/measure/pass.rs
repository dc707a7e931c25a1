//! Measures the time of one structure on one workload in this process.

use std::borrow::Cow;
use std::ops::Range;
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::query_results::QueryResults;
use super::tiles::{TILE, tiles};
use super::{RandomOrder, Stopwatch, Threads, Timed};
use crate::accel::{DynAccel, Loaded, Query};
use crate::geometry::Ray;

/// At most [`TILE`] consecutive rays, traced in one call.
struct Piece<'a> {
    rays: Box<dyn Loaded + 'a>,
    count: usize,
    /// Bit `i` is set if the `i`-th chosen [level](super::tiles) contains this piece. A lead-in piece has no bit set.
    levels: u32,
}

/// Stores the results of `pieces` in `results`, starting at index `first`. Returns the index after the stored results.
fn query_all(results: &mut QueryResults, first: usize, pieces: &[Piece]) -> usize {
    pieces.iter().fold(first, |first, piece| {
        results.query(first..first + piece.count, piece.rays.as_ref());
        first + piece.count
    })
}

fn share(results: &mut QueryResults, pieces: &[&Piece], threads: &Threads) {
    fn each<T: Send>(mut rest: &mut [T], pieces: &[&Piece], query: fn(&dyn Loaded, &mut [T]), threads: &Threads) {
        let own = |piece: &&Piece| rest.split_off_mut(..piece.count).expect("there is a result for each ray");
        let results: Vec<&mut [T]> = pieces.iter().map(own).collect();
        threads.install(|| pieces.par_iter().zip(results).for_each(|(piece, own)| query(piece.rays.as_ref(), own)));
    }
    match results {
        QueryResults::Closest(hits) => each(hits, pieces, |rays, hits| rays.closest_hits(hits), threads),
        QueryResults::Any(hits) => each(hits, pieces, |rays, hits| rays.any_hits(hits), threads),
    }
}

/// Divides `all` into `count` ranges of about equal length. Selects one pseudo-random item per range. Equally spaced
/// rays could lie in only a few columns of an image.
pub fn spread<T: Copy>(all: &[T], count: usize) -> Vec<T> {
    if count >= all.len() {
        return all.to_vec();
    }
    let mut random = RandomOrder::new(0);
    let part = |i: usize| (i as u128 * all.len() as u128 / count as u128) as usize;
    (0..count).map(|i| all[part(i) + random.below(part(i + 1) - part(i))]).collect()
}

/// A pass begins with an untimed lead-in over the final rays of the workload. The lead-in warms the caches and branch
/// predictors for this structure. On one thread, a tile that does not adjoin the previous tile has a lead-in as well.
pub struct Pass<'a> {
    accel: &'a dyn DynAccel,
    threads: &'a Threads,
    all: &'a [Ray],
    query: Query,
    lead_in: Vec<Piece<'a>>,
    pieces: Vec<Piece<'a>>,
    levels: usize,
    results: QueryResults,
    lead_in_results: QueryResults,
    /// The number of lead-in rays and the checksum of the lead-in results. `Some` only if all rays are timed.
    lead_in_checksum: Option<(usize, u64)>,
    /// Picoseconds per lead-in ray. The initial `u128::MAX` disables the lead-ins of tiles.
    lead_in_ps: u128,
    /// Whether the most recent `clear` filled the results with hits. `clear` alternates between hits and misses, so
    /// unwritten results change the checksum.
    filled: bool,
}

/// The lead-in of a pass has 1 / `LEAD_IN_SHARE` of the rays of the workload.
pub(super) const LEAD_IN_SHARE: usize = 8;

/// On one thread, the lead-in before a subset of the rays stops after this time. Slow structures need fewer rays to
/// fill the caches.
const LEAD_IN: Duration = Duration::from_millis(10);

/// Limit of the estimated time of the lead-in of a tile. Caches load the data of a tile within this time.
const TILE_LEAD_IN_NS: u128 = 200_000;

impl<'a> Pass<'a> {
    /// # Panics
    /// If `rays` is empty.
    pub fn new(accel: &'a dyn DynAccel, rays: &'a [Ray], query: Query, threads: &'a Threads) -> Self {
        assert!(!rays.is_empty(), "a pass needs at least one ray");
        let mut pass = Self {
            accel,
            threads,
            all: rays,
            query,
            lead_in: vec![],
            pieces: vec![],
            levels: 0,
            results: QueryResults::misses(query, 0),
            lead_in_results: QueryResults::misses(query, 0),
            lead_in_checksum: None,
            lead_in_ps: u128::MAX,
            filled: false,
        };
        pass.choose(&[0], 0);
        pass
    }

    fn piece(&self, first: usize, count: usize, levels: u32) -> Piece<'a> {
        Piece { rays: self.accel.load(Cow::Borrowed(&self.all[first..first + count])), count, levels }
    }

    /// Returns the lead-in of the tile that starts at `end`. Each piece has about half of the remaining
    /// lead-in rays.
    fn before(&self, end: usize) -> impl Iterator<Item = Piece<'a>> {
        let count = TILE.min(self.all.len());
        let mut rest = if end < count { self.all.len() - count..self.all.len() } else { end - count..end };
        std::iter::from_fn(move || {
            let first = rest.start;
            rest.start += rest.len().div_ceil(2);
            (first < rest.start).then(|| self.piece(first, rest.start - first, 0))
        })
    }
}

impl Timed for Pass<'_> {
    fn rays(&self) -> usize {
        self.all.len()
    }

    fn choose(&mut self, levels: &[usize], epoch: usize) {
        let tiles_of: Vec<_> = levels.iter().map(|&level| tiles(self.all.len(), level, epoch)).collect();
        let own = &tiles_of[0];
        let timed: usize = own.iter().map(ExactSizeIterator::len).sum();

        let mut pieces = vec![];
        let mut end = None;
        for tile in own {
            if levels[0] > 0 && end != Some(tile.start) {
                pieces.extend(self.before(tile.start));
            }
            end = Some(tile.end);
            let others = tiles_of[1..].iter().flatten();
            let mut cuts: Vec<usize> = others.flat_map(|other| [other.start, other.end]).collect();
            cuts.retain(|cut| tile.contains(cut));
            cuts.extend([tile.start, tile.end]);
            cuts.sort_unstable();
            cuts.dedup();
            for cut in cuts.windows(2) {
                let holds = |tiles: &Vec<Range<usize>>| tiles.iter().any(|tile| tile.contains(&cut[0]));
                let levels = tiles_of.iter().enumerate().map(|(i, tiles)| u32::from(holds(tiles)) << i).sum();
                pieces.push(self.piece(cut[0], cut[1] - cut[0], levels));
            }
        }

        // The lead-in before a subset begins with small pieces, so a slow lead-in can stop early.
        let lead_in = self.all.len() / LEAD_IN_SHARE;
        let mut first = self.all.len() - lead_in;
        let mut size = if levels[0] == 0 { TILE } else { 1 };
        self.lead_in = vec![];
        while first < self.all.len() {
            let count = size.min(self.all.len() - first);
            self.lead_in.push(self.piece(first, count, 0));
            (first, size) = (first + count, TILE.min(2 * size));
        }
        (self.pieces, self.levels) = (pieces, levels.len());
        self.results = QueryResults::misses(self.query, timed);
        self.lead_in_results = QueryResults::misses(self.query, lead_in.max(TILE));
    }

    fn clear(&mut self) {
        self.filled = !self.filled;
        self.results.fill(self.filled);
        self.lead_in_results.fill(self.filled);
        (self.lead_in_checksum, self.lead_in_ps) = (None, u128::MAX);
    }

    fn lead_in(&mut self) {
        let (start, is_whole) = (Instant::now(), self.results.count() == self.all.len());
        let mut count = self.lead_in.iter().map(|piece| piece.count).sum();
        if self.threads.count() > 1 {
            share(&mut self.lead_in_results, &self.lead_in.iter().collect::<Vec<_>>(), self.threads);
        } else {
            let pieces = self.lead_in.chunks(1).take_while(|_| is_whole || start.elapsed() < LEAD_IN);
            count = pieces.fold(0, |done, piece| query_all(&mut self.lead_in_results, done, piece));
        }
        self.lead_in_ps = start.elapsed().as_nanos() * 1000 / count.max(1) as u128;
        self.lead_in_checksum = is_whole.then(|| (count, self.lead_in_results.checksum(0..count)));
    }

    fn run(&mut self, watch: &Stopwatch) -> Vec<u64> {
        let mut ns = vec![0; self.levels];
        if self.threads.count() > 1 {
            // The threads divide the rays of a level, so each level is timed separately.
            // The loop ends with `level` 0, because `checksum` must read the results of `level` 0.
            for level in (0..self.levels).rev() {
                let of_level = |piece: &&Piece| piece.levels >> level & 1 == 1;
                let pieces: Vec<&Piece> = self.pieces.iter().filter(of_level).collect();
                ns[level] = watch.time(|| share(&mut self.results, &pieces, self.threads));
            }
            return ns;
        }
        let mut first = 0;
        for run in self.pieces.chunk_by(|one, other| one.levels == other.levels) {
            if run[0].levels == 0 {
                let affordable = TILE_LEAD_IN_NS * 1000 / self.lead_in_ps.max(1);
                let mut rays: usize = run.iter().map(|piece| piece.count).sum();
                let mut run = run;
                while let [largest, rest @ ..] = run
                    && rays as u128 > affordable
                {
                    (rays, run) = (rays - largest.count, rest);
                }
                query_all(&mut self.lead_in_results, 0, run);
                continue;
            }
            let took = watch.time(|| first = query_all(&mut self.results, first, run));
            (0..self.levels).filter(|level| run[0].levels >> level & 1 == 1).for_each(|level| ns[level] += took);
        }
        ns
    }

    fn checksum(&self) -> u64 {
        self.results.checksum(0..self.results.count())
    }

    fn contradicts_itself(&self) -> bool {
        let all = self.results.count();
        self.lead_in_checksum.is_some_and(|(count, checksum)| checksum != self.results.checksum(all - count..all))
    }
}

#[cfg(test)]
mod tests;
