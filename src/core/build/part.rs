//! Divides the references of a node into two parts.

use rayon::prelude::*;

use super::cut::Cut;
use super::extent::Extent;
use super::grouping::{Group, median, order};
use super::reference::{CHUNK, PARALLEL, Reference, bounds};
use crate::geometry::Mesh;
use crate::triangle::BLOCK;

pub(crate) struct Part {
    pub references: Vec<Reference>,
    pub extent: Extent,
}

impl Part {
    pub fn new(references: Vec<Reference>) -> Self {
        let extent = bounds(&references);
        Self { references, extent }
    }

    /// One unclipped reference for each triangle with a nonzero area.
    pub fn whole(mesh: &Mesh) -> Self {
        let ids: Vec<u32> = mesh.solid().collect();
        let references: Vec<Reference> =
            ids.into_par_iter().with_min_len(CHUNK).map(|id| Reference::whole(mesh, id)).collect();
        let extent = references.par_chunks(CHUNK).map(bounds).reduce(|| Extent::EMPTY, Extent::union);
        Self { references, extent }
    }

    fn push(&mut self, reference: Reference) {
        self.extent.grow(reference.extent());
        self.references.push(reference);
    }

    fn with_capacity(capacity: usize) -> Self {
        Self { references: Vec::with_capacity(capacity), extent: Extent::EMPTY }
    }
}

/// `counts` are the expected sizes of the parts. `place` adds a reference to one part or to both parts.
fn deal(
    references: Vec<Reference>,
    counts: [usize; 2],
    place: impl Fn(&Reference, &mut [Part; 2]) + Sync,
) -> [Part; 2] {
    let dealt = |references: &[Reference], counts: [usize; 2]| {
        let mut parts = counts.map(Part::with_capacity);
        references.iter().for_each(|r| place(r, &mut parts));
        parts
    };
    if references.len() < PARALLEL {
        return dealt(&references, counts);
    }

    // Join the chunks in order. The result then does not depend on the threads.
    let chunks: Vec<[Part; 2]> = references.par_chunks(CHUNK).map(|chunk| dealt(chunk, [CHUNK / 2; 2])).collect();
    drop(references);
    let (below, above): (Vec<Part>, Vec<Part>) = chunks.into_iter().map(|[below, above]| (below, above)).unzip();
    let join = |parts: Vec<Part>| {
        let mut all = Part::with_capacity(parts.iter().map(|p| p.references.len()).sum());
        for part in parts {
            all.extent.grow(part.extent);
            all.references.extend(part.references);
        }
        all
    };
    let (below, above) = rayon::join(|| join(below), || join(above));
    [below, above]
}

/// A reference on both sides is clipped to each side. No reference is dropped.
pub(crate) fn at_plane(mesh: &Mesh, references: Vec<Reference>, cut: Cut, counts: [usize; 2]) -> [Part; 2] {
    deal(references, counts, |r, [below, above]| match cut.sides(r) {
        [true, true] => {
            let (lower, upper) = r.cut(mesh, cut.axis, cut.plane);
            below.push(lower);
            above.push(upper);
        }
        [true, false] => below.push(*r),
        _ => above.push(*r),
    })
}

pub(crate) fn halves(references: Vec<Reference>) -> [Part; 2] {
    let (group, counts) = median(&references, BLOCK);
    by_group(references, group, counts)
}

pub(crate) fn by_group(references: Vec<Reference>, group: Group, counts: [usize; 2]) -> [Part; 2] {
    match group {
        Group::Bins { bins, last } => deal(references, counts, |r, [below, above]| match bins.of(r) <= last {
            true => below.push(*r),
            false => above.push(*r),
        }),
        Group::First { axis, count } => {
            let order = order(&references, axis);
            let part = |places: &[u32]| Part::new(places.iter().map(|&i| references[i as usize]).collect());
            [part(&order[..count]), part(&order[count..])]
        }
    }
}
