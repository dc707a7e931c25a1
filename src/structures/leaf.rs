//! Triangles as leaves hold them, and the search through them.

use std::mem::MaybeUninit;

use crate::geometry::{Hit, Mesh, Ray};
use crate::simd::{LaneVec3, Lanes, Sieve, each};
use crate::triangle::{Depth, TriangleTest};

/// The nearest hit so far, or the end of the interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest<D> {
    /// A hit must lie at or before this `t`.
    pub t: f32,
    hit: Option<(D, u32)>,
}

impl<D: Depth> Nearest<D> {
    /// Nothing found yet, up to and with `last`.
    #[inline(always)]
    pub fn until(last: f32) -> Self {
        Self { t: last, hit: None }
    }

    /// Takes a hit that is nearer, or as near with a lower number.
    #[inline(always)]
    pub fn offer(&mut self, depth: D, id: u32) {
        let better = match &self.hit {
            Some((nearest, lowest)) => depth.order(nearest).then(id.cmp(lowest)).is_lt(),
            None => true,
        };
        if better {
            *self = Self { t: depth.bound(), hit: Some((depth, id)) };
        }
    }

    #[inline(always)]
    pub fn found(&self) -> bool {
        self.hit.is_some()
    }

    #[inline(always)]
    pub fn hit(&self) -> Option<Hit> {
        self.hit.map(|(depth, id)| Hit::new(depth.t(), id))
    }
}

/// Stands for no triangle in the lanes left over, and for no hit.
const NONE: u32 = u32::MAX;

/// Rays that are searched for together.
pub(crate) const RAYS: usize = 16;

/// What eight rays have found: where, or the end of the interval, and which triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestEight {
    pub t: [f32; 8],
    ids: [u32; 8],
}

/// What sixteen rays have found, as [`Nearest`] each.
pub(crate) struct Nearests<D> {
    pub halves: [NearestEight; 2],
    /// Of the hits that are more than a `t`.
    depths: [MaybeUninit<D>; RAYS],
}

impl<D: Depth> Nearests<D> {
    /// Nothing found yet, up to and with `last`.
    #[inline(always)]
    pub fn until(last: impl Fn(usize) -> f32) -> Self {
        let mut halves = [NearestEight { t: [0.0; 8], ids: [NONE; 8] }; 2];
        for i in 0..RAYS {
            halves[i / 8].t[i % 8] = last(i);
        }
        Self { halves, depths: [const { MaybeUninit::uninit() }; RAYS] }
    }

    #[inline(always)]
    pub fn t(&self, i: usize) -> f32 {
        self.halves[i / 8].t[i % 8]
    }

    /// Takes those of `hits`, lanes of `block` at `t`, that are nearer than what ray `i` has found, or as near with a lower number.
    #[inline(always)]
    fn offer<const N: usize, T: TriangleTest>(
        &mut self,
        i: usize,
        block: &LeafBlock<T, N>,
        mut hits: u32,
        t: &[f32; N],
    ) {
        let half = &mut self.halves[i / 8];
        let (own_t, own_id) = (&mut half.t[i % 8], &mut half.ids[i % 8]);
        while hits != 0 {
            let lane = hits.trailing_zeros() as usize % N;
            hits &= hits - 1;
            let (t, id) = (t[lane], block.ids[lane]);
            if t < *own_t || t == *own_t && id < *own_id {
                (*own_t, *own_id) = (t, id);
            }
        }
    }

    /// Whether ray `i` has found something.
    #[inline(always)]
    pub fn has(&self, i: usize) -> bool {
        self.halves[i / 8].ids[i % 8] != NONE
    }

    /// Those that have found something, as bits.
    #[inline(always)]
    pub fn found(&self) -> u16 {
        let ids = self.halves.iter().flat_map(|half| &half.ids);
        ids.enumerate().fold(0, |found, (i, &id)| found | u16::from(id != NONE) << i)
    }

    #[inline(always)]
    pub fn get(&self, i: usize) -> Nearest<D> {
        let (t, id) = (self.t(i), self.halves[i / 8].ids[i % 8]);
        // SAFETY: written with the number of what was found, where it is more than its `t`.
        let depth = || D::of(t).unwrap_or_else(|| unsafe { self.depths[i].assume_init() });
        Nearest { t, hit: (id != NONE).then(|| (depth(), id)) }
    }

    #[inline(always)]
    pub fn set(&mut self, i: usize, nearest: Nearest<D>) {
        let half = &mut self.halves[i / 8];
        if let Some((depth, id)) = nearest.hit {
            (half.t[i % 8], half.ids[i % 8]) = (nearest.t, id);
            self.depths[i].write(depth);
        }
    }
}

/// At most `N` triangles, tested at once.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct LeafBlock<T: TriangleTest, const N: usize> {
    triangles: T::Block<N>,
    ids: [u32; N],
}

impl<T: TriangleTest, const N: usize> LeafBlock<T, N> {
    /// Blocks for the triangles `ids` of `mesh`, in that order.
    pub fn fill(mesh: &Mesh, ids: &[u32], blocks: &mut Vec<Self>) {
        blocks.extend(ids.chunks(N).map(|ids| {
            let mut corners = [[glam::Vec3::ZERO; 3]; N];
            let mut padded = [NONE; N];
            for (lane, &id) in ids.iter().enumerate() {
                corners[lane] = mesh.corners(id);
                padded[lane] = id;
            }
            Self { triangles: T::block(&corners[..ids.len()]), ids: padded }
        }));
    }

    /// The triangles in it.
    pub fn ids(&self) -> impl Iterator<Item = u32> + '_ {
        self.ids.iter().copied().filter(|&id| id != NONE)
    }

    /// How many there are.
    #[inline(always)]
    pub fn len(&self) -> u32 {
        self.ids.iter().map(|&id| u32::from(id != NONE)).sum()
    }

    /// Bytes of triangle data and of triangle numbers in a block.
    pub const BYTES: (usize, usize) = (size_of::<Self>() - size_of::<[u32; N]>(), size_of::<[u32; N]>());
}

/// Remembers triangles that a ray has been tested against: a direct-mapped cache of the last triangle for each of eight hash
/// values (Havran 2000).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mailbox([u32; 8]);

impl Mailbox {
    pub const EMPTY: Self = Self([NONE; 8]);

    /// Whether triangle `id` is remembered; from now on it is.
    #[inline(always)]
    fn visit(&mut self, id: u32) -> bool {
        std::mem::replace(&mut self.0[(id & 7) as usize], id) == id
    }
}

/// Searches the `count` triangles in the blocks of one leaf and returns how many were tested. With `ANY`, returns at the
/// first block with a hit in the interval.
#[inline(always)]
pub(crate) fn search<const ANY: bool, const N: usize, L: Lanes<N>, T: TriangleTest>(
    blocks: &[LeafBlock<T, N>],
    count: u32,
    ray: &T::Ray,
    t_min: f32,
    nearest: &mut Nearest<T::Depth>,
    mailbox: &mut Option<Mailbox>,
) -> u32 {
    let mut tested = 0;
    for (i, block) in blocks.iter().enumerate() {
        let mut fresh = (count - (i * N) as u32).min(N as u32);
        if let Some(mailbox) = mailbox {
            fresh = block.ids.iter().filter(|&&id| id != NONE && !mailbox.visit(id)).count() as u32;
        }
        if fresh == 0 {
            continue;
        }
        tested += fresh;
        let (candidates, known) = T::candidates::<N, L>(ray, &block.triangles, t_min, nearest.t);
        if candidates != 0 {
            settle(block, ray, candidates, known.store(), nearest);
            if ANY && nearest.found() {
                break;
            }
        }
    }
    tested
}

/// What is found of a block before it is settled, for each ray. Not initialised: most packets end without a candidate
/// of most of their rays.
pub(crate) struct Found<const N: usize>([MaybeUninit<(u32, [f32; N])>; RAYS]);

impl<const N: usize> Found<N> {
    /// Nothing yet.
    #[inline(always)]
    pub fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; RAYS])
    }
}

/// Rays as a test wants them, prepared when they first come to a leaf: many never do.
pub(crate) struct Prepared<T: TriangleTest> {
    rays: [MaybeUninit<T::Ray>; RAYS],
    ready: u16,
}

impl<T: TriangleTest> Prepared<T> {
    /// None of them yet.
    #[inline(always)]
    pub fn new() -> Self {
        Self { rays: [const { MaybeUninit::uninit() }; RAYS], ready: 0 }
    }

    /// Prepares those of `rays` that are in `which`, as bits.
    #[inline(always)]
    pub fn prepare(&mut self, rays: &[Ray; RAYS], which: u16) {
        let mut missing = which & !self.ready;
        self.ready |= missing;
        while missing != 0 {
            let i = missing.trailing_zeros() as usize % RAYS;
            missing &= missing - 1;
            self.rays[i].write(T::prepare(&rays[i]));
        }
    }

    /// # Safety
    /// Ray `i` has been prepared.
    #[inline(always)]
    pub unsafe fn get(&self, i: usize) -> &T::Ray {
        debug_assert!(self.ready >> i & 1 == 1);
        // SAFETY: it was written when it was prepared.
        unsafe { self.rays[i].assume_init_ref() }
    }
}

/// Searches the blocks of one leaf for the rays `taking_part`, as bits: each finds what it would find alone. With `ANY`, rays that
/// have a hit look no further.
///
/// The candidates of all rays come before what is decided about them: whether there are any cannot be predicted, and one wrong
/// guess costs as much as the tests of two rays.
///
/// # Safety
/// The rays that take part have been prepared.
#[inline(always)]
pub(crate) unsafe fn search_for_each<const ANY: bool, const N: usize, L: Lanes<N>, T: TriangleTest>(
    blocks: &[LeafBlock<T, N>],
    mut taking_part: u16,
    rays: &Prepared<T>,
    t_min: &[f32; RAYS],
    nearest: &mut Nearests<T::Depth>,
    found: &mut Found<N>,
) {
    for block in blocks {
        let (mut left, mut met) = (taking_part, 0);
        while left != 0 {
            let i = left.trailing_zeros() as usize % RAYS;
            left &= left - 1;
            // SAFETY: as the caller says.
            let ray = unsafe { rays.get(i) };
            let (candidates, known) = T::candidates::<N, L>(ray, &block.triangles, t_min[i], nearest.t(i));
            found.0[i].write((candidates, known.store()));
            met |= u16::from(candidates != 0) << i;
        }
        while met != 0 {
            let i = met.trailing_zeros() as usize % RAYS;
            met &= met - 1;
            // SAFETY: written above for this block, as `met` says.
            let ((candidates, known), ray) = unsafe { (found.0[i].assume_init(), rays.get(i)) };
            if T::ACROSS {
                nearest.offer(i, block, candidates, &known);
            } else {
                let mut own = nearest.get(i);
                settle(block, ray, candidates, known, &mut own);
                nearest.set(i, own);
            }
            if ANY && nearest.has(i) {
                taking_part &= !(1 << i);
            }
        }
    }
}

/// Rays side by side: their origins, their directions and where they start.
pub(crate) type Abreast<L> = (LaneVec3<8, L>, LaneVec3<8, L>, L);

/// Searches the blocks of one leaf for the rays `which`, as bits, triangle by triangle: each finds what it would find alone. Where a
/// half of the rays looks no further is returned.
///
/// Nothing is decided by a branch: whether some ray meets a triangle cannot be predicted.
#[inline(always)]
pub(crate) fn search_across<const N: usize, L: Sieve, T: TriangleTest>(
    blocks: &[LeafBlock<T, N>],
    which: u16,
    abreast: &[Abreast<L>; 2],
    nearest: &mut [NearestEight; 2],
) -> [L; 2] {
    let which = [u32::from(which & 0xff), u32::from(which >> 8)];
    let masks = each(&which, |&which| L::mask(which));
    let mut nearest_t = each(nearest, |half| L::load(&half.t));
    let mut ids = each(nearest, |half| L::numbers(&half.ids));
    for block in blocks {
        for (lane, &id) in block.ids.iter().enumerate() {
            if id == NONE {
                break;
            }
            for half in 0..2 {
                if which[half] == 0 {
                    continue;
                }
                let (origin, direction, t_min) = abreast[half];
                let (met, t) = T::across(origin, direction, &block.triangles, lane);
                // An overflow may have made t NaN: such a lane hits nothing.
                let within = L::both(t_min.mask_le(t), t.mask_le(nearest_t[half]));
                let met = L::both(L::both(met, masks[half]), within);
                // As near with a lower number is nearer.
                let own = L::splat_number(id);
                let nearer = t.mask_lt(nearest_t[half]);
                let own = L::choose_numbers(own, L::least_numbers(own, ids[half]), nearer);
                ids[half] = L::choose_numbers(own, ids[half], met);
                nearest_t[half] = t.choose(nearest_t[half], met);
            }
        }
    }
    for half in 0..2 {
        nearest[half] = NearestEight { t: nearest_t[half].store(), ids: L::store_numbers(ids[half]) };
    }
    nearest_t
}

/// Decides about the candidates of a block. Rare, and out of line, so that it does not cost the walk its registers.
#[inline(never)]
fn settle<const N: usize, T: TriangleTest>(
    block: &LeafBlock<T, N>,
    ray: &T::Ray,
    mut candidates: u32,
    known: [f32; N],
    nearest: &mut Nearest<T::Depth>,
) {
    while candidates != 0 {
        let lane = candidates.trailing_zeros() as usize;
        candidates &= candidates - 1;
        // A triangle of several leaves is met again.
        let id = block.ids[lane];
        if nearest.hit.as_ref().is_some_and(|(_, nearest)| *nearest == id) {
            continue;
        }
        if let Some(depth) = T::decide(ray, &block.triangles, lane, known[lane]) {
            nearest.offer(depth, id);
        }
    }
}

/// What every query starts with: the prepared ray and its interval, or nothing when the ray can hit nothing.
#[inline(always)]
pub(crate) fn start<T: TriangleTest>(ray: &Ray) -> Option<(T::Ray, f32, Nearest<T::Depth>)> {
    let (t_min, t_max) = ray.interval();
    ray.is_valid().then(|| (T::prepare(ray), t_min, Nearest::until(T::last(t_max))))
}
