//! The type of a hard case, and the macro that makes the catalogue.

use super::set::Set;
use crate::accel::BuildError;
use crate::validate::conformance::Subject;

#[derive(Clone, Copy)]
pub struct HardCase {
    /// Starts at 1 and ascends in the catalogue. Two cases have the number 23.
    pub number: u32,
    pub name: &'static str,
    pub rank: Rank,
    pub content: Content,
    /// The reason why systems fail here, in one sentence.
    pub reason: &'static str,
    /// The source of the reason: a paper in `papers/`, source code or a discussion of a project, or a measurement.
    pub source: &'static str,
}

/// Whether a case belongs to the two totals that `validate --hard` prints. The first total is over the 59 moderate and
/// extreme cases. The second total is over the 49 moderate cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rank {
    /// Valid input of moderate sizes.
    Moderate,
    /// Valid input of sizes at which `f32` products leave their range.
    Extreme,
    /// Belongs to no total: the input is invalid, no ray can hit, or systems differ in the ends of intervals.
    Unranked,
    /// Belongs to no total, because the survey that ranked the cases did not measure this case.
    Added,
}

impl HardCase {
    /// At most `most` rays, and their mesh. `None` for a property.
    pub fn set(&self, most: usize) -> Option<Set> {
        match self.content {
            Content::Rays { rays, make, .. } => Some(make(rays.min(most))),
            Content::Property(_) => None,
        }
    }
}

#[derive(Clone, Copy)]
pub enum Content {
    Rays {
        /// Default and maximum number of rays.
        rays: usize,
        expected: Expected,
        /// Makes mesh and rays, with the same bits on every machine. A smaller number gives the first of these rays.
        make: fn(usize) -> Set,
    },
    /// The check of a property. The `usize` is the approximate number of rays.
    Property(fn(&Subject, usize) -> Result<Property, BuildError>),
}

/// The right hits of the rays of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    Hit,
    Miss,
    /// The hits of the exact oracle.
    Oracle,
    /// Every ray hits exactly where the ray with the same index hits in the named case.
    SameAs(&'static str),
}

#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Property {
    /// Number of comparisons.
    pub checked: u64,
    pub broken: u64,
    /// The first failed comparison, in one sentence.
    pub example: Option<String>,
}

impl Property {
    /// Adds a comparison that succeeded if `holds`. Calls `sentence` only for the first failure.
    pub(super) fn note(&mut self, holds: bool, sentence: impl FnOnce() -> String) {
        self.checked += 1;
        self.broken += u64::from(!holds);
        if !holds && self.example.is_none() {
            self.example = Some(sentence());
        }
    }
}

/// Makes the table `CASES`. A row is `RANK NUMBER "NAME", EXPECTED x RAYS => GENERATOR, "REASON", "SOURCE";`. Without
/// `x RAYS`, a case has 10,000 rays. If `EXPECTED` is `Property`, the check of the property replaces the generator.
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
