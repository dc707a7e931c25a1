//! Triangles as leaves hold them, and the search through them.

use crate::accel::Observer;
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

/// Searches the blocks of one leaf; with `ANY`, returns at the first hit in the interval.
#[inline(always)]
pub(crate) fn search<const ANY: bool, const N: usize, L: Lanes<N>, T: TriangleTest>(
    blocks: &[LeafBlock<T, N>],
    ray: &T::Ray,
    t_min: f32,
    nearest: &mut Nearest,
) {
    for block in blocks {
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
                return;
            }
        }
    }
}

/// What every query starts with: the prepared ray and its interval, or nothing when the ray can hit nothing.
#[inline(always)]
pub(crate) fn start<T: TriangleTest>(ray: &Ray) -> Option<(T::Ray, f32, Nearest)> {
    let (t_min, t_max) = ray.interval();
    ray.is_valid().then(|| (T::prepare(ray), t_min, Nearest::before(t_max)))
}

/// Tells the observer of a leaf visit.
#[inline(always)]
pub(crate) fn observe<O: Observer>(observer: &mut O, references: u32) {
    observer.leaf(references);
    observer.test(references);
}
