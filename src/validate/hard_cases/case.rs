//! A case, and the macro of the catalogue.

use super::set::Set;
use crate::accel::BuildError;
use crate::validate::conformance::Subject;

/// One entry of the catalogue.
#[derive(Clone, Copy)]
pub struct HardCase {
    /// From 1, ascending in the catalogue.
    pub number: u32,
    /// The name on the command line.
    pub name: &'static str,
    pub rank: Rank,
    pub content: Content,
    /// The reason why systems fail here, in one sentence.
    pub reason: &'static str,
    /// The source of the reason: a paper of `papers/`, a project's source or thread, or a measurement.
    pub source: &'static str,
}

/// The totals that include a case.
///
/// The survey of ray tracers behind the catalogue measured the cases up to number 71 and ranked 59 of them. Not ranked
/// are the empty scene, vertices that are not finite, ends of intervals, origins on a surface, and invalid rays. Ten of
/// the 59 are extreme: scales up to 1e-20 or from 1e15, directions of such lengths, and origins 1e8 away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rank {
    /// Valid input of sizes that a careful user may have: in both totals, of 59 and of 49 cases.
    Moderate,
    /// Valid input of sizes at which `f32` products leave their range: in the total of 59 cases.
    Extreme,
    /// In no total: the input is not valid, no ray can hit, or systems differ in what an interval includes.
    Unranked,
    /// Not measured by the survey: in no total, which keeps totals comparable.
    Added,
}

impl HardCase {
    /// Mesh and rays, at most `most` rays; `None` for a property.
    pub fn set(&self, most: usize) -> Option<Set> {
        match self.content {
            Content::Rays { rays, make, .. } => Some(make(rays.min(most))),
            Content::Property(_) => None,
        }
    }
}

/// The check of a case.
#[derive(Clone, Copy)]
pub enum Content {
    /// The closest hits of rays over one mesh.
    Rays {
        /// Default number of rays.
        rays: usize,
        expected: Expected,
        /// Mesh and rays, the same bits on every machine. The first rays do not depend on the number of rays.
        make: fn(usize) -> Set,
    },
    /// The check of a property of hits, with the number of rays. An error if the structure cannot be built.
    Property(fn(&Subject, usize) -> Result<Property, BuildError>),
}

/// The right hits, as far as they are known without the oracle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// Every ray hits something.
    Hit,
    /// No ray hits anything.
    Miss,
    /// The hits of the exact oracle.
    Oracle,
    /// Every ray hits exactly where the ray with the same index hits in the named case.
    SameAs(&'static str),
}

/// The result of the check of a property.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Property {
    /// Number of comparisons.
    pub checked: u64,
    /// Number of failed comparisons.
    pub broken: u64,
    /// The first failed comparison, in one sentence.
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

/// The table of the cases, `CASES`. A row contains rank, number and name; the expected hits, the number of rays (10,000
/// if omitted) and the generator of mesh and rays, or the check of a property; the reason; the source.
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
