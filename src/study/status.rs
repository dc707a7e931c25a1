//! The result of a run.

use serde::{Deserialize, Serialize};

use crate::report::Failure;
use crate::request::known_defect;

/// The exit status of a command depends on this result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    Right,
    Wrong,
    /// A measurement failed. The reason has been printed.
    Failed,
    /// A structure could not be built or panicked. In a gate, results are missing.
    Refused,
    Regression,
    /// The samples are inconclusive.
    Undecided,
    Interrupted,
}

impl Status {
    /// Wrong hits of a structure with known defects do not count.
    pub fn of(failures: &[Failure]) -> Self {
        if failures.iter().any(|failure| failure.wrong && known_defect(&failure.structure).is_none()) {
            Self::Wrong
        } else if failures.iter().any(|failure| failure.refused) {
            Self::Refused
        } else {
            Self::Right
        }
    }

    /// Wrong takes precedence over failed, and failed over refused.
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
