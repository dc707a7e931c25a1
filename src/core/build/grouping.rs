//! Rules that divide the references of a node into two groups.

use super::reference::Reference;

/// Divides references into two groups by box centres on one axis.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Group {
    /// The first group has the references in the bins `0..=last`.
    Bins { bins: Bins, last: usize },
    /// The first group has the `count` references with the lowest centres.
    First { axis: usize, count: usize },
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Bins {
    axis: usize,
    min: f64,
    scale: f64,
    pub count: usize,
}

/// Maximum number of bins per axis.
pub(crate) const BINS: usize = 64;

impl Bins {
    pub fn new(axis: usize, (min, max): (f32, f32), count: usize) -> Option<Self> {
        let scale = count as f64 / (f64::from(max) - f64::from(min));
        (min < max).then_some(Self { axis, min: min.into(), scale, count })
    }

    #[inline(always)]
    pub fn of(&self, reference: &Reference) -> usize {
        (((f64::from(reference.centre(self.axis)) - self.min) * self.scale) as usize).min(self.count - 1)
    }
}

/// Halves the references by centre, on the axis with the widest range of centres. Rounds the size of the first group up
/// to a multiple of `block`. The second group has at least one reference.
pub(crate) fn median(references: &[Reference], block: usize) -> (Group, [usize; 2]) {
    let width = |axis| {
        let (min, max) = centres(references.iter(), axis);
        f64::from(max) - f64::from(min)
    };
    let axis = (1..3).fold(0, |best, axis| if width(axis) > width(best) { axis } else { best });
    let count = (references.len() / 2).next_multiple_of(block).min(references.len() - 1);
    (Group::First { axis, count }, [count, references.len() - count])
}

pub(crate) fn centres<'a>(references: impl Iterator<Item = &'a Reference>, axis: usize) -> (f32, f32) {
    let with = |(min, max): (f32, f32), r: &Reference| (min.min(r.centre(axis)), max.max(r.centre(axis)));
    references.fold((f32::INFINITY, f32::NEG_INFINITY), with)
}

/// The indices of the references, in ascending order of centres. References with equal centres keep the input
/// order.
pub(crate) fn order(references: &[Reference], axis: usize) -> Vec<u32> {
    let key = |(i, r): (u32, &Reference)| u64::from(ordered_bits(r.centre(axis))) << 32 | u64::from(i);
    let mut keys: Vec<u64> = (0..).zip(references).map(key).collect();
    keys.sort_unstable();
    keys.into_iter().map(|key| key as u32).collect()
}

/// An order-preserving map from floats to integers. Both zeros give the same integer.
#[inline(always)]
pub(crate) fn ordered_bits(x: f32) -> u32 {
    // Adding 0.0 turns -0.0 into 0.0. For negative floats, flip all bits to reverse the order.
    let bits = (x + 0.0).to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}
