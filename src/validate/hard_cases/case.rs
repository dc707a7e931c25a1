//! A case, and how it is written in the catalogue.

use super::set::Set;
use crate::validate::conformance::Subject;

/// One entry of the catalogue.
#[derive(Clone, Copy)]
pub struct HardCase {
    /// From 1 on, ascending over the catalogue.
    pub number: u32,
    /// As written on the command line.
    pub name: &'static str,
    pub rank: Rank,
    pub content: Content,
    /// Why systems fail here, in a sentence.
    pub reason: &'static str,
    /// Who says so: a paper of `papers/`, a project's source or thread, or what was measured.
    pub source: &'static str,
}

/// Which totals a case counts in.
///
/// The survey measured 71 cases and ranked 59: not the empty scene, vertices that are not finite, the ends of intervals, origins
/// on a surface, and the six kinds of invalid rays. Of the 59, ten are extreme: scales of 1e-20 and less and of 1e15 and
/// more, directions of such lengths (from 1e-20 and 1e15 on), and origins 1e8 away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rank {
    /// Valid input of sizes that a careful user may have: in the totals of both 59 and 49 cases.
    Moderate,
    /// Valid input of sizes at which `f32` products leave their range: in the total of 59 cases.
    Extreme,
    /// In no total: the input is not valid, nothing can be hit, or systems differ about what an interval includes.
    Unranked,
    /// Added to the survey's measured cases: in no total either, so that totals can be compared.
    Added,
}

impl HardCase {
    /// Mesh and rays, at most so many; nothing for a property.
    pub fn set(&self, most: usize) -> Option<Set> {
        match self.content {
            Content::Rays { rays, make, .. } => Some(make(rays.min(most))),
            Content::Property(_) => None,
        }
    }
}

/// What a case checks.
#[derive(Clone, Copy)]
pub enum Content {
    /// The closest hits of rays over one mesh.
    Rays {
        /// Number of rays unless the user wants fewer.
        rays: usize,
        expected: Expected,
        /// Mesh and rays, the same bits on every machine. Fewer rays are the first of more.
        make: fn(usize) -> Set,
    },
    /// Something that hits must have in common, or why it cannot be checked.
    Property(fn(&Subject, usize) -> Result<Property, String>),
}

/// The right hits, as far as they are known without the oracle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// Every ray hits something.
    Hit,
    /// No ray hits anything.
    Miss,
    /// What the exact oracle says.
    Oracle,
    /// Every ray hits, exactly where the ray of the same place in the case of this name does.
    SameAs(&'static str),
}

/// What the check of a property found.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Property {
    /// Comparisons made.
    pub checked: u64,
    /// Those that failed.
    pub broken: u64,
    /// The first that failed, in a sentence.
    pub example: Option<String>,
}

impl Property {
    /// Adds a comparison; `sentence` is called for the first failure only.
    pub(super) fn note(&mut self, holds: bool, sentence: impl FnOnce() -> String) {
        self.checked += 1;
        self.broken += u64::from(!holds);
        if !holds && self.example.is_none() {
            self.example = Some(sentence());
        }
    }
}

/// The table of the cases, `CASES`. A row is rank, number and name; the expected hits, the number of rays unless it is
/// 10,000, and what makes mesh and rays, or the property that is checked; why systems fail here, in a sentence; who says so.
macro_rules! cases {
    ($($rank:ident $number:literal $name:literal, $expected:ident $(($of:literal))? $(x $rays:literal)? => $make:expr,
        $reason:literal, $source:expr;)*) => {
        pub(super) const CASES: &[HardCase] = &[$(HardCase {
            number: $number,
            name: $name,
            rank: Rank::$rank,
            content: cases!(@content $expected $(($of))?, [$($rays,)? 10_000][0], $make),
            reason: $reason,
            source: $source,
        }),*];
    };
    (@content Property, $rays:expr, $check:expr) => { Content::Property($check) };
    (@content $expected:ident $(($of:literal))?, $rays:expr, $make:expr) => {
        Content::Rays { rays: $rays, expected: Expected::$expected $(($of))?, make: $make }
    };
}
pub(super) use cases;
