//! Traces sixteen rays as a packet.
//!
//! **Packets and single rays find the same hits.** [`Frustum`] rejects only boxes that every ray misses.
//! [`RayPacket::meet`] computes crossings like `PreparedRay::cross`, so no ray misses a box with a nearer hit. If the
//! test of eight rays cannot decide which hit is nearer, `ray_by_ray` searches the leaf again for the undecided rays.
//! The nearest hit does not depend on the order in which hits are found.

use std::mem::MaybeUninit;

use super::frustum::Frustum;
use super::node::{Child, WIDTH};
use super::packet_hits::RAYS;
use super::packet_state::PacketState;
use super::ray_packet::RayPacket;
use super::stack::{Entries, OnePage, SIZE, Stack};
use super::tree::Bvh8;
use crate::geometry::{Hit, Ray};
use crate::simd::{EightLanes, Level};
use crate::triangle::TriangleTest;

/// If at most this many rays visit a subtree, the rays search the subtree one by one.
const MAX_RAYS_ONE_BY_ONE: u32 = 3;

/// All lanes, with three bits per lane. Lane 0 is in the lowest three bits.
const IN_LANES: u32 = 0o76543210;

/// The box of `child` is in `lane` of the node `parent`. Bit `i` of `rays` is set if ray `i` may visit `child`.
#[derive(Clone, Copy)]
struct Entry {
    child: Child,
    parent: u32,
    lane: u16,
    rays: u16,
}

impl<T: TriangleTest> Bvh8<T> {
    /// Returns false if the rays cannot form a packet.
    #[inline(always)]
    pub(super) fn intersect_packet<'a, const ANY: bool, L: EightLanes, A>(
        &'a self,
        level: Level,
        rays: &'a [Ray; RAYS],
        answers: &mut [A; RAYS],
        convert: &impl Fn(Option<Hit>) -> A,
    ) -> bool {
        let Some(mut packet) = RayPacket::<L>::new(rays, &self.bounds) else { return false };
        let frustum = Frustum::new(&packet);
        let mut state = PacketState::<T>::new(rays, &self.blocks, &mut packet);
        let mut stack = [const { MaybeUninit::<Entry>::uninit() }; SIZE];
        let mut len = 0;
        let (mut child, mut active) = (self.root, u16::MAX);
        loop {
            if let Some((first, count)) = child.blocks() {
                // SAFETY: a leaf refers to a range of `blocks` (invariants of `Bvh8`).
                let blocks = unsafe { self.blocks.get_unchecked(first..first + count) };
                state.search::<ANY, L>(first, blocks, active, &mut packet);
            } else if active.count_ones() <= MAX_RAYS_ONE_BY_ONE {
                self.one_by_one::<ANY, L>(child, active, &mut packet, &mut state);
            } else {
                // SAFETY: a child that is not a leaf is an index into `nodes` (invariants of `Bvh8`). A path has at
                // most `DEPTH` nodes (invariants of `Bvh8`). Each earlier node of the path has at most seven entries
                // on the stack. So the stack has space for eight more entries (see `SIZE`).
                unsafe {
                    let node = self.nodes.get_unchecked(child.index());
                    let met = frustum.meet(node);
                    let order = if ANY { IN_LANES } else { node.orders[packet.octant & 7] };
                    for i in 0..WIDTH {
                        let lane = (order >> (3 * i) & 7) as usize;
                        let entry = Entry {
                            child: node.children[lane],
                            parent: child.index() as u32,
                            lane: lane as u16,
                            rays: active,
                        };
                        stack.get_unchecked_mut(len).write(entry);
                        len += (met >> lane & 1) as usize;
                    }
                }
            }
            loop {
                if len == 0 || state.unfinished == 0 {
                    state.answer::<ANY, L>(level, &packet, |i, hit| answers[i] = convert(hit));
                    return true;
                }
                len -= 1;
                // SAFETY: all entries below `len` are written. The `parent` of an entry is an index into `nodes`.
                let (entry, node) = unsafe {
                    let entry = stack.get_unchecked(len).assume_init();
                    (entry, self.nodes.get_unchecked(entry.parent as usize))
                };
                active = entry.rays & state.unfinished;
                if active != 0 {
                    active &= packet.meet(node, entry.lane as usize);
                }
                if active != 0 {
                    child = entry.child;
                    break;
                }
            }
        }
    }

    #[inline(always)]
    fn one_by_one<'a, const ANY: bool, L: EightLanes>(
        &'a self,
        child: Child,
        mut active: u16,
        packet: &mut RayPacket<L>,
        state: &mut PacketState<'a, T>,
    ) {
        while active != 0 {
            let i = active.trailing_zeros() as usize % RAYS;
            active &= active - 1;
            let prepared_ray = packet.single(i);
            let (ray, mut nearest) = state.single(i);
            let OnePage(_, entries) = &mut OnePage::new(Entries::new());
            // SAFETY: the contract of `Stack::of` allows the length 0.
            let mut stack = unsafe { Stack::<ANY>::of(entries, 0) };
            self.descend::<ANY, L, ()>(child, &mut stack, &prepared_ray, ray, &mut nearest, &mut ());
            state.put_back::<ANY, L>(i, nearest, packet);
        }
    }
}
