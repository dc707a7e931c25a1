//! Searches for the cheapest spatial split of a node.

use glam::Vec3A;

use super::offer::{Context, Offer, cheaper};
use crate::build::axes::on_axes;
use crate::build::cut::Cut;
use crate::build::extent::Extent;
use crate::build::planes::{PLANES, Planes};
use crate::build::reference::{PARALLEL, Reference};
use crate::build::sample::Sample;
use crate::build::slices::slice;
use crate::geometry::{Aabb, Mesh};

/// Maximum number of slots. Slot `2 i` is bin `i`. Slot `2 i + 1` is plane `i`.
const SLOTS: usize = 2 * PLANES + 2;

/// The arrays have one element per slot.
///
/// The box of the parts below a plane is the union of the boxes that begin below, cut off there. A reference therefore
/// updates only the slots in which it begins and ends. A sliced triangle grows the extents of all its bins.
pub(super) struct Slots {
    /// The number of references that begin in the slot.
    begin: [u32; SLOTS],
    /// The number of references that end in the slot.
    end: [u32; SLOTS],
    begin_extents: [Extent; SLOTS],
    end_extents: [Extent; SLOTS],
    /// The union of `end_extents` of all higher slots.
    above: [Extent; SLOTS],
}

impl Slots {
    pub fn new() -> Box<Self> {
        let empty = [Extent::EMPTY; SLOTS];
        let none = [0; SLOTS];
        Box::new(Self { begin: none, end: none, begin_extents: empty, end_extents: empty, above: empty })
    }

    fn clear(&mut self, planes: &Planes) {
        let slots = 2 * planes.bins();
        self.begin[..slots].fill(0);
        self.end[..slots].fill(0);
        self.begin_extents[..slots].fill(Extent::EMPTY);
        self.end_extents[..slots].fill(Extent::EMPTY);
    }

    fn add<const AXIS: usize, const SLICED: bool>(&mut self, mesh: &Mesh, sample: &Sample, planes: &Planes) {
        for r in sample.iter() {
            let (first, last) = (planes.first_bin(r.min(AXIS)), planes.last_bin(r.max(AXIS)));
            // If `first > last`, the reference lies in plane `last`. Then `begin` and `end` equal `2 * last + 1`.
            let (begin, end) = (first + first.min(last), last + last.max(first));
            self.begin[begin] += 1;
            self.end[end] += 1;
            if SLICED && first < last {
                let corners = mesh.corners(r.id()).map(Vec3A::from);
                slice::<AXIS>(corners, r.extent(), planes, (first, last), |bin, slice| {
                    self.begin_extents[2 * bin].grow(slice);
                    self.end_extents[2 * bin].grow(slice);
                });
            } else {
                self.begin_extents[begin].grow(r.extent());
                self.end_extents[end].grow(r.extent());
            }
        }
    }

    /// The `usize` in the result is the index of the plane.
    fn sweep(&mut self, context: &Context, planes: &Planes, node: &Node) -> Option<Offer<(Cut, usize)>> {
        let slots = 2 * planes.bins() - 1;
        let mut above = Extent::EMPTY;
        for slot in (1..slots).rev() {
            above.grow(self.end_extents[slot]);
            self.above[slot - 1] = above;
        }

        // Each plane has two candidates: references in the plane go above (even `slot`) or below (odd `slot`).
        let mut best: Option<Offer<(Cut, usize)>> = None;
        let mut below = Extent::EMPTY;
        let (mut begun, mut ended) = (0, 0);
        for slot in 0..slots - 1 {
            below.grow(self.begin_extents[slot]);
            begun += self.begin[slot] as usize;
            ended += self.end[slot] as usize;
            let (at, flat_below) = (slot / 2, slot % 2 == 1);
            let (left, right) = (begun, node.sample.len() - ended);
            let same = flat_below && self.begin[slot] == 0;
            if same || left == 0 || right == 0 || left.min(right) == node.sample.len() || !planes.is_new(at) {
                continue;
            }
            let (axis, plane) = (planes.axis, planes.value(at));
            let sides = [below.up_to(axis, plane), self.above[slot].down_to(axis, plane)];
            let counts = [left, right].map(|count| node.sample.scaled(count));
            let cost = context.costs.box_split(node.area, sides.map(|side| side.half_area()), counts);
            if best.is_none_or(|b| cost < b.cost) && node.affords(counts) {
                let cut = Cut { axis, plane, flat_below };
                best = Some(Offer { cost, split: (cut, at), sides, counts });
            }
        }
        best
    }
}

/// The two sides of the cut together have at most `budget` references.
pub(super) fn cheapest_cut(
    context: &Context,
    references: &[Reference],
    extent: Extent,
    budget: f64,
    slots: &mut Slots,
) -> Option<Offer<Cut>> {
    let all = Node { sample: Sample::all(references), area: extent.half_area(), budget };
    let some = Node { sample: Sample::new(references, context.config.sample), ..all };
    let mut offer = some.cheapest(context, extent, slots)?;
    if some.sample.len() < references.len() {
        // The counts of a sample are estimates, so count all references.
        offer.counts = offer.split.counts(references);
        if !some.affords(offer.counts) {
            return all.cheapest(context, extent, slots);
        }
    }
    Some(offer)
}

struct Node<'a> {
    sample: Sample<'a>,
    area: f64,
    budget: f64,
}

impl Node<'_> {
    fn affords(&self, [below, above]: [usize; 2]) -> bool {
        (below + above) as f64 <= self.budget
    }

    fn cheapest(&self, context: &Context, extent: Extent, slots: &mut Slots) -> Option<Offer<Cut>> {
        let config = context.config;
        let bounds = Aabb::from(extent);
        let candidates = (config.candidates as usize).min(self.sample.len());
        let along = |axis, slots: &mut Slots| {
            let planes = Planes::new(axis, (bounds.min[axis], bounds.max[axis]), candidates, &self.sample)?;
            self.along(context, &planes, slots).map(|offer| offer.map(|(cut, at)| (cut, planes.around(at))))
        };
        let [x, y, z] = if self.sample.len() < PARALLEL {
            [0, 1, 2].map(|axis| along(axis, slots))
        } else {
            on_axes(true, |axis| along(axis, &mut Slots::new()))
        };
        let coarse = cheaper(cheaper(x, y), z)?;
        let (Cut { axis, .. }, around) = coarse.split;
        let coarse = coarse.map(|(cut, _)| cut);
        if self.sample.len() < config.refined as usize {
            return Some(coarse);
        }

        let planes = Planes::new(axis, around, candidates, &self.sample);
        let fine = planes.and_then(|planes| self.along(context, &planes, slots)).map(|o| o.map(|(cut, _)| cut));
        cheaper(Some(coarse), fine)
    }

    fn along(&self, context: &Context, planes: &Planes, slots: &mut Slots) -> Option<Offer<(Cut, usize)>> {
        let (mesh, sample) = (context.mesh, &self.sample);
        slots.clear(planes);
        match (planes.axis, sample.whole() <= context.config.sliced as usize) {
            (0, false) => slots.add::<0, false>(mesh, sample, planes),
            (1, false) => slots.add::<1, false>(mesh, sample, planes),
            (_, false) => slots.add::<2, false>(mesh, sample, planes),
            (0, true) => slots.add::<0, true>(mesh, sample, planes),
            (1, true) => slots.add::<1, true>(mesh, sample, planes),
            (_, true) => slots.add::<2, true>(mesh, sample, planes),
        }
        slots.sweep(context, planes, self)
    }
}
