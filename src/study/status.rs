//! The result of a run.

use serde::{Deserialize, Serialize};

use crate::report::Failure;
use crate::request::known_defect;

/// The result of a command; it determines the exit status.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    Right,
    /// A structure has wrong hits.
    Wrong,
    /// A measurement failed; the reason has been printed.
    Failed,
    /// A structure could not be built or panicked; all other structures are right. In a gate: results are missing.
    Refused,
    /// A structure became slower.
    Regression,
    /// The samples are inconclusive: a structure may have become slower.
    Undecided,
    /// The user interrupted the run before all cases were measured.
    Interrupted,
}

impl Status {
    /// The status that follows from `failures`. Wrong hits of a structure with known defects do not count.
    pub fn of(failures: &[Failure]) -> Self {
        if failures.iter().any(|failure| failure.wrong && known_defect(&failure.structure).is_none()) {
            Self::Wrong
        } else if failures.iter().any(|failure| failure.refused) {
            Self::Refused
        } else {
            Self::Right
        }
    }

    /// The status of two runs: wrong takes precedence over failed, failed over refused.
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Right, other) => other,
            (_, Self::Wrong) => Self::Wrong,
            (Self::Refused, Self::Failed) => Self::Failed,
            (before, _) => before,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_of_several_counts_in_whatever_order() {
        let worse = [Status::Right, Status::Refused, Status::Failed, Status::Wrong];
        for (i, one) in worse.into_iter().enumerate() {
            for (j, other) in worse.into_iter().enumerate() {
                assert_eq!(one.and(other), worse[i.max(j)], "{one:?} and {other:?}");
            }
        }
    }
}
