//! `report`: the measurements of runs as a page, Markdown and tidy data.
//!
//! Each study makes its [`Report`](crate::report::Report) from its measurements; a [`Document`] frames the reports, and
//! all formats are written from it. Missing measurements are listed with their commands.

mod document;
mod files;
mod html;
mod markdown;
mod pictures;
pub mod results;
mod run_error;
mod runs;
mod sections;
#[cfg(test)]
mod tests;

pub use document::{Answer, Document, Headline, Section};
pub use files::files;
pub use html::page;
pub use pictures::{draw, left_out};
pub use run_error::RunError;
pub use runs::{Runs, StudyRun};
pub use sections::document;
