//! Traces the rays of a slice one after the other, in packets, or interleaved.

use std::ops::Range;

use super::config::Batch;
use super::packet_hits::RAYS;
use super::stream::{Slots, Stream};
use super::tree::Bvh8;
use crate::accel::Observer;
use crate::geometry::{Hit, Ray};
use crate::simd::{EightLanes, Kernel, Level, dispatch, each};
use crate::traversal::leaf::Nearest;
use crate::traversal::walk::{single, walk_without_observer};
use crate::triangle::{Depth, INPUTS, TriangleTest, last_bits};

/// Maximum number of rays in a window. Small windows make interleaving less effective.
const WINDOW: usize = 4096;

/// Some groups of a window, in ascending order. A group has at most `RAYS` consecutive rays.
pub(super) struct Groups {
    numbers: [u8; WINDOW / RAYS],
    len: usize,
}

const _: () = assert!(WINDOW / RAYS <= 1 << u8::BITS);

impl Groups {
    const NONE: Self = Self { numbers: [0; WINDOW / RAYS], len: 0 };

    #[cfg(test)]
    pub fn all(rays: usize) -> Self {
        Self { numbers: std::array::from_fn(|i| i as u8), len: rays.div_ceil(RAYS) }
    }

    #[inline(always)]
    fn push(&mut self, number: usize) {
        self.numbers[self.len] = number as u8;
        self.len += 1;
    }

    /// The range of ray indices of each group. `rays` is the number of rays in the window.
    #[inline(always)]
    fn places(&self, rays: usize) -> impl Iterator<Item = Range<usize>> {
        let first = |&number: &u8| usize::from(number) * RAYS;
        self.numbers[..self.len].iter().map(first).map(move |first| first..rays.min(first + RAYS))
    }

    /// Like [`places`](Self::places), with adjacent ranges joined.
    fn runs(&self, rays: usize) -> impl Iterator<Item = Range<usize>> {
        let numbers = &self.numbers[..self.len];
        numbers.chunk_by(|one, next| next - one == 1).map(move |run| {
            let [first, last] = [run[0], run[run.len() - 1]].map(usize::from);
            first * RAYS..rays.min((last + 1) * RAYS)
        })
    }
}

struct HitBatch {
    inputs: [[f32; HITS]; INPUTS],
    rays: [usize; HITS],
    ids: [u32; HITS],
    len: usize,
}

const HITS: usize = 8;

impl HitBatch {
    const NONE: Self = Self { inputs: [[0.0; HITS]; INPUTS], rays: [0; HITS], ids: [0; HITS], len: 0 };

    /// Returns true if the batch is full. The caller must then call `finish`.
    ///
    /// Stores inputs instead of a copy of `depth`, because a copy loads fields that were just written and stalls.
    #[must_use]
    #[inline(always)]
    fn push<D: Depth>(&mut self, i: usize, ray: &Ray, depth: &D, id: u32) -> bool {
        debug_assert!(self.len < HITS);
        let lane = self.len % HITS;
        for (column, input) in self.inputs.iter_mut().zip(depth.inputs(ray)) {
            column[lane] = input;
        }
        (self.rays[lane], self.ids[lane]) = (i, id);
        self.len = lane + 1;
        self.len == HITS
    }

    #[inline(always)]
    fn finish<D: Depth>(&mut self, level: Level, mut hit: impl FnMut(usize, Hit)) {
        let len = std::mem::take(&mut self.len);
        if len == 0 {
            return;
        }
        let ts = last_bits::<D>(level, &self.inputs, (1 << len) - 1);
        for ((&ray, &id), t) in self.rays.iter().zip(&self.ids).zip(ts).take(len) {
            hit(ray, Hit::new(t, id));
        }
    }
}

struct InOrder<'a, const ANY: bool, T: TriangleTest, A, F> {
    tree: &'a Bvh8<T>,
    rays: &'a [Ray],
    answers: &'a mut [A],
    convert: F,
    level: Level,
}

impl<const ANY: bool, T: TriangleTest, A, F: Fn(Option<Hit>) -> A> Kernel for InOrder<'_, ANY, T, A, F> {
    type Output = ();

    #[inline(always)]
    fn run<L: EightLanes>(self) {
        let Self { tree, rays, answers, convert, level } = self;
        if ANY || !T::Depth::LATE || !L::FAST {
            // A `HitBatch` saves no time here.
            for (answer, ray) in answers.iter_mut().zip(rays) {
                *answer = convert(walk_without_observer::<ANY, L, _>(tree, ray));
            }
            return;
        }
        let mut hits = HitBatch::NONE;
        let mut answer = |i: usize, hit: Option<Hit>| answers[i] = convert(hit);
        for (i, ray) in rays.iter().enumerate() {
            let mut nearest = Nearest::NOTHING;
            tree.find::<ANY, L, ()>(ray, &mut nearest, &mut ());
            match &nearest.hit {
                None => answer(i, None),
                Some((depth, id)) => {
                    if hits.push(i, ray, depth, *id) {
                        hits.finish::<T::Depth<'_>>(level, |i, hit| answer(i, Some(hit)));
                    }
                }
            }
        }
        hits.finish::<T::Depth<'_>>(level, |i, hit| answer(i, Some(hit)));
    }
}

/// Traces the groups that form packets. Returns the other groups.
struct InPackets<'a, const ANY: bool, T: TriangleTest, A, F> {
    tree: &'a Bvh8<T>,
    rays: &'a [Ray],
    answers: &'a mut [A],
    convert: &'a F,
    level: Level,
}

impl<const ANY: bool, T: TriangleTest, A, F: Fn(Option<Hit>) -> A> Kernel for InPackets<'_, ANY, T, A, F> {
    type Output = Groups;

    #[inline(always)]
    fn run<L: EightLanes>(self) -> Groups {
        let Self { tree, rays, answers, convert, level } = self;
        let mut others = Groups::NONE;
        for (number, (rays, answers)) in rays.chunks(RAYS).zip(answers.chunks_mut(RAYS)).enumerate() {
            let together = match (rays.try_into(), answers.try_into()) {
                (Ok(rays), Ok(answers)) if L::FAST => {
                    may_share_octant(rays) && tree.intersect_packet::<ANY, L, A>(level, rays, answers, convert)
                }
                _ => false,
            };
            if !together {
                others.push(number);
            }
        }
        others
    }
}

pub(super) struct Interleaved<'a, T: TriangleTest, A, F> {
    pub tree: &'a Bvh8<T>,
    pub rays: &'a [Ray],
    pub which: &'a Groups,
    pub answers: &'a mut [A],
    pub convert: &'a F,
}

impl<T: TriangleTest, A, F: Fn(Option<Hit>) -> A> Kernel for Interleaved<'_, T, A, F> {
    type Output = ();

    #[inline(always)]
    fn run<L: EightLanes>(self) {
        let Self { tree, rays, which, answers, convert } = self;
        if !L::FAST {
            // Interleaving saves no time without vector instructions.
            for i in which.places(rays.len()).flatten() {
                answers[i] = convert(walk_without_observer::<false, L, _>(tree, &rays[i]));
            }
            return;
        }
        let mut slots = Slots::EMPTY;
        let which = which.places(rays.len()).flatten().map(|i| (i, &rays[i]));
        Stream::<T>::new(tree, &mut slots).run::<L>(which, |i, hit| answers[i] = convert(hit));
    }
}

/// Returns false for most groups with directions in different octants.
#[inline(always)]
fn may_share_octant(rays: &[Ray; RAYS]) -> bool {
    let signs = |i: usize| each(&rays[i].direction.to_array(), |x| x.to_bits());
    let first = signs(0);
    let differ = |i: usize| (0..3).fold(0, |bits, axis| bits | (signs(i)[axis] ^ first[axis]));
    (differ(5) | differ(10) | differ(15)) >> 31 == 0
}

pub(super) fn answer<const ANY: bool, T: TriangleTest, A, O: Observer>(
    tree: &Bvh8<T>,
    rays: &[Ray],
    answers: &mut [A],
    observer: &mut O,
    convert: impl Fn(Option<Hit>) -> A,
) {
    assert_eq!(rays.len(), answers.len(), "one result per ray");
    if O::ACTIVE {
        for (answer, ray) in answers.iter_mut().zip(rays) {
            *answer = convert(single::<ANY, _, O>(tree, ray, observer));
        }
    } else {
        let level = Level::current();
        if !T::BATCHED || tree.batch == Batch::Single {
            return dispatch(level, InOrder::<ANY, T, A, _> { tree, rays, answers, convert, level });
        }
        for (rays, answers) in rays.chunks(WINDOW).zip(answers.chunks_mut(WINDOW)) {
            let convert = &convert;
            let which = dispatch(level, InPackets::<ANY, T, A, _> { tree, rays, answers, convert, level });
            trace_single_rays::<ANY, T, A>(level, tree, rays, &which, answers, convert);
        }
    }
}

/// Interleaving is faster only for closest-hit queries on large trees.
fn trace_single_rays<const ANY: bool, T: TriangleTest, A>(
    level: Level,
    tree: &Bvh8<T>,
    rays: &[Ray],
    which: &Groups,
    answers: &mut [A],
    convert: &impl Fn(Option<Hit>) -> A,
) {
    if !ANY && tree.interleaves {
        return dispatch(level, Interleaved::<T, A, _> { tree, rays, which, answers, convert });
    }
    for places in which.runs(rays.len()) {
        let (rays, answers) = (&rays[places.clone()], &mut answers[places]);
        dispatch(level, InOrder::<ANY, T, A, _> { tree, rays, answers, convert, level });
    }
}
