//! The hard cases: what ray tracers are known to get wrong, each with a generator and the answer that is owed.
//!
//! A case is data: a name, a reason with its source, and either rays over a mesh or a property that answers must have. The
//! numbers 1 to 84 are those of the survey that the catalogue was made from; number 23 stands at two scales; those from 85 on
//! were found in this crate.
//! [`ask`] puts a case to a structure, [`Score`] holds the answers against the truth.

mod ask;
mod boxes;
mod case;
mod catalogue;
mod closed;
mod crowds;
mod extremes;
mod flats;
mod found;
mod intervals;
mod invalid;
mod lengths;
mod metamorphic;
mod properties;
mod score;
mod set;
mod slender;
mod subject;
#[cfg(test)]
mod tests;

pub use ask::{Answers, AnswersError, Head, ask};
pub use case::{Content, Expected, HardCase, Property, Rank};
pub use catalogue::{UnknownCase, catalogue, find, find_all};
pub use score::{Court, Failure, RayScore, Score, Totals};
pub use set::Set;
