//! The cells of KD-trees: space cut by planes, chosen by the surface area heuristic or by a rule of the caller.

mod binned;
mod config;
mod grow;
mod sweep;
#[cfg(test)]
mod tests;
mod tight;

pub(crate) use binned::Binned;
pub(crate) use config::CellConfig;
pub(crate) use grow::{Content, Context, DEEPEST, Place, Rules, Tree, grow};
pub(crate) use tight::build;
