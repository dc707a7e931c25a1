//! Traces sixteen rays as a packet.
//!
//! **A packet finds the same hits as single rays.** The rays of a packet share an octant, so one visiting order serves
//! all rays. [`Frustum`] rejects only boxes that every ray misses. So each ray visits at least the leaves that a single
//! ray visits. The nearest hit does not depend on the order in which hits are found.

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

/// Maximum number of rays that search a subtree one by one instead of as a packet.
const MAX_RAYS_ONE_BY_ONE: u32 = 3;

/// The lanes in ascending order, three bits per lane, lane 0 lowest.
const IN_LANES: u32 = 0o76543210;

/// The box of `child` is in `lane` of the node `parent`. The bits of `rays` are the rays that may visit `child`.
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
                // SAFETY: a leaf names a range of `blocks` (invariants of `Bvh8`).
                let blocks = unsafe { self.blocks.get_unchecked(first..first + count) };
                state.search::<ANY, L>(first, blocks, active, &mut packet);
            } else if active.count_ones() <= MAX_RAYS_ONE_BY_ONE {
                self.one_by_one::<ANY, L>(child, active, &mut packet, &mut state);
            } else {
                // SAFETY: a child that is not a leaf names one of `nodes` (invariants of `Bvh8`). A path has at most
                // `DEPTH` nodes (invariants of `Bvh8`). Each node above has left at most seven entries, so eight more
                // fit in `SIZE`.
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
                // SAFETY: entries are written before `len` counts them. The `parent` of an entry is a node.
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
            // SAFETY: a stack of length 0 has no entries to read; `push` writes entries before it counts them.
            let mut stack = unsafe { Stack::<ANY>::of(entries, 0) };
            self.descend::<ANY, L, ()>(child, &mut stack, &prepared_ray, ray, &mut nearest, &mut ());
            state.put_back::<ANY, L>(i, nearest, packet);
        }
    }
}
