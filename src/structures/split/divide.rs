//! Carrying out a split.

use rayon::prelude::*;

use super::build::{CHUNK, Context, PARALLEL};
use super::extent::Extent;
use super::object::{Group, order};
use super::reference::Reference;
use super::spatial::Cut;

/// References and their box.
pub(super) struct Part {
    pub references: Vec<Reference>,
    pub extent: Extent,
}

impl Part {
    pub fn new(references: Vec<Reference>) -> Self {
        let extent = super::reference::bounds(&references);
        Self { references, extent }
    }

    fn push(&mut self, reference: Reference) {
        self.extent.grow(reference.extent());
        self.references.push(reference);
    }

    fn empty() -> Self {
        Self { references: vec![], extent: Extent::EMPTY }
    }
}

/// Sorts references into two parts; `place` puts one where it belongs.
fn deal(references: Vec<Reference>, place: impl Fn(&Reference, &mut [Part; 2]) + Sync) -> [Part; 2] {
    let dealt = |references: &[Reference]| {
        let mut parts = [Part::empty(), Part::empty()];
        references.iter().for_each(|r| place(r, &mut parts));
        parts
    };
    if references.len() < PARALLEL {
        return dealt(&references);
    }

    // Chunks are dealt in any order and joined in their own.
    let chunks: Vec<[Part; 2]> = references.par_chunks(CHUNK).map(dealt).collect();
    drop(references);
    let (below, above): (Vec<Part>, Vec<Part>) = chunks.into_iter().map(|[below, above]| (below, above)).unzip();
    let join = |parts: Vec<Part>| {
        let mut all =
            Part { references: Vec::with_capacity(parts.iter().map(|p| p.references.len()).sum()), ..Part::empty() };
        for part in parts {
            all.extent.grow(part.extent);
            all.references.extend(part.references);
        }
        all
    };
    let (below, above) = rayon::join(|| join(below), || join(above));
    [below, above]
}

/// Cuts at a plane. References on both sides are clipped to each; none is dropped.
pub(super) fn at_plane(context: &Context, references: Vec<Reference>, cut: Cut) -> [Part; 2] {
    deal(references, |r, [below, above]| {
        let (low, high) = (r.bounds.min[cut.axis], r.bounds.max[cut.axis]);
        match (high <= cut.plane, low >= cut.plane) {
            (true, true) if cut.flat_below => below.push(*r),
            (true, true) | (false, true) => above.push(*r),
            (true, false) => below.push(*r),
            (false, false) => {
                let (lower, upper) = r.cut(context.mesh, cut.axis, cut.plane);
                below.push(lower);
                above.push(upper);
            }
        }
    })
}

/// Sorts into two groups.
pub(super) fn by_group(references: Vec<Reference>, group: Group) -> [Part; 2] {
    match group {
        Group::Bins { bins, last } => {
            deal(references, |r, [below, above]| if bins.of(r) <= last { below.push(*r) } else { above.push(*r) })
        }
        Group::First { axis, count } => {
            let order = order(&references, axis);
            let part = |places: &[u32]| Part::new(places.iter().map(|&i| references[i as usize]).collect());
            [part(&order[..count]), part(&order[count..])]
        }
    }
}
