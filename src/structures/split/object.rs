//! The cheapest way to sort the references of a node into two groups.

use super::build::{Context, PARALLEL};
use super::cost::{Offer, cheaper};
use super::reference::Reference;
use super::sample::Sample;
use crate::structures::extent::Extent;

/// A rule that sorts references into two groups, by the centres of their boxes on an axis.
#[derive(Clone, Copy, Debug)]
pub(super) enum Group {
    /// Below are those in the bins up to `last`.
    Bins { bins: Bins, last: usize },
    /// Below are the first `count` in ascending order of centres.
    First { axis: usize, count: usize },
}

/// An even grid over the centres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bins {
    axis: usize,
    min: f64,
    scale: f64,
    count: usize,
}

/// At most this many bins.
const BINS: usize = 64;

impl Bins {
    fn new(axis: usize, (min, max): (f32, f32), count: usize) -> Option<Self> {
        let scale = count as f64 / (f64::from(max) - f64::from(min));
        (min < max).then_some(Self { axis, min: min.into(), scale, count })
    }

    #[inline(always)]
    pub fn of(&self, reference: &Reference) -> usize {
        (((f64::from(reference.centre(self.axis)) - self.min) * self.scale) as usize).min(self.count - 1)
    }
}

/// The cheapest grouping of references in a box of half area `area`.
pub(super) fn cheapest_group(context: &Context, references: &[Reference], area: f64) -> Option<Offer<Group>> {
    let exact = references.len() <= context.config.exact as usize;
    let sample = Sample::new(references, context.config.sample);
    let along =
        |axis| if exact { sorted(context, references, area, axis) } else { binned(context, &sample, area, axis) };
    let [x, y, z] = if sample.len() < PARALLEL {
        [along(0), along(1), along(2)]
    } else {
        let (x, (y, z)) = rayon::join(|| along(0), || rayon::join(|| along(1), || along(2)));
        [x, y, z]
    };
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
        let cost = context.costs.split(area, sides.map(|side| side.half_area()), counts);
        if best.is_none_or(|b| cost < b.cost) {
            best = Some(Offer { cost, split: Group::Bins { bins, last }, sides, counts });
        }
    }
    best
}

/// Tries every split in the order of centres.
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
        let cost = context.costs.split(area, sides.map(|side| side.half_area()), counts);
        if best.is_none_or(|b| cost < b.cost) {
            best = Some(Offer { cost, split: Group::First { axis, count: i + 1 }, sides, counts });
        }
    }
    best
}

/// The half with the lower centres on the axis on which these are farthest apart, in whole blocks; the counts.
pub(super) fn median(references: &[Reference], block: usize) -> (Group, [usize; 2]) {
    let width = |axis| {
        let (min, max) = centres(references.iter(), axis);
        f64::from(max) - f64::from(min)
    };
    let axis = (1..3).fold(0, |best, axis| if width(axis) > width(best) { axis } else { best });
    let count = (references.len() / 2).next_multiple_of(block).min(references.len() - 1);
    (Group::First { axis, count }, [count, references.len() - count])
}

/// The least and the greatest centre.
fn centres<'a>(references: impl Iterator<Item = &'a Reference>, axis: usize) -> (f32, f32) {
    let with = |(min, max): (f32, f32), r: &Reference| (min.min(r.centre(axis)), max.max(r.centre(axis)));
    references.fold((f32::INFINITY, f32::NEG_INFINITY), with)
}

/// The places of the references in ascending order of centres, equal ones as they stand.
pub(super) fn order(references: &[Reference], axis: usize) -> Vec<u32> {
    let key = |(i, r): (u32, &Reference)| {
        // Negative floats order backwards: flip all their bits, and the sign bit of the others.
        let bits = (r.centre(axis) + 0.0).to_bits();
        let ordered = if bits >> 31 == 1 { !bits } else { bits | 1 << 31 };
        u64::from(ordered) << 32 | u64::from(i)
    };
    let mut keys: Vec<u64> = (0..).zip(references).map(key).collect();
    keys.sort_unstable();
    keys.into_iter().map(|key| key as u32).collect()
}
