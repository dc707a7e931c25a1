//! Validation: compares a structure with a reference, hit for hit; exact arithmetic judges the differences.
//!
//! There are three kinds of errors. A *structure error* is a hit that the traversal lost or invented: the result
//! differs from brute force with the same triangle test. A correct structure has none, on any ray. A *triangle-test
//! error* is caused by the triangle test: it returns a hit where exact arithmetic finds none, or at another depth; a
//! correct traversal may return or cull such a hit. If the reference lacks the structure's test, exact arithmetic
//! decides: differences that rounding in single precision explains are triangle-test errors; all others are *answer
//! errors*.

pub mod adversarial;
mod blame;
mod compare;
pub mod conformance;
pub(crate) mod degenerate;
mod error_counts;
pub mod hard_cases;
mod query_clock;
mod reference;
mod remote;
mod rounding;
mod sampler;
mod validation;
mod watchdog;

pub use adversarial::Stratum;
pub use compare::{ExpectedHits, differences, validate, validate_any_hits, validate_hits, validate_known};
pub use degenerate::{degenerate_meshes, stacked_sheets};
pub use error_counts::{ErrorCounts, Ulps, count_errors};
pub(crate) use reference::HasReference;
pub use reference::{Reference, ScalarTest};
pub use remote::{has_replied, validate_remote};
pub use rounding::Precision;
pub use sampler::Sampler;
pub use validation::{Kind, Validation, WorstRay};
pub use watchdog::{LIMIT, WatchError, validate_watched, watched};
