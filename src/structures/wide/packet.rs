//! Sixteen rays that travel together.
//!
//! **The same answers as one by one.** A packet visits the children of a node in the order of the octant, which its rays
//! share, and a ray takes part in a visit just when its own test of the box says so, with its own end. What the packet decides
//! for all rays at once only leaves out boxes that each of them would leave out (see [`Frustum`]). So every ray goes through the
//! same leaves in the same order as alone.

use std::mem::MaybeUninit;

use super::WideTree;
use super::beams::{Beams, RAYS};
use super::frustum::Frustum;
use super::node::{Child, WIDTH};
use super::stack::SIZE;
use crate::geometry::{Hit, Ray};
use crate::simd::{Sieve, each};
use crate::structures::leaf::{Found, LeafBlock, Nearest, Prepared, search_for_each};
use crate::triangle::TriangleTest;

/// At most this many rays that are left go on alone.
const FEW: u32 = 3;

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
    prepared: Prepared<T, RAYS>,
    nearest: [Nearest<T::Depth>; RAYS],
    t_min: [f32; RAYS],
    found: Found<WIDTH, RAYS>,
    /// Those that still look for a hit, as bits.
    looking: u16,
}

impl<'a, T: TriangleTest> Travellers<'a, T> {
    #[inline(always)]
    fn new(rays: &'a [Ray; RAYS], t_min: [f32; RAYS]) -> Self {
        Self {
            rays,
            prepared: Prepared::new(),
            nearest: each(rays, |ray| Nearest::until(T::last(ray.t_max))),
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
        let Self { rays, prepared, nearest, t_min, found, .. } = self;
        prepared.prepare(rays, taking_part);
        // SAFETY: prepared.
        unsafe {
            search_for_each::<ANY, WIDTH, RAYS, L, T>(blocks, taking_part, prepared, t_min, nearest, found);
        }
        while taking_part != 0 {
            let i = taking_part.trailing_zeros() as usize % RAYS;
            taking_part &= taking_part - 1;
            if ANY && nearest[i].found() {
                self.looking &= !(1 << i);
            }
            beams.end(i, nearest[i].t);
        }
    }
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
        for (i, nearest) in travellers.nearest.iter().enumerate() {
            beams.end(i, nearest.t);
        }
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
                    for (answer, nearest) in answers.iter_mut().zip(&travellers.nearest) {
                        *answer = form(nearest.hit());
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
            let (prepared, nearest) = unsafe { (travellers.prepared.get(i), &mut travellers.nearest[i]) };
            let t_min = travellers.t_min[i];
            self.descend::<ANY, L, ()>(child, &beams.single(i), prepared, t_min, nearest, &mut ());
            if ANY && nearest.found() {
                travellers.looking &= !(1 << i);
            }
            beams.end(i, nearest.t);
        }
    }
}
