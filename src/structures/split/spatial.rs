//! The cheapest plane of a node.

use glam::Vec3A;
use rayon::prelude::*;

use super::build::{CHUNK, Context, PARALLEL};
use super::chop::chop;
use super::cost::{Offer, cheaper};
use super::extent::Extent;
use super::planes::{PLANES, Planes};
use super::reference::Reference;
use crate::geometry::Aabb;

/// A plane that cuts the references of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    pub axis: usize,
    pub plane: f32,
    /// Whether references that lie in the plane go below; otherwise they go above.
    pub flat_below: bool,
}

/// Bins and planes in ascending order: slot `2 i` is bin `i`, slot `2 i + 1` holds what lies in plane `i`.
const SLOTS: usize = 2 * PLANES + 1;

/// What begins, ends and lies in each slot.
struct Slots {
    begin: [u32; SLOTS],
    end: [u32; SLOTS],
    extents: [Extent; SLOTS],
}

impl Slots {
    const EMPTY: Self = Self { begin: [0; SLOTS], end: [0; SLOTS], extents: [Extent::EMPTY; SLOTS] };

    #[inline(always)]
    fn grow(&mut self, slot: usize, extent: Extent) {
        self.extents[slot].grow(extent);
    }

    fn add<const AXIS: usize>(&mut self, context: &Context, references: &[Reference], planes: &Planes, chopped: bool) {
        for r in references {
            let (low, high) = (r.bounds.min.to_array()[AXIS], r.bounds.max.to_array()[AXIS]);
            let extent = r.extent();
            let (first, last) = if low < high {
                (2 * planes.first_bin(low), 2 * planes.last_bin(high))
            } else {
                let slot = planes.flat(low).map_or_else(|bin| 2 * bin, |plane| 2 * plane + 1);
                (slot, slot)
            };
            self.begin[first] += 1;
            self.end[last] += 1;
            if first == last {
                self.grow(first, extent);
            } else if chopped {
                let corners = context.mesh.corners(r.id).map(Vec3A::from);
                chop::<AXIS>(corners, extent, planes, (first / 2, last / 2), |bin, slice| self.grow(2 * bin, slice));
            } else {
                let mut from = low;
                for bin in first / 2..=last / 2 {
                    let to = if 2 * bin == last { high } else { planes.value(bin) };
                    if !to.is_nan() {
                        let (mut min, mut max) = (extent.min, extent.max);
                        (min[AXIS], max[AXIS]) = (from, to);
                        self.grow(2 * bin, Extent { min, max });
                        from = to;
                    }
                }
            }
        }
    }

    fn merge(mut self: Box<Self>, other: Box<Self>) -> Box<Self> {
        for slot in 0..SLOTS {
            self.begin[slot] += other.begin[slot];
            self.end[slot] += other.end[slot];
            self.extents[slot].grow(other.extents[slot]);
        }
        self
    }

    /// The cheapest plane that `affords` the counts of both sides.
    fn sweep(
        &self,
        context: &Context,
        planes: &Planes,
        area: f64,
        count: usize,
        affords: impl Fn(usize, usize) -> bool,
    ) -> Option<Offer<(Cut, usize)>> {
        // What lies above each boundary, from the top.
        let slots = 2 * planes.bins() - 1;
        let mut above = [Extent::EMPTY; SLOTS];
        for slot in (1..slots).rev() {
            above[slot - 1] = above[slot].union(self.extents[slot]);
        }

        // Every boundary between slots is a candidate: of a plane, with what lies in it above or below.
        let mut best: Option<Offer<(Cut, usize)>> = None;
        let mut below = Extent::EMPTY;
        let (mut begun, mut ended) = (0, 0);
        for slot in 0..slots - 1 {
            below.grow(self.extents[slot]);
            begun += self.begin[slot] as usize;
            ended += self.end[slot] as usize;
            let (plane, flat_below) = (slot / 2, slot % 2 == 1);
            let (left, right) = (begun, count - ended);
            let same = flat_below && self.begin[slot] == 0;
            if same || left == 0 || right == 0 || left.min(right) == count || planes.value(plane).is_nan() {
                continue;
            }
            let sides = [below, above[slot]];
            let cost = context.costs.split(area, (below.half_area(), left), (above[slot].half_area(), right));
            if best.is_none_or(|b| cost < b.cost) && affords(left, right) {
                let cut = Cut { axis: planes.axis, plane: planes.value(plane), flat_below };
                best = Some(Offer { cost, split: (cut, plane), sides });
            }
        }
        best
    }
}

/// The cheapest plane for references in `bounds` that makes at most `budget` references.
pub(super) fn cheapest_cut(
    context: &Context,
    references: &[Reference],
    bounds: &Aabb,
    budget: f64,
) -> Option<Offer<Cut>> {
    let axis = |axis| {
        let planes = (context.config.candidates as usize).min(4 * references.len());
        along(context, references, bounds, budget, axis, planes)
    };
    let [x, y, z] = if references.len() < PARALLEL {
        [axis(0), axis(1), axis(2)]
    } else {
        let (x, (y, z)) = rayon::join(|| axis(0), || rayon::join(|| axis(1), || axis(2)));
        [x, y, z]
    };
    cheaper(cheaper(x, y), z)
}

fn along(
    context: &Context,
    references: &[Reference],
    bounds: &Aabb,
    budget: f64,
    axis: usize,
    count: usize,
) -> Option<Offer<Cut>> {
    let planes = Planes::new(axis, bounds, count, references)?;
    let chopped = references.len() <= context.config.chopped as usize;
    let add = |slots: &mut Slots, part: &[Reference]| match axis {
        0 => slots.add::<0>(context, part, &planes, chopped),
        1 => slots.add::<1>(context, part, &planes, chopped),
        _ => slots.add::<2>(context, part, &planes, chopped),
    };
    let area = Extent::from(*bounds).half_area();
    let affords = |below, above| (below + above) as f64 <= budget;
    let found = if references.len() < PARALLEL {
        let mut slots = Slots::EMPTY;
        add(&mut slots, references);
        slots.sweep(context, &planes, area, references.len(), affords)
    } else {
        let filled = |part: &[Reference]| {
            let mut slots = Box::new(Slots::EMPTY);
            add(&mut slots, part);
            slots
        };
        let slots = references.par_chunks(CHUNK).map(filled).reduce(|| Box::new(Slots::EMPTY), Slots::merge);
        slots.sweep(context, &planes, area, references.len(), affords)
    };
    found.map(|Offer { cost, split: (split, _), sides }| Offer { cost, split, sides })
}
