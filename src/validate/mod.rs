//! Validation: compares a structure with a reference, hit for hit. Exact arithmetic judges the differences.
//!
//! A *structure error* is a hit that the traversal lost or invented: the result differs from brute force with the same
//! triangle test. A correct structure has no structure errors. A *triangle-test error* is a hit or miss that differs
//! from the exact one because the triangle test rounds. One exception: if the test reports a hit where the exact ray
//! has none, a traversal may return or cull it. If structure and reference have different triangle tests, rounding in
//! single precision decides: differences that it explains are triangle-test errors, all other wrong hits are *answer
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
