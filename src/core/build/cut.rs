use rayon::prelude::*;

use super::reference::{CHUNK, PARALLEL, Reference};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cut {
    pub axis: usize,
    pub plane: f32,
    /// Whether references in the plane belong to the side below the plane.
    pub flat_below: bool,
}

impl Cut {
    /// Whether the reference belongs to each side of the plane, as `[below, above]`.
    #[inline(always)]
    pub fn sides(&self, reference: &Reference) -> [bool; 2] {
        let (low, high) = (reference.min(self.axis), reference.max(self.axis));
        match (high <= self.plane, low >= self.plane) {
            (true, true) => [self.flat_below, !self.flat_below],
            (below, above) => [!above, !below],
        }
    }

    pub fn counts(&self, references: &[Reference]) -> [usize; 2] {
        let count = |references: &[Reference]| {
            references.iter().fold([0; 2], |[below, above], r| {
                let [b, a] = self.sides(r);
                [below + usize::from(b), above + usize::from(a)]
            })
        };
        if references.len() < PARALLEL {
            return count(references);
        }
        let sum = |[a, b]: [usize; 2], [c, d]: [usize; 2]| [a + c, b + d];
        references.par_chunks(CHUNK).map(count).reduce(|| [0; 2], sum)
    }
}
