//! What the traversals of the structures share: leaves of blocks of triangles, crossings of planes and their slack,
//! walks that are compiled for several levels, memory on large pages.

pub(crate) mod leaf;
pub(crate) mod line;
pub(crate) mod pages;
pub(crate) mod walk;
