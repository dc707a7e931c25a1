//! Finds the cheapest SAH plane by a sweep over sorted events. A child inherits the order of its parent's events.
//!
//! # References
//! Wald, Havran: On building fast kd-trees for ray tracing, and on doing that in O(N log N). IEEE Symposium on
//! Interactive Ray Tracing 2006.
//!
//! As in the paper, a triangle in the split plane is assigned only to the cheaper side. No hit is lost, because the
//! traversal visits both sides of a plane that a ray crosses. The budget of references is not in the paper.

use rayon::prelude::*;

use super::config::CellConfig;
use super::grow::{Content, Context, NodeState};
use crate::build::axes::on_axes;
use crate::build::clip::clipped_bounds;
use crate::build::cut::Cut;
use crate::build::grouping::ordered_bits;
use crate::build::reference::Reference;
use crate::build::sah_cost::{CostModel, SideAreas};
use crate::geometry::Aabb;

/// The start or end of a reference on an axis, or the plane of a flat reference. Bits from high to low: coordinate
/// (32), kind (2), index of the reference (30). The sweep visits the events in ascending numeric order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Event(u64);

/// The kinds of events. Events with equal coordinates are sorted by kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Kind {
    End = 0,
    Planar = 1,
    Start = 2,
}

impl Event {
    fn new(coordinate: f32, kind: Kind, reference: u32) -> Self {
        Self(u64::from(ordered_bits(coordinate)) << 32 | (kind as u64) << 30 | u64::from(reference))
    }

    fn coordinate(self) -> f32 {
        let ordered = (self.0 >> 32) as u32;
        f32::from_bits(if ordered >> 31 == 1 { ordered & !(1 << 31) } else { !ordered })
    }

    fn kind(self) -> Kind {
        match (self.0 >> 30) & 3 {
            0 => Kind::End,
            1 => Kind::Planar,
            _ => Kind::Start,
        }
    }

    fn reference(self) -> u32 {
        self.0 as u32 & ((1 << 30) - 1)
    }

    fn renamed(self, reference: u32) -> Self {
        Self(self.0 & !((1 << 30) - 1) | u64::from(reference))
    }
}

/// The references are in ascending order of triangle numbers. The events of each axis are sorted.
pub(crate) struct Events {
    pub(super) references: Vec<Reference>,
    axes: [Vec<Event>; 3],
}

pub(super) const PARALLEL: usize = 8192;

impl Events {
    /// `references` must be in ascending order of triangle numbers.
    pub fn new(references: Vec<Reference>) -> Self {
        let axes = [0, 1, 2].map(|axis| {
            let mut events = Vec::with_capacity(2 * references.len());
            push_events(&references, 0, axis, &mut events);
            if references.len() < PARALLEL {
                events.sort_unstable();
            } else {
                events.par_sort_unstable();
            }
            events
        });
        Self { references, axes }
    }

    fn sweep(&self, model: &CostModel, cell: &Aabb, axis: usize) -> Option<(f64, Cut)> {
        let areas = SideAreas::new(cell, axis);
        let (min, max) = (cell.min[axis], cell.max[axis]);
        let events = &self.axes[axis];
        let (mut below, mut above) = (0, self.references.len());
        let mut best: Option<(f64, Cut)> = None;

        let mut i = 0;
        while i < events.len() {
            let plane = events[i].coordinate();
            let mut counts = [0; 3];
            while i < events.len() && events[i].0 >> 32 == Event::new(plane, Kind::End, 0).0 >> 32 {
                counts[events[i].kind() as usize] += 1;
                i += 1;
            }
            let [end, planar, start] = counts;
            above -= end + planar;

            // A plane on a face of the cell does not divide the cell.
            if min < plane && plane < max {
                let mut offer = |below, above, flat_below| {
                    let cost = model.cell_split(&areas, plane, [below, above]);
                    if best.is_none_or(|(least, _)| cost < least) {
                        best = Some((cost, Cut { axis, plane, flat_below }));
                    }
                };
                offer(below + planar, above, true);
                if planar > 0 {
                    offer(below, above + planar, false);
                }
            }
            below += start + planar;
        }
        best
    }

    /// The references on side `here` (0: below, 1: above), clipped to `cell`. `sides` has an entry per reference.
    fn part(&self, context: &Context<CellConfig>, sides: &[[bool; 2]], here: usize, cell: &Aabb) -> Self {
        let count = sides.iter().filter(|side| side[here]).count();
        let mut references = Vec::with_capacity(count);
        let mut names = vec![u32::MAX; sides.len()];
        let mut clipped = vec![];
        for (i, (reference, side)) in self.references.iter().zip(sides).enumerate() {
            if side[here] && side[1 - here] {
                let bounds = clipped_bounds(context.mesh.corners(reference.id()), cell, &reference.bounds());
                clipped.push(references.len() as u32);
                references.push(Reference::new(reference.id(), bounds));
            } else if side[here] {
                names[i] = references.len() as u32;
                references.push(*reference);
            }
        }

        let axes = [0, 1, 2].map(|axis| {
            let mut fresh = Vec::with_capacity(2 * clipped.len());
            for &name in &clipped {
                push_events(&references[name as usize..=name as usize], name, axis, &mut fresh);
            }
            fresh.sort_unstable();
            let kept = self.axes[axis].iter().filter_map(|event| {
                let name = names[event.reference() as usize];
                (name != u32::MAX).then(|| event.renamed(name))
            });
            merge(kept, &fresh, 2 * count)
        });
        Self { references, axes }
    }
}

/// The events of `references[i]` refer to the index `first + i`.
fn push_events(references: &[Reference], first: u32, axis: usize, events: &mut Vec<Event>) {
    for (name, reference) in (first..).zip(references) {
        let (lo, hi) = (reference.min(axis), reference.max(axis));
        if lo == hi {
            events.push(Event::new(lo, Kind::Planar, name));
        } else {
            events.push(Event::new(lo, Kind::Start, name));
            events.push(Event::new(hi, Kind::End, name));
        }
    }
}

fn merge(kept: impl Iterator<Item = Event>, fresh: &[Event], capacity: usize) -> Vec<Event> {
    let mut merged = Vec::with_capacity(capacity);
    let mut rest = fresh;
    for event in kept {
        while let [next, tail @ ..] = rest
            && *next < event
        {
            merged.push(*next);
            rest = tail;
        }
        merged.push(event);
    }
    merged.extend_from_slice(rest);
    merged
}

impl Content for Events {
    type Config = CellConfig;

    fn len(&self) -> usize {
        self.references.len()
    }

    fn ids(&self) -> impl Iterator<Item = u32> {
        self.references.iter().map(|r| r.id())
    }

    fn choose(&self, context: &Context<CellConfig>, state: &NodeState) -> Option<Cut> {
        let model = &context.config.costs;
        let found = on_axes(self.len() >= PARALLEL, |axis| self.sweep(model, &state.cell, axis));
        let (cost, cut) = found.into_iter().flatten().reduce(|a, b| if b.0 < a.0 { b } else { a })?;
        (!context.rules.pays || cost < model.leaf(self.len())).then_some(cut)
    }

    fn divide(self, context: &Context<CellConfig>, state: &NodeState, cut: Cut) -> Result<(Self, Self), Self> {
        let counts = cut.counts(&self.references);
        if !state.accepts(context, self.len(), counts) {
            return Err(self);
        }

        let sides: Vec<[bool; 2]> = self.references.iter().map(|r| cut.sides(r)).collect();
        let (below, above) = state.cell.cut(cut.axis, cut.plane);
        let part = |here, cell| self.part(context, &sides, here, cell);
        Ok(if self.len() < PARALLEL {
            (part(0, &below), part(1, &above))
        } else {
            rayon::join(|| part(0, &below), || part(1, &above))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_sort_by_coordinate_then_kind() {
        let values = [f32::NEG_INFINITY, -2.0, -1e-40, -0.0, 0.0, 1e-40, 1.5, f32::MAX];
        for (i, &a) in values.iter().enumerate() {
            assert_eq!(Event::new(a, Kind::Start, 7).coordinate(), a);
            for &b in &values[i..] {
                assert!(Event::new(a, Kind::End, 9) < Event::new(b, Kind::Start, 1), "{a} {b}");
                if a < b {
                    assert!(Event::new(a, Kind::Start, 9) < Event::new(b, Kind::End, 1), "{a} {b}");
                }
            }
        }
        let event = Event::new(-3.0, Kind::Planar, 12).renamed(4);
        assert_eq!((event.coordinate(), event.kind(), event.reference()), (-3.0, Kind::Planar, 4));
    }
}
