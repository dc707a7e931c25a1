use super::node::WIDTH;
use crate::simd::{EightLanes, each};
use crate::traversal::leaf::{NONE, Nearest};
use crate::triangle::Depth;

/// Rays that travel together.
pub(super) const RAYS: usize = 16;
pub(super) const HALVES: usize = RAYS / WIDTH;

/// The nearest hits of sixteen rays so far, or the ends of their intervals, side by side: a [`Nearest`] each.
pub(super) struct PacketHits<D> {
    t: [[f32; WIDTH]; HALVES],
    /// [`NONE`] where nothing is found.
    ids: [[u32; WIDTH]; HALVES],
    /// Of hits that are more than their `t`.
    depths: [Option<D>; RAYS],
}

/// Those of one half of the rays, in lanes.
#[derive(Clone, Copy)]
pub(super) struct HitLanes<L: EightLanes> {
    pub t: L,
    ids: L::Numbers,
}

impl<L: EightLanes> HitLanes<L> {
    /// Takes in the lanes of `met` hits of triangle `id` at `t` that are nearer, or as near with a lower number.
    #[inline(always)]
    pub fn offer(&mut self, met: L::Mask, t: L, id: u32) {
        let id = L::splat_number(id);
        let as_near = L::both(t.cmp_le(self.t), L::cmp_le_numbers(id, self.ids));
        let better = L::both(met, L::either(t.cmp_lt(self.t), as_near));
        self.t = t.choose(self.t, better);
        self.ids = L::choose_numbers(id, self.ids, better);
    }
}

impl<D: Depth> PacketHits<D> {
    /// Nothing found yet, each ray up to and with its `last`.
    #[inline(always)]
    pub fn until(last: impl Fn(usize) -> f32) -> Self {
        let mut hits = Self { t: [[0.0; WIDTH]; HALVES], ids: [[NONE; WIDTH]; HALVES], depths: [const { None }; RAYS] };
        for i in 0..RAYS {
            hits.t[i / WIDTH][i % WIDTH] = last(i);
        }
        hits
    }

    /// Hits of ray `i` must lie at or before it.
    #[inline(always)]
    pub fn t(&self, i: usize) -> f32 {
        self.t[i / WIDTH][i % WIDTH]
    }

    #[inline(always)]
    pub fn get(&self, i: usize) -> Nearest<D> {
        let (t, id) = (self.t(i), self.ids[i / WIDTH][i % WIDTH]);
        let depth = || D::of(t).or(self.depths[i]).expect("what is found has a depth");
        Nearest { t, hit: (id != NONE).then(|| (depth(), id)) }
    }

    #[inline(always)]
    pub fn set(&mut self, i: usize, nearest: Nearest<D>) {
        if let Some((depth, id)) = nearest.hit {
            (self.t[i / WIDTH][i % WIDTH], self.ids[i / WIDTH][i % WIDTH]) = (nearest.t, id);
            self.depths[i] = Some(depth);
        }
    }

    /// As [`Nearest::offer`], for ray `i` and a hit that is no more than its `t`.
    #[inline(always)]
    pub fn offer(&mut self, i: usize, t: f32, id: u32) {
        let (own, own_id) = (&mut self.t[i / WIDTH][i % WIDTH], &mut self.ids[i / WIDTH][i % WIDTH]);
        if t < *own || t == *own && id < *own_id {
            (*own, *own_id) = (t, id);
        }
    }

    #[inline(always)]
    pub fn has_found(&self, i: usize) -> bool {
        self.ids[i / WIDTH][i % WIDTH] != NONE
    }

    /// The rays that have found something, as bits.
    #[inline(always)]
    pub fn found(&self) -> u16 {
        self.ids.as_flattened().iter().enumerate().fold(0, |found, (i, &id)| found | u16::from(id != NONE) << i)
    }

    #[inline(always)]
    pub fn lanes<L: EightLanes>(&self) -> [HitLanes<L>; HALVES] {
        let half = |half: usize| HitLanes { t: L::load(&self.t[half]), ids: L::numbers(&self.ids[half]) };
        [half(0), half(1)]
    }

    /// Of hits that are no more than their `t`.
    #[inline(always)]
    pub fn set_lanes<L: EightLanes>(&mut self, lanes: &[HitLanes<L>; HALVES]) {
        self.t = each(lanes, |half| half.t.store());
        self.ids = each(lanes, |half| L::store_numbers(half.ids));
    }
}
