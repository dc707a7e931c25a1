//! Shared code of the traversals: leaves of blocks of triangles, plane crossings, levels, memory on large pages.

pub(crate) mod leaf;
pub(crate) mod line;
pub(crate) mod pages;
pub(crate) mod walk;
