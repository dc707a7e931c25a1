//! Sixteen rays that travel together.
//!
//! **The same answers as one by one.** A packet visits the children of a node in the order of the octant, which its rays
//! share, and a ray takes part in a visit just when its own test of the box says so, with its own end. What the packet decides
//! for all rays at once only leaves out boxes that each of them would leave out (see [`Frustum`]). So every ray goes through the
//! same leaves in the same order as alone.
//!
//! A leaf that nearly all rays come to is searched triangle by triangle, eight rays at once, without a branch that depends on what is
//! found; others ray by ray. The nearest of the same hits is the same in either order.

use std::mem::MaybeUninit;

use super::WideTree;
use super::beams::Beams;
use super::frustum::Frustum;
use super::node::{Child, WIDTH};
use super::stack::SIZE;
use crate::geometry::{Hit, Ray};
use crate::simd::{Sieve, each};
use crate::structures::leaf::{Found, LeafBlock, Nearests, Prepared, RAYS, search_across, search_for_each};
use crate::triangle::TriangleTest;

/// At most this many rays that are left go on alone.
const FEW: u32 = 3;

/// From so many rays on a leaf may be searched triangle by triangle: of fewer, hardly any finds something, and ray by ray that is
/// soon known.
const MANY: u32 = 12;

/// The order of the lanes.
const IN_LANES: u32 = 0o76543210;

/// A child to visit, which box it has, and for which rays.
#[derive(Clone, Copy)]
struct Entry {
    child: Child,
    parent: u32,
    lane: u16,
    rays: u16,
}

/// What each ray of a packet has for itself.
struct Travellers<'a, T: TriangleTest> {
    rays: &'a [Ray; RAYS],
    prepared: Prepared<T>,
    nearest: Nearests<T::Depth>,
    t_min: [f32; RAYS],
    found: Found<WIDTH>,
    /// Those that still look for a hit, as bits.
    looking: u16,
}

impl<'a, T: TriangleTest> Travellers<'a, T> {
    #[inline(always)]
    fn new(rays: &'a [Ray; RAYS], t_min: [f32; RAYS]) -> Self {
        Self {
            rays,
            prepared: Prepared::new(),
            nearest: Nearests::until(|i| T::last(rays[i].t_max)),
            t_min,
            found: Found::new(),
            looking: u16::MAX,
        }
    }

    /// Searches a leaf for the rays `taking_part`.
    #[inline(always)]
    fn search<const ANY: bool, L: Sieve>(
        &mut self,
        blocks: &[LeafBlock<T, WIDTH>],
        mut taking_part: u16,
        beams: &mut Beams<L>,
    ) {
        let Self { rays, prepared, nearest, t_min, found, looking } = self;
        if T::ACROSS && taking_part.count_ones() >= MANY && across(blocks, taking_part) {
            let ends = search_across(blocks, taking_part, &beams.abreast(), &mut nearest.halves);
            beams.end_all(ends);
            if ANY {
                *looking &= !nearest.found();
            }
            return;
        }
        prepared.prepare(rays, taking_part);
        // SAFETY: prepared.
        unsafe {
            search_for_each::<ANY, WIDTH, L, T>(blocks, taking_part, prepared, t_min, nearest, found);
        }
        while taking_part != 0 {
            let i = taking_part.trailing_zeros() as usize % RAYS;
            taking_part &= taking_part - 1;
            if ANY && nearest.has(i) {
                *looking &= !(1 << i);
            }
            beams.end(i, nearest.t(i));
        }
    }
}

/// Whether it takes fewer steps to test triangle by triangle, half of the rays at once, than ray by ray, eight triangles at once.
#[inline(always)]
fn across<T: TriangleTest>(blocks: &[LeafBlock<T, WIDTH>], taking_part: u16) -> bool {
    let halves = u32::from(taking_part & 0xff != 0) + u32::from(taking_part >> WIDTH != 0);
    let triangles: u32 = blocks.iter().map(LeafBlock::len).sum();
    triangles * halves <= taking_part.count_ones() * blocks.len() as u32
}

impl<T: TriangleTest> WideTree<T> {
    /// Answers sixteen rays; false if they cannot travel together.
    #[inline(always)]
    pub(super) fn packet<const ANY: bool, L: Sieve, A>(
        &self,
        rays: &[Ray; RAYS],
        answers: &mut [A; RAYS],
        form: &impl Fn(Option<Hit>) -> A,
    ) -> bool {
        let Some(mut beams) = Beams::<L>::new(rays, &self.bounds) else { return false };
        let frustum = Frustum::new(&beams);
        let mut travellers = Travellers::<T>::new(rays, beams.t_min());
        beams.end_all(each(&travellers.nearest.halves, |half| L::load(&half.t)));
        let mut stack = [const { MaybeUninit::<Entry>::uninit() }; SIZE];
        let mut len = 0;
        let (mut child, mut taking_part) = (self.root, u16::MAX);
        loop {
            if let Some((first, count)) = child.blocks() {
                // SAFETY: leaves name blocks that are there.
                let blocks = unsafe { self.blocks.get_unchecked(first..first + count) };
                travellers.search::<ANY, L>(blocks, taking_part, &mut beams);
            } else if taking_part.count_ones() <= FEW {
                self.separately::<ANY, L>(child, taking_part, &mut beams, &mut travellers);
            } else {
                // SAFETY: children name nodes that are there; the depth was checked when the tree was built, so that no
                // more than seven entries a level are on the stack when eight are written.
                unsafe {
                    let node = self.nodes.get_unchecked(child.index());
                    let met = frustum.meet(node);
                    let order = if ANY { IN_LANES } else { node.orders[beams.octant & 7] };
                    for i in 0..WIDTH {
                        let lane = (order >> (3 * i) & 7) as usize;
                        let entry = Entry {
                            child: node.children[lane],
                            parent: child.index() as u32,
                            lane: lane as u16,
                            rays: taking_part,
                        };
                        stack.get_unchecked_mut(len).write(entry);
                        len += (met >> lane & 1) as usize;
                    }
                }
            }
            loop {
                if len == 0 || travellers.looking == 0 {
                    for (i, answer) in answers.iter_mut().enumerate() {
                        *answer = form(travellers.nearest.get(i).hit());
                    }
                    return true;
                }
                len -= 1;
                // SAFETY: what is below the length was written, and names a node.
                let (entry, node) = unsafe {
                    let entry = stack.get_unchecked(len).assume_init();
                    (entry, self.nodes.get_unchecked(entry.parent as usize))
                };
                taking_part = entry.rays & travellers.looking;
                if taking_part != 0 {
                    taking_part &= beams.meet(node, entry.lane as usize);
                }
                if taking_part != 0 {
                    child = entry.child;
                    break;
                }
            }
        }
    }

    /// Searches what is below `child` for the rays `taking_part`, one after the other.
    #[inline(always)]
    fn separately<const ANY: bool, L: Sieve>(
        &self,
        child: Child,
        mut taking_part: u16,
        beams: &mut Beams<L>,
        travellers: &mut Travellers<T>,
    ) {
        travellers.prepared.prepare(travellers.rays, taking_part);
        while taking_part != 0 {
            let i = taking_part.trailing_zeros() as usize % RAYS;
            taking_part &= taking_part - 1;
            // SAFETY: prepared.
            let prepared = unsafe { travellers.prepared.get(i) };
            let (t_min, mut nearest) = (travellers.t_min[i], travellers.nearest.get(i));
            self.descend::<ANY, L, ()>(child, &beams.single(i), prepared, t_min, &mut nearest, &mut ());
            travellers.nearest.set(i, nearest);
            if ANY && nearest.found() {
                travellers.looking &= !(1 << i);
            }
            beams.end(i, nearest.t);
        }
    }
}
