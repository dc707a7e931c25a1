//! The type of a hard case, and the macro that makes the catalogue.

use super::set::Set;
use crate::accel::BuildError;
use crate::validate::conformance::Subject;

#[derive(Clone, Copy)]
pub struct HardCase {
    /// Two cases have the number 23.
    pub number: u32,
    pub name: &'static str,
    pub rank: Rank,
    pub content: Content,
    /// The reason for the case, in one sentence.
    pub reason: &'static str,
    /// The source of `reason`, such as a paper, source code or a measurement. The source `survey` is the survey of ray
    /// tracers behind the cases 1 to 84.
    pub source: &'static str,
}

/// Decides which totals of `validate --hard` include a case. The first total covers the 59 moderate and extreme cases.
/// The second total covers the 49 moderate cases. The survey measured the cases up to number 71 and ranked these 59.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rank {
    /// Valid input of moderate sizes.
    Moderate,
    /// Valid input with scales or direction lengths up to 1e-20 or from 1e15, or with origins 1e8 away.
    Extreme,
    /// Belongs to no total, for example because the rays are invalid.
    Unranked,
    /// Belongs to no total, because the survey did not measure the case.
    Added,
}

impl HardCase {
    /// The mesh and the rays, limited to `most` rays. `None` for a property.
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
        /// Makes the mesh and the given number of rays, with the same bits on every machine. The rays for a smaller
        /// number are a prefix of the rays for a larger number.
        make: fn(usize) -> Set,
    },
    /// The check of a property. The `usize` is the approximate number of rays.
    Property(fn(&Subject, usize) -> Result<Property, BuildError>),
}

/// The right results for the rays of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    Hit,
    Miss,
    /// The hits of the exact oracle.
    Oracle,
    /// Each ray has the exact hit of the ray with the same index in the named case.
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
    /// Counts one comparison, which failed if `holds` is false. Calls `sentence` only for the first failure.
    pub(super) fn note(&mut self, holds: bool, sentence: impl FnOnce() -> String) {
        self.checked += 1;
        self.broken += u64::from(!holds);
        if !holds && self.example.is_none() {
            self.example = Some(sentence());
        }
    }
}

/// Makes the table `CASES`. A row is `RANK NUMBER "NAME", EXPECTED x RAYS => GENERATOR, "REASON", "SOURCE";`. Without
/// `x RAYS`, a case has 10,000 rays. If `EXPECTED` is `Property`, `GENERATOR` is the check of the property.
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
