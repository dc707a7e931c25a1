//! Validation: compares a structure with a reference, hit for hit; the exact oracle judges where they differ.
//!
//! Two errors are told apart. A *structure error* is a hit that the traversal lost or invented, although its own triangle
//! test, run over all triangles, says otherwise: a correct structure has none, on any ray. A *triangle-test error* is caused by
//! the triangle test: it returns a hit where exactly there is none, and the traversal was free to cull it.
//! Where structure and reference have different tests, the two cannot be separated: then there are *answer errors*.

pub mod adversarial;
mod blame;
mod compare;
pub mod conformance;
pub(crate) mod degenerate;
mod error_counts;
pub mod hard_cases;
mod query_clock;
mod rate;
mod reference;
mod sampler;
mod validation;
mod watchdog;

pub use adversarial::Stratum;
pub use compare::{validate, validate_answers, validate_any_answers, validate_known};
pub use degenerate::degenerate_meshes;
pub use error_counts::{DepthRule, ErrorCounts, Outcome, Ulps, count_errors, outcome};
pub use rate::Rate;
pub(crate) use reference::HasReference;
pub use reference::{Reference, ScalarTest};
pub use sampler::Sampler;
pub use validation::{Kind, Validation, WorstRay};
pub use watchdog::{LIMIT, WatchError, validate_watched, watched};
