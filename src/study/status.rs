//! What a run comes to.

use serde::{Deserialize, Serialize};

use crate::report::Failure;
use crate::request::known_defect;

/// What a command found; its exit status.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    Right,
    /// A structure gave wrong answers.
    Wrong,
    /// Something could not be measured, and why has been told.
    Failed,
    /// A structure could not be built or panicked; the others are right.
    Refused,
    /// A structure became slower.
    Regression,
    /// The samples do not tell whether a structure became slower.
    Undecided,
    /// It was interrupted before all was measured.
    Interrupted,
}

impl Status {
    /// What these make of a run. Wrong answers of a baseline with known defects do not count.
    pub fn of(failures: &[Failure]) -> Self {
        if failures.iter().any(|failure| failure.wrong && known_defect(&failure.structure).is_none()) {
            Self::Wrong
        } else if failures.iter().any(|failure| failure.refused) {
            Self::Refused
        } else {
            Self::Right
        }
    }

    /// That of two runs: what is wrong weighs more than what failed, and that more than what is refused.
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
