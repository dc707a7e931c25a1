//! Compares the hits of a structure with the hits of a reference.
//!
//! A *structure error* is a hit that the traversal of the structure lost or invented. A *triangle-test error* is a
//! wrong result, caused by rounding in the triangle test. An *answer error* is a wrong result that rounding in the
//! triangle test cannot explain. A comparison counts answer errors only if it cannot distinguish structure errors from
//! triangle-test errors.
//!
//! One exception: if a triangle test hits where exact arithmetic finds no hit, a traversal may return or miss this hit.

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
