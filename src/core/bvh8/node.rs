//! The node of wide trees.

use glam::Vec3;

use crate::accel::BuildError;
use crate::geometry::Aabb;

/// Maximum number of nodes on a path that a traversal can follow.
pub(super) const DEPTH: usize = 100;

pub(super) const WIDTH: usize = 8;

#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub levels: usize,
    pub nodes: usize,
    pub blocks: usize,
    /// Maximum number of nodes, and of references, in the binary tree before the collapse.
    pub binary: usize,
}

impl Limits {
    pub const OF_NODES: Self =
        Self { levels: DEPTH, nodes: Child::LARGEST, blocks: Child::LARGEST, binary: u32::MAX as usize };

    /// The binary tree has at most `duplication` references per triangle on average. A binary tree has fewer than two
    /// nodes per reference.
    pub fn admit(&self, triangles: usize, duplication: f32) -> Result<(), BuildError> {
        let most = 2.0 * f64::from(duplication) * triangles as f64;
        if most <= self.binary as f64 {
            return Ok(());
        }
        Err(BuildError::Mesh(format!(
            "the mesh is too large for this structure: {triangles} triangles with a duplication of {duplication} may \
             need {most} binary nodes, but the limit is {}; lower `duplication`",
            self.binary
        )))
    }

    pub fn check(&self, levels: usize, nodes: usize, blocks: usize) -> Result<(), BuildError> {
        if levels <= self.levels && nodes <= self.nodes && blocks <= self.blocks {
            return Ok(());
        }
        Err(BuildError::Mesh(format!(
            "the mesh is too large or too irregular for this structure: it needs {levels} levels, {nodes} nodes and \
             {blocks} blocks; the limits are {}, {} and {}",
            self.levels, self.nodes, self.blocks
        )))
    }
}

#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// The index is `[axis][side][lane]`. Side 0 is the lower plane of a box. Side 1 is the upper plane.
    pub planes: [[[f32; WIDTH]; 2]; 3],
    pub children: [Child; WIDTH],
    /// For each octant of directions, the order in which closest-hit queries visit the lanes. Bit `axis` of an octant
    /// is set if directions are negative on this axis.
    ///
    /// An order has three bits per lane. The lowest three bits contain the lane that is visited last. Unused lanes come
    /// after all used lanes.
    pub orders: [u32; 8],
}

const _: () = assert!(size_of::<Node>() == 256);

/// Identifies a node by its index, or a leaf by its first block and number of blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const COUNT_BITS: u32 = 4;
    pub const BLOCKS: usize = (1 << Self::COUNT_BITS) - 1;
    /// Maximum number of nodes, and of blocks, in a tree.
    pub const LARGEST: usize = 1 << (31 - Self::COUNT_BITS);

    /// A leaf without triangles, for unused lanes and for the root of an empty tree.
    pub const NOTHING: Self = Self(Self::LEAF);

    /// An empty leaf that marks the bottom of a stack. No node contains this leaf.
    pub const BOTTOM: Self = Self(Self::LEAF | 1 << Self::COUNT_BITS);

    pub fn node(at: usize) -> Self {
        debug_assert!(at < Self::LARGEST);
        Self(at as u32)
    }

    pub fn leaf(first: usize, blocks: usize) -> Self {
        debug_assert!(first < Self::LARGEST && blocks <= Self::BLOCKS);
        Self(Self::LEAF | (first as u32) << Self::COUNT_BITS | blocks as u32)
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// The first block and the number of blocks of a leaf.
    #[inline(always)]
    pub fn blocks(self) -> Option<(usize, usize)> {
        self.is_leaf().then_some(self.leaf_blocks())
    }

    /// Meaningful only if this child is a leaf.
    #[inline(always)]
    pub fn leaf_blocks(self) -> (usize, usize) {
        let first = (self.0 & !Self::LEAF) >> Self::COUNT_BITS;
        (first as usize, (self.0 & Self::BLOCKS as u32) as usize)
    }

    /// Adds `nodes` to the index of a node, or adds `blocks` to the first block of a leaf.
    pub fn moved(self, nodes: usize, blocks: usize) -> Self {
        match self.blocks() {
            None => Self::node(self.index() + nodes),
            Some(_) if self == Self::NOTHING => self,
            Some((first, count)) => Self::leaf(first + blocks, count),
        }
    }

    #[inline(always)]
    pub fn bits(children: &[Self; WIDTH]) -> &[u32; WIDTH] {
        // SAFETY: `Child` is a transparent `u32`, so an array of `Child` has the layout of an array of `u32`.
        unsafe { &*(&raw const *children).cast() }
    }

    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl Node {
    /// A ray meets these boxes only if its inverse direction is NaN on all axes. Such a ray finds empty leaves.
    pub const EMPTY: Self = Self {
        planes: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3],
        children: [Child::NOTHING; WIDTH],
        orders: [0; 8],
    };

    pub fn set(&mut self, lane: usize, bounds: &Aabb, child: Child) {
        for (axis, [low, high]) in self.planes.iter_mut().enumerate() {
            low[lane] = bounds.min[axis];
            high[lane] = bounds.max[axis];
        }
        self.children[lane] = child;
    }

    pub fn moved(self, nodes: usize, blocks: usize) -> Self {
        Self { children: self.children.map(|child| child.moved(nodes, blocks)), ..self }
    }

    pub fn boxes(&self) -> impl Iterator<Item = (Aabb, Child)> + '_ {
        let corner =
            |side: usize, lane: usize| Vec3::from_array(std::array::from_fn(|axis| self.planes[axis][side][lane]));
        let used = (0..WIDTH).filter(|&lane| self.children[lane] != Child::NOTHING);
        used.map(move |lane| (Aabb { min: corner(0, lane), max: corner(1, lane) }, self.children[lane]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limits_are_what_a_child_can_name() {
        let Limits { nodes, blocks, .. } = Limits::OF_NODES;
        assert_eq!(Child::node(nodes - 1).index(), nodes - 1);
        assert!(!Child::node(nodes - 1).is_leaf());
        assert_eq!(Child::leaf(blocks - 1, Child::BLOCKS).blocks(), Some((blocks - 1, Child::BLOCKS)));
        assert_eq!((blocks as u32) << Child::COUNT_BITS, Child::LEAF);
    }
}
