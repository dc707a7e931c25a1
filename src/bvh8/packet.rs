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

use super::frustum::Frustum;
use super::node::{Child, WIDTH};
use super::packet_hits::RAYS;
use super::packet_leaves::Travellers;
use super::ray_packet::Beams;
use super::stack::SIZE;
use super::tree::Bvh8;
use crate::geometry::{Hit, Ray};
use crate::simd::Sieve;
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

impl<T: TriangleTest> Bvh8<T> {
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
        let mut travellers = Travellers::<T>::new(rays, &mut beams);
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
                if len == 0 || travellers.looking() == 0 {
                    for (i, answer) in answers.iter_mut().enumerate() {
                        *answer = form(travellers.hit(i));
                    }
                    return true;
                }
                len -= 1;
                // SAFETY: what is below the length was written, and names a node.
                let (entry, node) = unsafe {
                    let entry = stack.get_unchecked(len).assume_init();
                    (entry, self.nodes.get_unchecked(entry.parent as usize))
                };
                taking_part = entry.rays & travellers.looking();
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
        while taking_part != 0 {
            let i = taking_part.trailing_zeros() as usize % RAYS;
            taking_part &= taking_part - 1;
            let beam = beams.single(i);
            let (ray, t_min, mut nearest) = travellers.alone(i);
            self.descend::<ANY, L, ()>(child, &beam, ray, t_min, &mut nearest, &mut ());
            travellers.back::<ANY, L>(i, nearest, beams);
        }
    }
}
