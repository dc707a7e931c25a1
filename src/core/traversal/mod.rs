//! Code that the traversals of several structures share.

pub(crate) mod leaf;
pub(crate) mod line;
pub(crate) mod pages;
pub(crate) mod walk;
