//! Reports of studies as data, with renderers for terminal, Markdown and CSV.

mod cell;
pub mod csv;
pub mod markdown;
pub mod number;
pub mod plot;
#[allow(clippy::module_inception)]
mod report;
mod table;
pub mod terminal;
pub mod words;

pub use cell::{Cell, Format, Tone, Value};
pub use report::{
    Art, Block, ClaimVerdict, Colours, Failure, Figure, Finding, Missing, Outcome, Overlay, Picture, Report,
};
pub use table::{Column, Table};
pub use terminal::Screen;
pub use words::wrapped;
