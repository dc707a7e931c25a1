/// A node of the tree in 8 bytes. The child below the plane follows its parent, the child above is named by number.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(super) struct Node {
    /// Inner node: the bits of the split coordinate. Leaf: its first reference while building, then its first block.
    payload: u32,
    /// The two low bits are the axis, or 3 for a leaf; the others the number of the child above, or of references.
    tag: u32,
}

const _: () = assert!(size_of::<Node>() == 8);

impl Node {
    const LEAF: u32 = 3;

    pub fn inner(axis: usize, split: f32, above: u32) -> Self {
        debug_assert!(axis < 3 && above < 1 << 30);
        Self { payload: split.to_bits(), tag: above << 2 | axis as u32 }
    }

    pub fn leaf(first: u32, references: u32) -> Self {
        debug_assert!(references < 1 << 30);
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
