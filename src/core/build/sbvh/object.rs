//! The cheapest object split of a node.

use super::offer::{Context, Offer, cheaper};
use crate::build::axes::on_axes;
use crate::build::extent::Extent;
use crate::build::grouping::{BINS, Bins, Group, centres, order};
use crate::build::reference::{PARALLEL, Reference};
use crate::build::sample::Sample;

/// `area` is the half area of the box of `references`.
pub(super) fn cheapest_group(context: &Context, references: &[Reference], area: f64) -> Option<Offer<Group>> {
    let exact = references.len() <= context.config.exact as usize;
    let sample = Sample::new(references, context.config.sample);
    let along =
        |axis| if exact { sorted(context, references, area, axis) } else { binned(context, &sample, area, axis) };
    let [x, y, z] = on_axes(sample.len() >= PARALLEL, along);
    cheaper(cheaper(x, y), z)
}

fn binned(context: &Context, sample: &Sample, area: f64, axis: usize) -> Option<Offer<Group>> {
    let bins = Bins::new(axis, centres(sample.iter(), axis), context.config.candidates as usize)?;
    let (mut counts, mut extents) = ([0; BINS], [Extent::EMPTY; BINS]);
    for r in sample.iter() {
        let bin = bins.of(r);
        counts[bin] += 1;
        extents[bin].grow(r.extent());
    }

    let mut above = [Extent::EMPTY; BINS];
    for bin in (1..bins.count).rev() {
        above[bin - 1] = above[bin].union(extents[bin]);
    }
    let mut best: Option<Offer<Group>> = None;
    let (mut below, mut left) = (Extent::EMPTY, 0);
    for last in 0..bins.count - 1 {
        below.grow(extents[last]);
        left += counts[last];
        let right = sample.len() - left;
        if counts[last] == 0 || right == 0 {
            continue;
        }
        let sides = [below, above[last]];
        let counts = [left, right].map(|count| sample.scaled(count));
        let cost = context.costs.box_split(area, sides.map(|side| side.half_area()), counts);
        if best.is_none_or(|b| cost < b.cost) {
            best = Some(Offer { cost, split: Group::Bins { bins, last }, sides, counts });
        }
    }
    best
}

fn sorted(context: &Context, references: &[Reference], area: f64, axis: usize) -> Option<Offer<Group>> {
    let order = order(references, axis);
    let mut above = vec![Extent::EMPTY; order.len()];
    for i in (1..order.len()).rev() {
        above[i - 1] = above[i].union(references[order[i] as usize].extent());
    }
    let mut best: Option<Offer<Group>> = None;
    let mut below = Extent::EMPTY;
    for (i, &at) in order[..order.len() - 1].iter().enumerate() {
        below.grow(references[at as usize].extent());
        let (sides, counts) = ([below, above[i]], [i + 1, order.len() - i - 1]);
        let cost = context.costs.box_split(area, sides.map(|side| side.half_area()), counts);
        if best.is_none_or(|b| cost < b.cost) {
            best = Some(Offer { cost, split: Group::First { axis, count: i + 1 }, sides, counts });
        }
    }
    best
}
