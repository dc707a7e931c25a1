//! Studies: what is built, checked, counted and timed to answer a question, and the tables that answer it.

pub mod accuracy;
pub mod attribution;
mod baselines;
pub mod bench;
pub mod break_even;
mod built;
mod check;
pub mod compare;
pub mod costs;
mod counted;
pub mod counts;
pub mod crossover;
pub mod epoch;
mod error;
mod fit;
mod guarded;
pub mod hard_cases;
pub mod journal;
pub mod parameters;
pub mod partitions;
mod placed;
pub mod predictions;
pub mod regression;
pub mod replicate;
mod replicates;
pub mod scaling;
pub mod self_intersection;
mod stage;
mod timing;

pub use baselines::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, documented_defect};
pub use error::StudyError;
pub use guarded::{PANICKED, Refused, guarded};
pub use stage::Stage;
