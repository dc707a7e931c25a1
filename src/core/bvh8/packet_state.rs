//! The state of the rays of a packet, and their search for hits in leaves.

use std::mem::MaybeUninit;

use super::node::WIDTH;
use super::packet_hits::{HALVES, PacketHits, RAYS};
use super::ray_packet::RayPacket;
use crate::geometry::{Hit, Ray};
use crate::simd::{EightLanes, Level, each};
use crate::traversal::leaf::{LeafBlock, NONE, Nearest, settle};
use crate::triangle::{BETWEEN_BOUNDS, Depth, ORIGIN, TriangleTest, last_bits};

/// Minimum number of active rays for `triangle_by_triangle`. Most rays of a smaller group hit no triangle, and
/// `ray_by_ray` detects misses sooner. The minimum exceeds `WIDTH`, so both halves have active rays.
const MIN_RAYS_BY_TRIANGLE: u32 = 12;

pub(super) struct PacketState<'a, T: TriangleTest> {
    rays: &'a [Ray; RAYS],
    /// Rays are prepared on demand, because many rays visit no leaf.
    prepared: [MaybeUninit<T::Ray>; RAYS],
    ready: u16,
    nearest: PacketHits<'a, T>,
    t_min: [f32; RAYS],
    candidates: [MaybeUninit<BlockCandidates<T>>; RAYS],
    pub unfinished: u16,
}

/// The candidate lanes of a block as bits, and the values of the first stage.
type BlockCandidates<T> = (u32, <T as TriangleTest>::Values<WIDTH>);

impl<'a, T: TriangleTest> PacketState<'a, T> {
    /// Also sets the ends of the rays in `packet`.
    #[inline(always)]
    pub fn new<L: EightLanes>(rays: &'a [Ray; RAYS], blocks: &'a [LeafBlock<T>], packet: &mut RayPacket<L>) -> Self {
        let nearest = PacketHits::until(blocks, |i| T::last(rays[i].t_max));
        packet.end_all(each(&nearest.lanes::<L>(), |half| half.t));
        Self {
            rays,
            prepared: [const { MaybeUninit::uninit() }; RAYS],
            ready: 0,
            nearest,
            t_min: packet.t_min(),
            candidates: [const { MaybeUninit::uninit() }; RAYS],
            unfinished: u16::MAX,
        }
    }

    #[allow(clippy::needless_range_loop)] // `lane` is an index into several arrays
    #[inline(always)]
    pub fn answer<const ANY: bool, L: EightLanes>(
        &self,
        level: Level,
        packet: &RayPacket<L>,
        mut answer: impl FnMut(usize, Option<Hit>),
    ) {
        if ANY || !T::Depth::LATE {
            for (i, ray) in self.rays.iter().enumerate() {
                answer(i, self.nearest.get(i).answer::<ANY>(ray));
            }
            return;
        }
        for half in 0..HALVES {
            let (mut inputs, mut found) = (packet.inputs(half), 0);
            for lane in 0..WIDTH {
                let i = half * WIDTH + lane;
                if self.nearest.has_found(i) {
                    found |= 1 << lane;
                    let own = self.nearest.depth(i).inputs(&self.rays[i]);
                    // `packet.inputs` has filled the columns of the origin and the direction.
                    for column in (0..ORIGIN).chain([BETWEEN_BOUNDS]) {
                        inputs[column][lane] = own[column];
                    }
                }
            }
            let ts = if found == 0 { [0.0; WIDTH] } else { last_bits::<T::Depth<'_>>(level, &inputs, found) };
            for lane in 0..WIDTH {
                let i = half * WIDTH + lane;
                answer(i, (found >> lane & 1 == 1).then(|| Hit::new(ts[lane], self.nearest.id(i))));
            }
        }
    }

    #[inline(always)]
    pub fn single(&mut self, i: usize) -> (&T::Ray, Nearest<T::Depth<'a>>) {
        self.prepare(1 << i);
        // SAFETY: the line above has prepared ray `i`.
        (unsafe { self.prepared(i) }, self.nearest.get(i))
    }

    #[inline(always)]
    pub fn put_back<const ANY: bool, L: EightLanes>(
        &mut self,
        i: usize,
        nearest: Nearest<T::Depth<'a>>,
        packet: &mut RayPacket<L>,
    ) {
        self.nearest.set(i, nearest);
        self.update::<ANY, L>(i, packet);
    }

    #[inline(always)]
    pub fn search<const ANY: bool, L: EightLanes>(
        &mut self,
        first: usize,
        blocks: &'a [LeafBlock<T>],
        active: u16,
        packet: &mut RayPacket<L>,
    ) {
        // Choose the search with fewer steps. `triangle_by_triangle` takes `HALVES` steps per triangle.
        // `ray_by_ray` takes one step per ray and block.
        let rays = active.count_ones();
        let triangles = || blocks.iter().map(LeafBlock::len).sum::<u32>();
        let pays =
            T::EIGHT && rays >= MIN_RAYS_BY_TRIANGLE && triangles() * HALVES as u32 <= rays * blocks.len() as u32;
        let mut left = active;
        if pays {
            left = self.triangle_by_triangle(first, blocks, active, packet);
            if ANY {
                self.unfinished &= !self.nearest.found();
                left &= self.unfinished;
            }
        }
        if left != 0 {
            self.ray_by_ray::<ANY, L>(first, blocks, left, packet);
        }
    }

    /// Returns, as bits, the rays that still need `ray_by_ray`.
    #[inline(always)]
    fn triangle_by_triangle<L: EightLanes>(
        &mut self,
        first: usize,
        blocks: &'a [LeafBlock<T>],
        active: u16,
        packet: &mut RayPacket<L>,
    ) -> u16 {
        let active = [L::mask(u32::from(active & 0xff)), L::mask(u32::from(active >> WIDTH))];
        let halves = [packet.half(0), packet.half(1)];
        let mut nearest = self.nearest.lanes::<L>();
        let mut left = 0;
        for (number, block) in (first..).zip(blocks) {
            for (lane, &id) in block.ids.iter().enumerate() {
                if id == NONE {
                    break;
                }
                let place = (number * WIDTH + lane) as u32;
                for half in 0..HALVES {
                    let to = nearest[half].t;
                    if let Some(found) = T::meet_eight(&halves[half], &block.triangles, lane, to, active[half]) {
                        left |= nearest[half].offer::<T>(active[half], &found, id, place) << (half * WIDTH);
                    }
                }
            }
        }
        self.nearest.set_lanes(&nearest);
        packet.end_all(each(&nearest, |half| half.t));
        left as u16
    }

    #[inline(always)]
    fn ray_by_ray<const ANY: bool, L: EightLanes>(
        &mut self,
        first: usize,
        blocks: &'a [LeafBlock<T>],
        active: u16,
        packet: &mut RayPacket<L>,
    ) {
        self.prepare(active);
        let mut searching = active;
        for (number, block) in (first..).zip(blocks) {
            let (mut left, mut met) = (searching, 0);
            while left != 0 {
                let i = left.trailing_zeros() as usize % RAYS;
                left &= left - 1;
                // SAFETY: `prepare` above has written the rays of `active`. `left` is a subset of `active`.
                let ray = unsafe { self.prepared[i].assume_init_ref() };
                let (candidates, first) =
                    T::candidates::<WIDTH, L>(ray, &block.triangles, self.t_min[i], self.nearest.t(i));
                // For a one-stage test, the values are stored without a branch.
                if T::ONE_STAGE || candidates != 0 {
                    self.candidates[i].write((candidates, T::values(first)));
                }
                met |= u16::from(candidates != 0) << i;
            }
            while met != 0 {
                let i = met.trailing_zeros() as usize % RAYS;
                met &= met - 1;
                // SAFETY: the loop above has written `self.candidates[i]` for each ray `i` in `met`.
                let candidates = unsafe { self.candidates[i].assume_init() };
                // SAFETY: `prepare` above has prepared the rays of `active`. `met` is a subset of `active`.
                unsafe { self.settle(number, block, i, candidates) };
                if ANY && self.nearest.has_found(i) {
                    searching &= !(1 << i);
                }
            }
        }
        let mut left = active;
        while left != 0 {
            let i = left.trailing_zeros() as usize % RAYS;
            left &= left - 1;
            self.update::<ANY, L>(i, packet);
        }
    }

    /// # Safety
    /// [`prepare`](Self::prepare) has prepared ray `i`.
    #[inline(always)]
    unsafe fn settle(
        &mut self,
        number: usize,
        block: &'a LeafBlock<T>,
        i: usize,
        (mut candidates, values): BlockCandidates<T>,
    ) {
        if T::ONE_STAGE {
            // All candidates of a one-stage test are hits.
            while candidates != 0 {
                let lane = candidates.trailing_zeros() as usize % WIDTH;
                candidates &= candidates - 1;
                // SAFETY: by the contract of this function ray `i` is prepared.
                let depth = T::decide(unsafe { self.prepared(i) }, &block.triangles, lane, &values);
                self.nearest.offer(i, depth.expect("the first stage has decided").bound(), block.ids[lane]);
            }
        } else {
            while candidates != 0 {
                let lane = candidates.trailing_zeros() as usize % WIDTH;
                let (id, place) = (block.ids[lane], (number * WIDTH + lane) as u32);
                // Several leaves may reference the triangle of the nearest hit.
                let decided = self.nearest.id(i) == id || {
                    // SAFETY: by the contract of this function ray `i` is prepared.
                    match T::decide_at_once(unsafe { self.prepared(i) }, &block.triangles, lane, &values) {
                        Some(Some(depth)) => self.nearest.offer_between(i, &depth, id, place),
                        Some(None) => true,
                        None => false,
                    }
                };
                if !decided {
                    let mut nearest = self.nearest.get(i);
                    // SAFETY: by the contract of this function ray `i` is prepared.
                    settle(block, unsafe { self.prepared(i) }, candidates, &values, &mut nearest);
                    return self.nearest.set(i, nearest);
                }
                candidates &= candidates - 1;
            }
        }
    }

    /// # Safety
    /// [`prepare`](Self::prepare) has prepared ray `i`.
    #[inline(always)]
    unsafe fn prepared(&self, i: usize) -> &T::Ray {
        debug_assert!(self.ready >> i & 1 == 1);
        // SAFETY: by the contract of this function `prepare` has written ray `i`. Written rays stay initialised.
        unsafe { self.prepared[i].assume_init_ref() }
    }

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

    #[inline(always)]
    fn update<const ANY: bool, L: EightLanes>(&mut self, i: usize, packet: &mut RayPacket<L>) {
        if ANY && self.nearest.has_found(i) {
            self.unfinished &= !(1 << i);
        }
        packet.end(i, self.nearest.t(i));
    }
}
