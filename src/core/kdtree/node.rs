use crate::accel::BuildError;

/// In the array of nodes, the child below the split plane is stored directly after its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(super) struct Node {
    /// In an inner node, the bits of the split coordinate. In a leaf, the index of the first block.
    ///
    /// During the build, a leaf stores the index of its first reference instead.
    payload: u32,
    /// The low 2 bits are the axis, or 3 in a leaf. In an inner node, the high 30 bits are the index of the child
    /// above the plane. In a leaf, the high 30 bits are the number of references.
    tag: u32,
}

const _: () = assert!(size_of::<Node>() == 8);

#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub nodes: usize,
    pub references: usize,
}

impl Limits {
    pub const OF_NODES: Self = Self { nodes: 1 << 30, references: (1 << 30) - 1 };

    pub fn check(&self, nodes: usize, references: usize) -> Result<(), BuildError> {
        let Self { nodes: most_nodes, references: most_references } = *self;
        if nodes <= most_nodes && references <= most_references {
            return Ok(());
        }
        Err(BuildError::Mesh(format!(
            "the mesh is too large for a KD-tree: it needs at least {nodes} nodes and {references} references; the \
             limits are {most_nodes} and {most_references}; use larger leaves or less duplication"
        )))
    }
}

impl Node {
    const LEAF: u32 = 3;

    /// `axis` must be below 3.
    ///
    /// The shift may drop high bits of `above` during a build. [`Limits::check`] then rejects the tree.
    pub fn inner(axis: usize, split: f32, above: u32) -> Self {
        Self { payload: split.to_bits(), tag: above << 2 | axis as u32 }
    }

    /// The shift may drop high bits of `references` during a build. [`Limits::check`] then rejects the tree.
    pub fn leaf(first: u32, references: u32) -> Self {
        Self { payload: first, tag: references << 2 | Self::LEAF }
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.tag & 3 == Self::LEAF
    }

    #[inline(always)]
    pub fn axis(self) -> usize {
        (self.tag & 3) as usize
    }

    #[inline(always)]
    pub fn split(self) -> f32 {
        f32::from_bits(self.payload)
    }

    #[inline(always)]
    pub fn above(self) -> u32 {
        self.tag >> 2
    }

    #[inline(always)]
    pub fn first(self) -> u32 {
        self.payload
    }

    #[inline(always)]
    pub fn references(self) -> u32 {
        self.tag >> 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limits_are_what_a_node_can_name() {
        let Limits { nodes, references } = Limits::OF_NODES;
        let last = Node::inner(2, -1.5, nodes as u32 - 1);
        assert_eq!((last.is_leaf(), last.axis(), last.split(), last.above() as usize), (false, 2, -1.5, nodes - 1));
        let largest = Node::leaf(references as u32 - 1, references as u32);
        assert_eq!((largest.is_leaf(), largest.references() as usize), (true, references));
        assert_ne!(Node::inner(2, -1.5, nodes as u32).above() as usize, nodes);
        assert_ne!(Node::leaf(0, references as u32 + 1).references() as usize, references + 1);
    }
}
