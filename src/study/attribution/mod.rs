//! `attribution`: what of a SAH tree's speed is due to the split plane, what to the stop rule and what to the traversal?
//!
//! One kind of tree in every combination of six planes, three stop rules and two traversals, over one triangle test, on the
//! same rays: the factorial [`design`]. In every epoch all trees are built anew and timed in rounds, each round every tree once, in
//! random order; the report's tree and the SAH tree are built twice, and what the twins differ by is the A/A noise. A case of the
//! journal is one epoch of one scene.

pub mod design;
pub mod effects;
mod result;
mod table;
#[cfg(test)]
pub(crate) mod tests;

use crate::registry::{Choice, ChoiceError, Registry};
use design::Cell;

pub use result::{Attribution, CellResult, Effect, Part, Row, Split, Term, result, rows};
pub use table::{headlines, tables};

/// Name of the study, and of its journal; a case is an [`Epoch`](super::epoch::Epoch).
pub const NAME: &str = "attribution";

/// The cells of the design in their order, then the twins of the report's tree and of the SAH tree, over one triangle test.
///
/// # Errors
/// If the test is not known.
pub fn structures(registry: &Registry, test: &str) -> Result<Vec<Choice>, ChoiceError> {
    let cells = Cell::all().into_iter().chain([Cell::REPORT, Cell::SAH]);
    cells.map(|cell| registry.choose(&cell.spec(test))).collect()
}
