//! One structure answering one workload, as a renderer would have it answered.

use std::borrow::Cow;
use std::ops::Range;
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::answers::{Answers, Slots};
use super::tiles::{TILE, tiles};
use super::{RandomOrder, Stopwatch, Threads, Timed};
use crate::accel::{DynAccel, Loaded, Query};
use crate::geometry::Ray;

/// Neighbouring rays that are handed over together, [`TILE`] at most.
struct Piece<'a> {
    rays: Box<dyn Loaded + 'a>,
    count: usize,
    /// The levels, by their place among those chosen, whose time this counts for: a bit each. None for a lead-in.
    levels: u32,
}

fn ask_all(slots: Slots, pieces: &[Piece]) {
    pieces.iter().fold(slots, |slots, piece| {
        let (own, rest) = slots.split(piece.count);
        own.ask(piece.rays.as_ref());
        rest
    });
}

fn share(slots: Slots, pieces: &[&Piece], threads: &Threads) {
    let mut work = Vec::with_capacity(pieces.len());
    pieces.iter().fold(slots, |slots, &piece| {
        let (own, rest) = slots.split(piece.count);
        work.push((piece, own));
        rest
    });
    threads.install(|| work.into_par_iter().for_each(|(piece, slots)| slots.ask(piece.rays.as_ref())));
}

/// `count` of `all`, in order: one from each of `count` parts of equal length, at a seeded random place in it, so that the
/// rows and columns of an image are not favoured. All when there are not more. For checks and counts; what is timed are [`tiles`].
pub fn spread<T: Copy>(all: &[T], count: usize) -> Vec<T> {
    if count >= all.len() {
        return all.to_vec();
    }
    let mut random = RandomOrder::new(0);
    let part = |i: usize| (i as u128 * all.len() as u128 / count as u128) as usize;
    (0..count).map(|i| all[part(i) + random.below(part(i + 1) - part(i))]).collect()
}

/// A structure, a workload and a query: what is timed.
///
/// One thread takes the rays piece by piece in the order of the workload. Every pass begins with a lead-in that is not
/// timed, over other rays of the kind where there are any: caches and predictors are then in the state that this
/// structure leaves them in, and not in that of the structure that was timed before. Where the pass goes over tiles
/// that are apart, each tile has a short lead-in as well.
pub struct Pass<'a> {
    accel: &'a dyn DynAccel,
    threads: &'a Threads,
    all: &'a [Ray],
    lead_in: Vec<Piece<'a>>,
    pieces: Vec<Piece<'a>>,
    levels: usize,
    answers: Answers,
    /// Of the lead-ins.
    aside: Answers,
    /// Where a pass takes all rays: how many of the last of them the lead-in takes as well, and a sum of their answers.
    led_in: Option<(usize, u64)>,
    /// Picoseconds that a ray of the lead-in took; without one there is none before tiles either.
    lead_in_ps: u128,
    /// What `clear` fills in changes each time: a pass that leaves an answer as it was cannot give the same sum twice.
    filled: bool,
}

/// The share of a workload that a lead-in before a pass has.
const LEAD_IN_SHARE: usize = 8;

/// A lead-in before tiles ends early when it has taken so long: structures that are slow need fewer rays to fill the
/// caches.
const LEAD_IN: Duration = Duration::from_millis(10);

/// What the lead-in before a tile may take, of as many rays as a whole tile has: longer than it takes to fetch what the
/// tile needs into the caches, so that a structure which is slower than that does with fewer.
const TILE_LEAD_IN_NS: u128 = 200_000;

impl<'a> Pass<'a> {
    /// A pass over all rays.
    ///
    /// # Panics
    /// If there are no rays.
    pub fn new(accel: &'a dyn DynAccel, rays: &'a [Ray], query: Query, threads: &'a Threads) -> Self {
        assert!(!rays.is_empty(), "a pass has rays");
        let (answers, aside) = (Answers::none(query), Answers::none(query));
        let (lead_in, pieces) = (vec![], vec![]);
        let mut pass = Self {
            accel,
            threads,
            all: rays,
            lead_in,
            pieces,
            levels: 0,
            answers,
            aside,
            led_in: None,
            lead_in_ps: u128::MAX,
            filled: false,
        };
        pass.choose(&[0], 0);
        pass
    }

    fn piece(&self, first: usize, count: usize, levels: u32) -> Piece<'a> {
        Piece { rays: self.accel.load(Cow::Borrowed(&self.all[first..first + count])), count, levels }
    }

    /// Neighbours up to `end`, the last of the workload before its first; in pieces that get smaller towards the end,
    /// so that some can be left out.
    fn before(&self, end: usize) -> impl Iterator<Item = Piece<'a>> {
        let count = TILE.min(self.all.len());
        let mut rest = if end < count { self.all.len() - count..self.all.len() } else { end - count..end };
        std::iter::from_fn(move || {
            let first = rest.start;
            rest.start += rest.len().div_ceil(2);
            (first < rest.start).then(|| self.piece(first, rest.start - first, 0))
        })
    }

    /// Rays of the last pass that hit something.
    pub fn hits(&self) -> usize {
        match &self.answers {
            Answers::Closest(hits) => hits.iter().flatten().count(),
            Answers::Any(hits) => hits.iter().filter(|hit| **hit).count(),
        }
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

        // Where one of the other levels begins or ends within a tile, a piece ends.
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

        // Before tiles the pieces begin small, so that a slow structure can stop.
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
        self.answers.resize(timed);
        self.aside.resize(lead_in.max(TILE));
    }

    fn clear(&mut self) {
        self.filled = !self.filled;
        self.answers.fill(self.filled);
        self.aside.fill(self.filled);
        (self.led_in, self.lead_in_ps) = (None, u128::MAX);
    }

    fn lead_in(&mut self) {
        let start = Instant::now();
        let mut count = self.lead_in.iter().map(|piece| piece.count).sum();
        if self.threads.count() > 1 {
            share(self.aside.first(count), &self.lead_in.iter().collect::<Vec<_>>(), self.threads);
        } else {
            let is_whole = self.answers.len() == self.all.len();
            let pieces = self.lead_in.iter().take_while(|_| is_whole || start.elapsed() < LEAD_IN);
            count = pieces.fold(0, |done, piece| {
                self.aside.first(done + piece.count).split(done).1.ask(piece.rays.as_ref());
                done + piece.count
            });
        }
        self.lead_in_ps = start.elapsed().as_nanos() * 1000 / count.max(1) as u128;
        self.led_in = (self.answers.len() == self.all.len()).then(|| (count, self.aside.checksum(0..count)));
    }

    fn run(&mut self, watch: &Stopwatch) -> Vec<u64> {
        let mut ns = vec![0; self.levels];
        if self.threads.count() > 1 {
            // Threads share the rays of a level, so each level is timed apart; all rays come last, and their answers
            // stay.
            for level in (0..self.levels).rev() {
                let of_level = |piece: &&Piece| piece.levels >> level & 1 == 1;
                let pieces: Vec<&Piece> = self.pieces.iter().filter(of_level).collect();
                let slots = self.answers.first(pieces.iter().map(|piece| piece.count).sum());
                ns[level] = watch.time(|| share(slots, &pieces, self.threads));
            }
            return ns;
        }
        let mut rest = self.answers.first(self.answers.len());
        for run in self.pieces.chunk_by(|one, other| one.levels == other.levels) {
            if run[0].levels == 0 {
                let affordable = TILE_LEAD_IN_NS * 1000 / self.lead_in_ps.max(1);
                let mut rays: usize = run.iter().map(|piece| piece.count).sum();
                let mut run = run;
                while let [first, rest @ ..] = run
                    && rays as u128 > affordable
                {
                    (rays, run) = (rays - first.count, rest);
                }
                ask_all(self.aside.first(rays), run);
                continue;
            }
            let count = run.iter().map(|piece| piece.count).sum();
            let (own, others) = rest.split(count);
            rest = others;
            let took = watch.time(|| ask_all(own, run));
            (0..self.levels).filter(|level| run[0].levels >> level & 1 == 1).for_each(|level| ns[level] += took);
        }
        ns
    }

    fn checksum(&self) -> u64 {
        self.answers.checksum(0..self.answers.len())
    }

    fn contradicts_itself(&self) -> bool {
        let all = self.answers.len();
        self.led_in.is_some_and(|(count, checksum)| checksum != self.answers.checksum(all - count..all))
    }
}

#[cfg(test)]
mod tests;
