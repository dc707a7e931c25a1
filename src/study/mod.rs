//! Studies: what is built, checked, counted and timed to answer a question, and the tables that answer it.

pub mod accuracy;
mod baselines;
pub mod bench;
mod built;
mod check;
pub mod compare;
mod error;
mod guarded;
pub mod hard_cases;
pub mod partitions;
pub mod regression;
pub mod replicate;
pub mod self_intersection;
mod stage;

pub use baselines::{BRUTE_FORCE, SAH_TREE, documented_defect};
pub use error::StudyError;
pub use guarded::{PANICKED, Refused, guarded};
pub use stage::Stage;
