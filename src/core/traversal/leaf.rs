//! Storage and search of the triangles in leaves.

use std::cmp::Ordering;

use crate::accel::{Footprint, Observer};
use crate::geometry::{Hit, Mesh, Ray};
use crate::simd::EightLanes;
use crate::triangle::{BLOCK, Depth, TriangleTest};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest<D> {
    /// An upper bound for the `t` of nearer hits.
    pub t: f32,
    pub hit: Option<(D, u32)>,
}

impl<D: Depth> Nearest<D> {
    pub const NOTHING: Self = Self { t: 0.0, hit: None };

    #[inline(always)]
    pub fn until(last: f32) -> Self {
        Self { t: last, hit: None }
    }

    /// At equal depths, the lower triangle number wins.
    #[inline(always)]
    pub fn offer(&mut self, depth: D, id: u32, order: impl FnOnce(&D, &D) -> Ordering) {
        let better = match &self.hit {
            Some((nearest, lowest)) => order(&depth, nearest).then(id.cmp(lowest)).is_lt(),
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

    /// With `ANY`, the `t` of the hit is only an upper bound.
    #[inline(always)]
    pub fn answer<const ANY: bool>(&self, ray: &Ray) -> Option<Hit> {
        let (depth, id) = self.hit.as_ref()?;
        Some(Hit::new(if ANY { depth.bound() } else { depth.t(ray) }, *id))
    }
}

/// The triangle number in unused lanes.
pub(crate) const NONE: u32 = u32::MAX;

#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct LeafBlock<T: TriangleTest> {
    pub triangles: T::Block<BLOCK>,
    pub ids: [u32; BLOCK],
}

impl<T: TriangleTest> LeafBlock<T> {
    pub fn fill(mesh: &Mesh, ids: &[u32], blocks: &mut Vec<Self>) {
        blocks.extend(ids.chunks(BLOCK).map(|ids| {
            let mut corners = [[glam::Vec3::ZERO; 3]; BLOCK];
            let mut padded = [NONE; BLOCK];
            for (lane, &id) in ids.iter().enumerate() {
                corners[lane] = mesh.corners(id);
                padded[lane] = id;
            }
            Self { triangles: T::block(&corners[..ids.len()]), ids: padded }
        }));
    }

    #[inline(always)]
    pub fn len(&self) -> u32 {
        self.ids.iter().map(|&id| u32::from(id != NONE)).sum()
    }

    pub fn footprint(blocks: &[Self]) -> Footprint {
        let references = blocks.len() * size_of::<[u32; BLOCK]>();
        Footprint { triangles: size_of_val(blocks) - references, references, ..Footprint::default() }
    }
}

/// Up to 8 triangles that a ray already tested (Havran 2000). `search` skips a block if the mailbox contains all
/// triangles of the block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mailbox([u32; 8]);

impl Mailbox {
    pub const EMPTY: Self = Self([NONE; 8]);

    /// Stores `id`. Returns whether the mailbox already contained `id`.
    #[inline(always)]
    fn visit(&mut self, id: u32) -> bool {
        std::mem::replace(&mut self.0[(id & 7) as usize], id) == id
    }
}

/// `count` must be at least the number of triangles in `blocks`. A larger `count` affects only `observer`.
#[inline(always)]
pub(crate) fn search<'a, const ANY: bool, L: EightLanes, T: TriangleTest, O: Observer>(
    blocks: &'a [LeafBlock<T>],
    count: u32,
    ray: &T::Ray,
    t_min: f32,
    nearest: &mut Nearest<T::Depth<'a>>,
    mailbox: &mut Option<Mailbox>,
    observer: &mut O,
) {
    for (i, block) in blocks.iter().enumerate() {
        let mut fresh = (count - (i * BLOCK) as u32).min(BLOCK as u32);
        if let Some(mailbox) = mailbox {
            fresh = block.ids.iter().filter(|&&id| id != NONE && !mailbox.visit(id)).count() as u32;
        }
        if fresh == 0 {
            continue;
        }
        observer.test(fresh);
        let (candidates, first) = T::candidates::<BLOCK, L>(ray, &block.triangles, t_min, nearest.t);
        if candidates != 0 {
            settle(block, ray, candidates, &T::values(first), nearest);
            if ANY && nearest.found() {
                break;
            }
        }
    }
}

/// Not inlined, because inlined code would take registers from the traversal. The tail calls of [`settle_closely`] must
/// stay the only calls, because any other call would save registers to the stack.
#[inline(never)]
pub(crate) fn settle<'a, T: TriangleTest>(
    block: &'a LeafBlock<T>,
    ray: &T::Ray,
    mut candidates: u32,
    values: &T::Values<BLOCK>,
    nearest: &mut Nearest<T::Depth<'a>>,
) {
    while candidates != 0 {
        // `% BLOCK` saves a bounds check.
        let lane = candidates.trailing_zeros() as usize % BLOCK;
        let id = block.ids[lane];
        // A search of another leaf may already have found triangle `id`.
        if nearest.hit.as_ref().is_none_or(|(_, nearest)| *nearest != id) {
            let Some(decided) = T::decide_at_once(ray, &block.triangles, lane, values) else {
                return settle_closely(block, ray, candidates, values, nearest);
            };
            if let Some(depth) = decided {
                let better = match &nearest.hit {
                    None => true,
                    Some((other, lowest)) => match depth.order(other) {
                        Some(order) => order.then(id.cmp(lowest)).is_lt(),
                        None => return settle_closely(block, ray, candidates, values, nearest),
                    },
                };
                if better {
                    *nearest = Nearest { t: depth.bound(), hit: Some((depth, id)) };
                }
            }
        }
        candidates &= candidates - 1;
    }
}

/// `look_closer` saves time only for more than `FEW` candidates.
const FEW: u32 = 2;

#[inline(never)]
fn settle_closely<'a, T: TriangleTest>(
    block: &'a LeafBlock<T>,
    ray: &T::Ray,
    mut candidates: u32,
    values: &T::Values<BLOCK>,
    nearest: &mut Nearest<T::Depth<'a>>,
) {
    let closer;
    let mut values = values;
    if candidates.count_ones() > FEW {
        let nearest = nearest.hit.as_ref().map(|(depth, _)| depth);
        if let Some((left, refined)) = T::look_closer(ray, &block.triangles, candidates, values, nearest) {
            (candidates, closer) = (left, refined);
            values = &closer;
        }
    }
    while candidates != 0 {
        let lane = candidates.trailing_zeros() as usize;
        candidates &= candidates - 1;
        let id = block.ids[lane];
        if nearest.hit.as_ref().is_some_and(|(_, nearest)| *nearest == id) {
            continue;
        }
        if let Some(depth) = T::decide(ray, &block.triangles, lane, values) {
            nearest.offer(depth, id, |one, other| T::order(ray, one, other));
        }
    }
}

/// The caller prepares the ray. Returning a prepared ray would copy values just written, which stalls the processor.
#[inline(always)]
pub(crate) fn start<'a, T: TriangleTest>(ray: &Ray) -> Option<(f32, Nearest<T::Depth<'a>>)> {
    let (t_min, t_max) = ray.interval();
    ray.is_valid().then(|| (t_min, Nearest::until(T::last(t_max))))
}
