//! The hard cases: inputs that ray tracers are known to get wrong, each with a generator and the expected hits.
//!
//! A case is data: a name, a reason with its source, and either rays over a mesh or a property of hits. Cases 1 to 84
//! come from a survey of ray tracers. Cases from 85 on were found with this crate. Two cases have the number 23.
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
