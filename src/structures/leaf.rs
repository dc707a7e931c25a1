//! Triangles as leaves hold them, and the search through them.

use crate::geometry::{Hit, Mesh, Ray};
use crate::simd::Lanes;
use crate::triangle::TriangleTest;

/// The nearest hit so far, or the end of the interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// A hit must lie at or before this `t`.
    pub t: f32,
    id: u32,
}

impl Nearest {
    const NONE: u32 = u32::MAX;

    /// Nothing found yet. The open end `t_max` > 0 becomes the closed end just before it.
    #[inline(always)]
    pub fn before(t_max: f32) -> Self {
        Self { t: t_max.next_down(), id: Self::NONE }
    }

    #[inline(always)]
    fn offer(&mut self, t: f32, id: u32) {
        if t < self.t || (t == self.t && id < self.id) {
            *self = Self { t, id };
        }
    }

    #[inline(always)]
    pub fn found(&self) -> bool {
        self.id != Self::NONE
    }

    #[inline(always)]
    pub fn hit(&self) -> Option<Hit> {
        self.found().then(|| Hit::new(self.t, self.id))
    }
}

/// At most `N` triangles, tested at once.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
pub(crate) struct LeafBlock<T: TriangleTest, const N: usize> {
    triangles: T::Block<N>,
    ids: [u32; N],
}

impl<T: TriangleTest, const N: usize> LeafBlock<T, N> {
    /// Blocks for the triangles `ids` of `mesh`, in that order.
    pub fn fill(mesh: &Mesh, ids: &[u32], blocks: &mut Vec<Self>) {
        blocks.extend(ids.chunks(N).map(|ids| {
            let mut corners = [[glam::Vec3::ZERO; 3]; N];
            let mut padded = [Nearest::NONE; N];
            for (lane, &id) in ids.iter().enumerate() {
                corners[lane] = mesh.corners(id);
                padded[lane] = id;
            }
            Self { triangles: T::block(&corners[..ids.len()]), ids: padded }
        }));
    }

    /// Bytes of triangle data and of triangle numbers in a block.
    pub const BYTES: (usize, usize) = (size_of::<Self>() - size_of::<[u32; N]>(), size_of::<[u32; N]>());
}

/// Remembers triangles that a ray has been tested against.
pub(crate) trait Mailbox {
    /// Whether anything is remembered at all.
    const ACTIVE: bool;

    /// Whether triangle `id` is remembered; from now on it is.
    fn visit(&mut self, id: u32) -> bool;
}

/// No mailbox.
impl Mailbox for () {
    const ACTIVE: bool = false;

    #[inline(always)]
    fn visit(&mut self, _: u32) -> bool {
        false
    }
}

/// A direct-mapped cache of the last triangle for each of eight hash values (Havran 2000).
impl Mailbox for [u32; 8] {
    const ACTIVE: bool = true;

    #[inline(always)]
    fn visit(&mut self, id: u32) -> bool {
        std::mem::replace(&mut self[(id & 7) as usize], id) == id
    }
}

/// Searches the `count` triangles in the blocks of one leaf and returns how many were tested. With `ANY`, returns at the
/// first block with a hit in the interval.
#[inline(always)]
pub(crate) fn search<const ANY: bool, const N: usize, L: Lanes<N>, T: TriangleTest, M: Mailbox>(
    blocks: &[LeafBlock<T, N>],
    count: u32,
    ray: &T::Ray,
    t_min: f32,
    nearest: &mut Nearest,
    mailbox: &mut M,
) -> u32 {
    let mut tested = 0;
    for (i, block) in blocks.iter().enumerate() {
        let mut fresh = (count - (i * N) as u32).min(N as u32);
        if M::ACTIVE {
            fresh = block.ids.iter().filter(|&&id| id != Nearest::NONE && !mailbox.visit(id)).count() as u32;
        }
        if fresh == 0 {
            continue;
        }
        tested += fresh;
        let (hit, t) = T::hits::<N, L>(ray, &block.triangles);
        let mut hit = hit & L::splat(t_min).le(t) & t.le(L::splat(nearest.t));
        if hit != 0 {
            let t = t.store();
            while hit != 0 {
                let lane = hit.trailing_zeros() as usize;
                nearest.offer(t[lane], block.ids[lane]);
                hit &= hit - 1;
            }
            if ANY {
                break;
            }
        }
    }
    tested
}

/// What every query starts with: the prepared ray and its interval, or nothing when the ray can hit nothing.
#[inline(always)]
pub(crate) fn start<T: TriangleTest>(ray: &Ray) -> Option<(T::Ray, f32, Nearest)> {
    let (t_min, t_max) = ray.interval();
    ray.is_valid().then(|| (T::prepare(ray), t_min, Nearest::before(t_max)))
}
