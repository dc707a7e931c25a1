//! `sahara report`: measurements of runs as an HTML page, Markdown and CSV files.

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
