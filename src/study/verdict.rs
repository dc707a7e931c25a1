//! Summarises for users whether a structure is right.

use serde::{Deserialize, Serialize};

use crate::report::number::{count, plural};
use crate::validate::{Kind, Validation};

/// The outcome over all checked rays of a structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Verdict {
    pub rays: u64,
    /// Errors that rounding cannot explain, at most `rays`.
    pub wrong: u64,
    /// Errors that rounding may explain. Errors of `t` that `DepthRule::STRICT` allows are not counted.
    #[serde(default)]
    pub rounded: u64,
    /// The worst kind of error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<Kind>,
}

impl From<&Validation> for Verdict {
    fn from(found: &Validation) -> Self {
        Self {
            rays: found.rays,
            wrong: found.errors().min(found.rays),
            rounded: found.test_errors + found.depth_errors,
            fault: found.worst_error().map(|worst| worst.kind),
        }
    }
}

impl Verdict {
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let fault = self.fault.into_iter().chain(other.fault).min();
        Self {
            rays: self.rays + other.rays,
            wrong: self.wrong + other.wrong,
            rounded: self.rounded + other.rounded,
            fault,
        }
    }

    pub fn sentence(self, name: &str) -> String {
        let all = plural(self.rays as usize, "ray");
        let of = |rays: u64| format!("{} of {all}", count(rays));
        match (self.rays, self.wrong, self.rounded) {
            (0, 0, _) => format!("{name} was not checked: no ray that it accepts was traced."),
            (_, 0, 0) => format!("{name} is right on {all}."),
            (_, 0, rounded) => format!(
                "{name} differs from the exact hits on {}, always within the rounding of the triangle test; no error \
                 of the tree was found.",
                of(rounded)
            ),
            (_, wrong, _) => {
                let (does, so) = self.fault.map_or(("is wrong", "the tree is wrong"), fault);
                format!("{name} {does}, on {}: {so}.", of(wrong))
            }
        }
    }
}

/// Returns a phrase for the behaviour of the structure and a phrase for the cause.
fn fault(kind: Kind) -> (&'static str, &'static str) {
    const TREE: &str = "the tree is wrong";
    const EITHER: &str = "the tree or its triangle test is wrong";
    const QUERY: &str = "one of the two queries is wrong";
    match kind {
        Kind::Hangs => ("does not return", TREE),
        Kind::Panicked => ("panics or exits", TREE),
        Kind::Lost | Kind::NearerLost => ("loses hits that no rounding explains", TREE),
        Kind::Invented => ("returns hits that no rounding explains", EITHER),
        Kind::WrongT => ("returns depths that no rounding explains", EITHER),
        Kind::WrongPrimitive => ("names triangles that are not hit there", TREE),
        Kind::AnyHitDisagrees => ("contradicts itself: any hit and closest hit disagree", QUERY),
        Kind::Unrepeatable => ("returns different hits for a ray in a batch and on its own", TREE),
        _ => ("is wrong", EITHER),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_says_how_wrong_a_structure_is_and_what_follows() {
        let right = Verdict { rays: 60_000, ..Verdict::default() };
        let rounds = Verdict { rays: 10_000, rounded: 3, ..Verdict::default() };
        let lost = Verdict { rays: 10_000, wrong: 12, rounded: 1, fault: Some(Kind::Lost) };
        let off = Verdict { wrong: 1, fault: Some(Kind::WrongT), ..right };
        for (verdict, expected) in [
            (Verdict::default(), "mine was not checked: no ray that it accepts was traced."),
            (right, "mine is right on 60,000 rays."),
            (
                right.and(rounds),
                "mine differs from the exact hits on 3 of 70,000 rays, always within the rounding of the triangle \
                 test; no error of the tree was found.",
            ),
            (rounds.and(lost), "mine loses hits that no rounding explains, on 12 of 20,000 rays: the tree is wrong."),
            (off.and(lost), "mine loses hits that no rounding explains, on 13 of 70,000 rays: the tree is wrong."),
        ] {
            assert_eq!(verdict.sentence("mine"), expected);
        }
    }
}
