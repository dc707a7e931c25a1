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
pub mod predictions;
pub mod regression;
pub mod replicate;
mod replicates;
pub mod scaling;
pub mod self_intersection;
mod stage;
pub mod trial;

pub use baselines::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, documented_defect};
pub use error::StudyError;
pub use guarded::{PANICKED, Refused, guarded};
pub use stage::Stage;

/// `12.3 [11.9, 12.8]`; what does not vary has no interval.
fn interval_text(x: crate::measure::Interval) -> String {
    use crate::report::number::figures;
    if x.low == x.high {
        return figures(x.estimate);
    }
    format!("{} [{}, {}]", figures(x.estimate), figures(x.low), figures(x.high))
}
