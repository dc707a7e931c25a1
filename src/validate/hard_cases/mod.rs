//! Hard cases: inputs on which ray tracers are known to fail.
//!
//! [`run`] runs a case on a structure. [`Score`] compares the hits of the structure with the exact hits.

mod answers;
mod case;
mod catalogue;
mod find;
mod meshes;
mod metamorphic;
mod properties;
mod rays;
mod score;
mod set;
#[cfg(test)]
mod tests;

pub use answers::{Answers, run};
pub use case::{Content, Expected, HardCase, Property, Rank};
pub use find::{UnknownCase, catalogue, find, find_all};
pub use score::{CaseTruth, Failure, RayScore, Score};
pub use set::Set;
