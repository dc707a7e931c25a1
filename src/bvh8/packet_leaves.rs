//! What sixteen rays that travel together have for themselves, and how they search a leaf.

use std::mem::MaybeUninit;

use super::node::WIDTH;
use super::packet_hits::{HALVES, Nearests, RAYS};
use super::ray_packet::Beams;
use crate::geometry::{Hit, Ray};
use crate::simd::{Sieve, each};
use crate::traversal::leaf::{LeafBlock, NONE, Nearest, settle};
use crate::triangle::TriangleTest;

/// From so many rays on a leaf may be searched triangle by triangle. Of fewer, hardly any finds something, which is soon known ray by
/// ray; and both halves have some.
const MANY: u32 = 12;

pub(super) struct Travellers<'a, T: TriangleTest> {
    rays: &'a [Ray; RAYS],
    /// The rays as their test wants them, from their first leaf on: many never come to one.
    prepared: [MaybeUninit<T::Ray>; RAYS],
    ready: u16,
    nearest: Nearests<T::Depth>,
    t_min: [f32; RAYS],
    candidates: [MaybeUninit<Candidates>; RAYS],
    /// Those that still look for a hit, as bits.
    looking: u16,
}

/// The lanes of a block that a ray may hit, and what is known of them.
type Candidates = (u32, [f32; WIDTH]);

impl<'a, T: TriangleTest> Travellers<'a, T> {
    /// They get their ends in `beams`.
    #[inline(always)]
    pub fn new<L: Sieve>(rays: &'a [Ray; RAYS], beams: &mut Beams<L>) -> Self {
        let nearest = Nearests::until(|i| T::last(rays[i].t_max));
        beams.end_all(each(&nearest.lanes::<L>(), |half| half.t));
        Self {
            rays,
            prepared: [const { MaybeUninit::uninit() }; RAYS],
            ready: 0,
            nearest,
            t_min: beams.t_min(),
            candidates: [const { MaybeUninit::uninit() }; RAYS],
            looking: u16::MAX,
        }
    }

    #[inline(always)]
    pub fn looking(&self) -> u16 {
        self.looking
    }

    #[inline(always)]
    pub fn hit(&self, i: usize) -> Option<Hit> {
        self.nearest.get(i).hit()
    }

    /// Ray `i` for a search of its own: as its test wants it, where it starts and what it has found.
    #[inline(always)]
    pub fn alone(&mut self, i: usize) -> (&T::Ray, f32, Nearest<T::Depth>) {
        self.prepare(1 << i);
        // SAFETY: prepared.
        (unsafe { self.prepared(i) }, self.t_min[i], self.nearest.get(i))
    }

    /// Takes what ray `i` has found alone.
    #[inline(always)]
    pub fn back<const ANY: bool, L: Sieve>(&mut self, i: usize, nearest: Nearest<T::Depth>, beams: &mut Beams<L>) {
        self.nearest.set(i, nearest);
        self.update::<ANY, L>(i, beams);
    }

    /// Searches the blocks of a leaf for the rays `taking_part`, as bits: each finds what it would find alone.
    #[inline(always)]
    pub fn search<const ANY: bool, L: Sieve>(
        &mut self,
        blocks: &[LeafBlock<T, WIDTH>],
        taking_part: u16,
        beams: &mut Beams<L>,
    ) {
        // Ray by ray takes a step for each ray and block, triangle by triangle one for each triangle and half of the rays.
        let rays = taking_part.count_ones();
        let triangles = || blocks.iter().map(LeafBlock::len).sum::<u32>();
        if T::ACROSS && rays >= MANY && triangles() * HALVES as u32 <= rays * blocks.len() as u32 {
            self.across(blocks, taking_part, beams);
            if ANY {
                self.looking &= !self.nearest.found();
            }
        } else {
            self.ray_by_ray::<ANY, L>(blocks, taking_part, beams);
        }
    }

    /// Triangle by triangle, half of the rays at once. Nothing is decided by a branch: whether some ray meets a triangle cannot be
    /// predicted.
    #[inline(always)]
    fn across<L: Sieve>(&mut self, blocks: &[LeafBlock<T, WIDTH>], taking_part: u16, beams: &mut Beams<L>) {
        let taking_part = [L::mask(u32::from(taking_part & 0xff)), L::mask(u32::from(taking_part >> WIDTH))];
        let abreast = beams.abreast();
        let mut nearest = self.nearest.lanes::<L>();
        for block in blocks {
            for (lane, &id) in block.ids.iter().enumerate() {
                if id == NONE {
                    break;
                }
                for half in 0..HALVES {
                    let (origin, direction, t_min) = abreast[half];
                    let (met, t) = T::across(origin, direction, &block.triangles, lane);
                    // An overflow may have made t NaN: such a lane hits nothing.
                    let within = L::both(t_min.mask_le(t), t.mask_le(nearest[half].t));
                    nearest[half].offer(L::both(L::both(met, taking_part[half]), within), t, id);
                }
            }
        }
        self.nearest.set_lanes(&nearest);
        beams.end_all(each(&nearest, |half| half.t));
    }

    /// Ray by ray, the triangles of a block at once. The candidates of all rays come before what is decided about them: whether there
    /// are any cannot be predicted, and one wrong guess costs as much as the tests of two rays. With `ANY`, rays that have a hit look no
    /// further.
    #[inline(always)]
    fn ray_by_ray<const ANY: bool, L: Sieve>(
        &mut self,
        blocks: &[LeafBlock<T, WIDTH>],
        taking_part: u16,
        beams: &mut Beams<L>,
    ) {
        self.prepare(taking_part);
        let mut searching = taking_part;
        for block in blocks {
            let (mut left, mut met) = (searching, 0);
            while left != 0 {
                let i = left.trailing_zeros() as usize % RAYS;
                left &= left - 1;
                // SAFETY: prepared.
                let ray = unsafe { self.prepared(i) };
                let (candidates, known) =
                    T::candidates::<WIDTH, L>(ray, &block.triangles, self.t_min[i], self.nearest.t(i));
                self.candidates[i].write((candidates, known.store()));
                met |= u16::from(candidates != 0) << i;
            }
            while met != 0 {
                let i = met.trailing_zeros() as usize % RAYS;
                met &= met - 1;
                // SAFETY: written above for this block, as `met` says.
                let candidates = unsafe { self.candidates[i].assume_init() };
                // SAFETY: prepared, as all that take part.
                unsafe { self.settle(block, i, candidates) };
                if ANY && self.nearest.has_found(i) {
                    searching &= !(1 << i);
                }
            }
        }
        let mut left = taking_part;
        while left != 0 {
            let i = left.trailing_zeros() as usize % RAYS;
            left &= left - 1;
            self.update::<ANY, L>(i, beams);
        }
    }

    /// Decides about the candidates of ray `i`.
    ///
    /// # Safety
    /// It is prepared.
    #[inline(always)]
    unsafe fn settle(&mut self, block: &LeafBlock<T, WIDTH>, i: usize, (mut candidates, known): Candidates) {
        if T::ACROSS {
            // They are hits already: that needs no call.
            while candidates != 0 {
                let lane = candidates.trailing_zeros() as usize % WIDTH;
                candidates &= candidates - 1;
                self.nearest.offer(i, known[lane], block.ids[lane]);
            }
        } else {
            let mut nearest = self.nearest.get(i);
            // SAFETY: prepared, as the caller says.
            settle(block, unsafe { self.prepared(i) }, candidates, known, &mut nearest);
            self.nearest.set(i, nearest);
        }
    }

    /// Ray `i` as its test wants it.
    ///
    /// # Safety
    /// It is prepared.
    #[inline(always)]
    unsafe fn prepared(&self, i: usize) -> &T::Ray {
        debug_assert!(self.ready >> i & 1 == 1);
        // SAFETY: written when it was prepared.
        unsafe { self.prepared[i].assume_init_ref() }
    }

    /// Prepares the rays `which`, as bits.
    #[inline(always)]
    fn prepare(&mut self, which: u16) {
        let mut missing = which & !self.ready;
        self.ready |= missing;
        while missing != 0 {
            let i = missing.trailing_zeros() as usize % RAYS;
            missing &= missing - 1;
            self.prepared[i].write(T::prepare(&self.rays[i]));
        }
    }

    /// Takes note of what ray `i` has found.
    #[inline(always)]
    fn update<const ANY: bool, L: Sieve>(&mut self, i: usize, beams: &mut Beams<L>) {
        if ANY && self.nearest.has_found(i) {
            self.looking &= !(1 << i);
        }
        beams.end(i, self.nearest.t(i));
    }
}
