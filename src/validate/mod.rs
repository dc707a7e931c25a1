//! Compares a structure with a reference, hit for hit, and finds the cause of each difference.
//!
//! A *structure error* is a hit that the traversal lost or invented. The result then differs from brute force with the
//! same triangle test. A *triangle-test error* is a wrong hit or miss that the rounding of the triangle test causes. An
//! *answer error* is a wrong hit that rounding in single precision cannot explain. Answer errors occur only if
//! structure and reference have different triangle tests.
//!
//! A traversal may return or cull a hit that only a rounded triangle test reports.

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
