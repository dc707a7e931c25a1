use super::reference::Reference;

/// Every `stride`-th reference of a node.
#[derive(Clone, Copy)]
pub(crate) struct Sample<'a> {
    references: &'a [Reference],
    stride: usize,
}

impl<'a> Sample<'a> {
    pub fn new(references: &'a [Reference], limit: u32) -> Self {
        Self { references, stride: references.len().div_ceil(limit as usize).max(1) }
    }

    pub fn all(references: &'a [Reference]) -> Self {
        Self { references, stride: 1 }
    }

    pub fn iter(&self) -> impl Iterator<Item = &'a Reference> + use<'a> {
        self.references.iter().step_by(self.stride)
    }

    /// Number of references in the sample.
    pub fn len(&self) -> usize {
        self.references.len().div_ceil(self.stride)
    }

    /// Number of references in the node.
    pub fn whole(&self) -> usize {
        self.references.len()
    }

    /// Scales `count`, a number of sampled references, to the whole node.
    #[inline(always)]
    pub fn scaled(&self, count: usize) -> usize {
        (count * self.stride).min(self.references.len())
    }
}
