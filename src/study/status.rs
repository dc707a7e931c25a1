//! What a run comes to.

use serde::{Deserialize, Serialize};

use super::documented_defect;

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

/// A structure without times, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trouble {
    /// Name in the registry.
    pub structure: String,
    /// What to print below the tables; empty where a table says it.
    pub sentence: String,
    /// Whether it took no part at all.
    pub refused: bool,
    /// Whether it gave wrong answers.
    pub wrong: bool,
}

impl Status {
    /// What these make of a run. Wrong answers of a baseline whose defects are documented do not count.
    pub fn of(troubles: &[Trouble]) -> Self {
        if troubles.iter().any(|t| t.wrong && documented_defect(&t.structure).is_none()) {
            Self::Wrong
        } else if troubles.iter().any(|trouble| trouble.refused) {
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
