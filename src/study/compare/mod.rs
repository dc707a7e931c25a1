//! `compare`: every structure builds, is checked, counted and timed on every workload of a scene.

mod cells;
mod means;
mod rank;
mod records;
mod reference;
mod section;
mod study;
mod table;
#[cfg(test)]
pub(crate) mod tests;
mod tradeoff;

use serde::Serialize;

use super::Refused;
use crate::report::Record;

pub use cells::{speed, twins};
pub use means::{Winner, mean_table, winner};
pub use rank::{Rank, Ranked, Ranks, ranks};
pub use records::compared;
pub use reference::{Reference, cell as ratio_cell};
pub use section::bias;
pub use study::{CompareArgs, CompareStudy};
pub use table::{brief_table, details_legend, legend, refusals, scene_table};

/// What came of one scene, or of all of them one after the other.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Compared {
    /// One for each structure and workload, scene by scene and structure by structure.
    pub records: Vec<Record>,
    /// The structures without records.
    pub refused: Vec<Refused>,
    /// The structure that speeds are related to, where one was named.
    pub reference: Option<String>,
    /// Whether tables are printed with all columns.
    #[serde(skip)]
    pub wide: bool,
}

impl Compared {
    /// What speeds are related to.
    pub fn references(&self, records: &[Record]) -> Vec<Reference> {
        Reference::of(records, self.reference.as_deref())
    }
}
