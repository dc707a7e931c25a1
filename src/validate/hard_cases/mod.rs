//! The hard cases: what ray tracers are known to get wrong, each with a generator and what must hold.
//!
//! A case is data: a name, a reason with its source, and either rays over a mesh or a property that hits must have. The
//! numbers 1 to 84 are those of the survey that the catalogue was made from; number 23 stands at two scales; those from 85 on
//! were found in this crate.
//! [`run`] runs a case on a structure, [`Score`] compares its hits with the truth.

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
