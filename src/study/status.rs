//! The result of a run.

use serde::{Deserialize, Serialize};

use crate::report::Failure;
use crate::request::known_defect;

/// Determines the exit status of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    Right,
    Wrong,
    /// A measurement or comparison failed. The command that returns `Failed` prints the reason.
    Failed,
    /// A structure failed to build, panicked or was skipped. A comparison with a threshold also returns
    /// `Refused` if the new result lacks a measurement.
    Refused,
    Regression,
    /// The comparison of an old and a new result is inconclusive.
    Undecided,
    Interrupted,
}

impl Status {
    /// Wrong hits of a structure with known defects do not cause `Wrong`.
    pub fn of(failures: &[Failure]) -> Self {
        if failures.iter().any(|failure| failure.wrong && known_defect(&failure.structure).is_none()) {
            Self::Wrong
        } else if failures.iter().any(|failure| failure.refused) {
            Self::Refused
        } else {
            Self::Right
        }
    }

    /// `Wrong` takes precedence over `Failed`. `Failed` takes precedence over `Refused`.
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
