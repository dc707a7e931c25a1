use super::node::WIDTH;
use crate::simd::{EightLanes, each};
use crate::traversal::leaf::{LeafBlock, NONE, Nearest};
use crate::triangle::{Depth, EightHits, TriangleTest};

pub(super) const RAYS: usize = 16;
pub(super) const HALVES: usize = RAYS / WIDTH;

/// A [`Nearest`] for each of sixteen rays, in structure-of-arrays layout.
///
/// If `T::ONE_STAGE` is true, a hit consists only of `t` and `ids`.
pub(super) struct PacketHits<'a, T: TriangleTest> {
    blocks: &'a [LeafBlock<T>],
    /// Upper bounds of the exact `t` of the hits. Without a hit, the last `t` that the ray accepts.
    t: [[f32; WIDTH]; HALVES],
    /// Lower bounds of the exact `t` of the hits. Without a hit, the lower bound is infinite.
    least: [[f32; WIDTH]; HALVES],
    /// The numbers of the hit triangles, or [`NONE`].
    ids: [[u32; WIDTH]; HALVES],
    /// The positions of the hit triangles. A position is 8 * block + lane.
    ///
    /// Positions of the rays in `found_by_single_search` are unused.
    places: [[u32; WIDTH]; HALVES],
    /// The hit depth of each ray in `found_by_single_search`.
    depths: [Option<T::Depth<'a>>; RAYS],
    /// Bit `i` is set if [`set`](Self::set) stored the nearest hit of ray `i`.
    found_by_single_search: u16,
}

#[derive(Clone, Copy)]
pub(super) struct HitLanes<L: EightLanes> {
    pub t: L,
    least: L,
    ids: L::Numbers,
    places: L::Numbers,
    /// The rays that have found a nearer hit since the lanes were loaded.
    fresh: L::Mask,
}

impl<L: EightLanes> HitLanes<L> {
    /// In each active lane, keeps the nearer of the stored hit and the hit of triangle `id`.
    ///
    /// Returns the undecided active lanes as bits.
    #[inline(always)]
    pub fn offer<T: TriangleTest>(&mut self, active: L::Mask, found: &EightHits<L>, id: u32, place: u32) -> u32 {
        let id = L::splat_number(id);
        let not_above = L::cmp_le_numbers(id, self.ids);
        let met = L::both(found.met, active);
        if T::ONE_STAGE {
            let as_near = L::both(found.high.cmp_le(self.t), not_above);
            let better = L::both(met, L::either(found.high.cmp_lt(self.t), as_near));
            self.t = found.high.choose(self.t, better);
            self.ids = L::choose_numbers(id, self.ids, better);
            return 0;
        }
        let nearer = L::both(met, found.high.cmp_lt(self.least));
        // Several leaves may reference the triangle of the nearest hit.
        let again = L::both(not_above, L::cmp_le_numbers(self.ids, id));
        let further = L::both(met, self.t.cmp_lt(found.low));
        let known = L::either(L::either(nearer, further), L::either(found.missed, again));
        self.t = found.high.choose(self.t, nearer);
        self.least = found.low.choose(self.least, nearer);
        self.ids = L::choose_numbers(id, self.ids, nearer);
        self.places = L::choose_numbers(L::splat_number(place), self.places, nearer);
        self.fresh = L::either(self.fresh, nearer);
        L::bits(active) & !L::bits(known)
    }
}

impl<'a, T: TriangleTest> PacketHits<'a, T> {
    /// Ray `i` accepts only hits with a `t` of at most `last(i)`.
    #[inline(always)]
    pub fn until(blocks: &'a [LeafBlock<T>], last: impl Fn(usize) -> f32) -> Self {
        let mut hits = Self {
            blocks,
            t: [[0.0; WIDTH]; HALVES],
            least: [[f32::INFINITY; WIDTH]; HALVES],
            ids: [[NONE; WIDTH]; HALVES],
            places: [[0; WIDTH]; HALVES],
            depths: [const { None }; RAYS],
            found_by_single_search: 0,
        };
        for i in 0..RAYS {
            hits.t[i / WIDTH][i % WIDTH] = last(i);
        }
        hits
    }

    #[inline(always)]
    pub fn t(&self, i: usize) -> f32 {
        self.t[i / WIDTH][i % WIDTH]
    }

    #[inline(always)]
    pub fn get(&self, i: usize) -> Nearest<T::Depth<'a>> {
        let (t, id) = (self.t(i), self.ids[i / WIDTH][i % WIDTH]);
        Nearest { t, hit: (id != NONE).then(|| (self.depth(i), id)) }
    }

    /// Ray `i` must have a hit.
    #[inline(always)]
    pub fn depth(&self, i: usize) -> T::Depth<'a> {
        let (half, lane) = (i / WIDTH, i % WIDTH);
        if let Some(depth) = T::Depth::of(self.t[half][lane]) {
            return depth;
        }
        if self.found_by_single_search >> i & 1 == 1 {
            return self.depths[i].expect("a hit has a depth");
        }
        let place = self.places[half][lane] as usize;
        let triangles = &self.blocks[place / WIDTH].triangles;
        T::depth_between(triangles, place % WIDTH, self.least[half][lane], self.t[half][lane])
    }

    #[inline(always)]
    pub fn set(&mut self, i: usize, nearest: Nearest<T::Depth<'a>>) {
        if let Some((depth, id)) = nearest.hit {
            let (half, lane) = (i / WIDTH, i % WIDTH);
            (self.t[half][lane], self.least[half][lane], self.ids[half][lane]) = (nearest.t, depth.least(), id);
            self.depths[i] = Some(depth);
            self.found_by_single_search |= 1 << i;
        }
    }

    /// Like [`Nearest::offer`], for ray `i` and a test whose depth is a float.
    #[inline(always)]
    pub fn offer(&mut self, i: usize, t: f32, id: u32) {
        let (own, own_id) = (&mut self.t[i / WIDTH][i % WIDTH], &mut self.ids[i / WIDTH][i % WIDTH]);
        if t < *own || t == *own && id < *own_id {
            (*own, *own_id) = (t, id);
        }
    }

    /// Like [`offer`](Self::offer), for a depth with bounds.
    ///
    /// Returns false if the bounds do not decide which hit is nearer.
    #[inline(always)]
    pub fn offer_between(&mut self, i: usize, depth: &T::Depth<'_>, id: u32, place: u32) -> bool {
        let (half, lane) = (i / WIDTH, i % WIDTH);
        if depth.bound() < self.least[half][lane] {
            (self.t[half][lane], self.least[half][lane]) = (depth.bound(), depth.least());
            (self.ids[half][lane], self.places[half][lane]) = (id, place);
            self.found_by_single_search &= !(1 << i);
            return true;
        }
        self.t[half][lane] < depth.least()
    }

    #[inline(always)]
    pub fn id(&self, i: usize) -> u32 {
        self.ids[i / WIDTH][i % WIDTH]
    }

    #[inline(always)]
    pub fn has_found(&self, i: usize) -> bool {
        self.ids[i / WIDTH][i % WIDTH] != NONE
    }

    #[inline(always)]
    pub fn found(&self) -> u16 {
        self.ids.as_flattened().iter().enumerate().fold(0, |found, (i, &id)| found | u16::from(id != NONE) << i)
    }

    #[inline(always)]
    pub fn lanes<L: EightLanes>(&self) -> [HitLanes<L>; HALVES] {
        let half = |half: usize| HitLanes {
            t: L::load(&self.t[half]),
            least: L::load(&self.least[half]),
            ids: L::numbers(&self.ids[half]),
            places: L::numbers(&self.places[half]),
            fresh: L::mask(0),
        };
        [half(0), half(1)]
    }

    #[inline(always)]
    pub fn set_lanes<L: EightLanes>(&mut self, lanes: &[HitLanes<L>; HALVES]) {
        self.t = each(lanes, |half| half.t.store());
        self.ids = each(lanes, |half| L::store_numbers(half.ids));
        if !T::ONE_STAGE {
            self.least = each(lanes, |half| half.least.store());
            self.places = each(lanes, |half| L::store_numbers(half.places));
            self.found_by_single_search &= !((L::bits(lanes[0].fresh) | L::bits(lanes[1].fresh) << WIDTH) as u16);
        }
    }
}
