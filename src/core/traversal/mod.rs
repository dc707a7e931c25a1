//! Shared code of the traversals: leaf blocks, plane crossings, the choice of the SIMD level, memory in huge pages.

pub(crate) mod leaf;
pub(crate) mod line;
pub(crate) mod pages;
pub(crate) mod walk;
