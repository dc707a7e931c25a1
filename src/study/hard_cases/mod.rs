//! The hard cases: what ray tracers are known to get wrong, each with a generator and the answer that is owed.
//!
//! A case is data: a name, a reason with its source, and either rays over a mesh or a property that answers must have. The
//! numbers 1 to 84 are those of the survey that the catalogue was made from; number 23 stands at two scales; those from 85 on
//! were found in this crate.
//! [`ask`] puts a case to a structure, [`Score`] holds the answers against the truth.

mod ask;
mod boxes;
mod closed;
mod crowds;
mod extremes;
mod flats;
mod found;
mod intervals;
mod invalid;
mod lengths;
mod metamorphic;
mod properties;
mod record;
mod score;
mod set;
mod slender;
mod table;
#[cfg(test)]
mod tests;

pub use ask::{Answers, AnswersError, Head, ask};
pub use record::{HardRecord, HardRun};
pub use score::{Court, Failure, RayScore, Score, Totals};
pub use set::Set;
pub use table::{Column, legend, tables};

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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// How many rays it asks where at most `most` are wanted; nothing for a property. Makes them.
    pub fn rays(&self, most: usize) -> Option<usize> {
        match self.content {
            Content::Rays { rays, make, .. } => Some(make(rays.min(most)).rays.len()),
            Content::Property(_) => None,
        }
    }
}

/// What a case asks.
#[derive(Clone, Copy)]
pub enum Content {
    /// The closest hits of rays over one mesh.
    Rays {
        /// So many rays unless the user wants fewer.
        rays: usize,
        expected: Expected,
        /// Mesh and rays, the same bits on every machine. Fewer rays are the first of more.
        make: fn(usize) -> Set,
    },
    /// Something that answers must have in common.
    Property(fn(&Subject, usize) -> Property),
}

impl Content {
    /// So many rays has a case that names no other number.
    const RAYS: usize = 10_000;

    const fn hit(make: fn(usize) -> Set) -> Self {
        Self::Rays { rays: Self::RAYS, expected: Expected::Hit, make }
    }

    const fn miss(make: fn(usize) -> Set) -> Self {
        Self::Rays { rays: Self::RAYS, expected: Expected::Miss, make }
    }

    const fn oracle(make: fn(usize) -> Set) -> Self {
        Self::Rays { rays: Self::RAYS, expected: Expected::Oracle, make }
    }

    /// The same with another number of rays.
    const fn of(self, rays: usize) -> Self {
        match self {
            Self::Rays { expected, make, .. } => Self::Rays { rays, expected, make },
            Self::Property(check) => Self::Property(check),
        }
    }
}

/// The right answers to the rays of a case, as far as they are known without looking.
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

/// What a property found.
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
    /// Adds a comparison; `sentence` is asked for the first failure only.
    fn note(&mut self, holds: bool, sentence: impl FnOnce() -> String) {
        self.checked += 1;
        self.broken += u64::from(!holds);
        if !holds && self.example.is_none() {
            self.example = Some(sentence());
        }
    }

    /// Adds further comparisons.
    fn append(&mut self, other: Self) {
        self.checked += other.checked;
        self.broken += other.broken;
        self.example = self.example.take().or(other.example);
    }
}

/// A name that is no case.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no hard case {name:?}; the nearest names are: {nearest}; `sahara list hard` names all")]
pub struct UnknownCase {
    name: String,
    nearest: String,
}

/// All cases, in the order of their numbers.
pub fn catalogue() -> Vec<&'static HardCase> {
    let families: [&'static [HardCase]; 11] = [
        closed::CASES,
        boxes::CASES,
        flats::CASES,
        lengths::CASES,
        slender::CASES,
        crowds::CASES,
        extremes::CASES,
        intervals::CASES,
        invalid::CASES,
        properties::CASES,
        found::CASES,
    ];
    let mut cases: Vec<&HardCase> = families.into_iter().flatten().collect();
    // Stable: the two scales of number 23 keep their order.
    cases.sort_by_key(|case| case.number);
    cases
}

/// The first of [`find_all`].
///
/// # Errors
/// As there.
pub fn find(name: &str) -> Result<&'static HardCase, UnknownCase> {
    Ok(find_all(name)?[0])
}

/// The case called `name`, in any case of letters, or all that are numbered so: number 23 is two.
///
/// # Errors
/// If there is none: names the three that differ least.
pub fn find_all(name: &str) -> Result<Vec<&'static HardCase>, UnknownCase> {
    let mut cases = catalogue();
    let mut names: Vec<&str> = cases.iter().map(|case| case.name).collect();
    cases.retain(|case| case.name.eq_ignore_ascii_case(name) || case.number.to_string() == name);
    if !cases.is_empty() {
        return Ok(cases);
    }
    names.sort_by_key(|known| (!known.contains(name), strsim::osa_distance(name, known)));
    Err(UnknownCase { name: name.into(), nearest: names[..3].join(", ") })
}
