//! `report`: the measurements of runs as a page, Markdown and tidy data.
//!
//! Each study makes its [`Report`](crate::report::Report) from its measurements; a [`Document`] frames the reports, and
//! all formats are written from it. Missing measurements are listed with their commands.

mod document;
mod files;
mod html;
mod pictures;
pub mod results;
mod runs;
mod sections;
#[cfg(test)]
mod tests;

pub use document::{Answer, Document, Headline, Section};
pub use files::files;
pub use html::page;
pub use pictures::{draw, left_out};
pub use runs::{RunError, Runs, StudyRun};
pub use sections::document;
