//! What a run leaves: records as JSON, CSV and Markdown, tables for people.
#![doc = include_str!("SCHEMA.md")]

pub mod document;
mod export;
pub mod inspector;
pub mod number;
pub mod plot;
mod record;
mod statement;
mod table;
pub mod words;

pub use export::{Export, to_csv, to_json, to_jsonl, to_tidy_csv};
pub use record::{CaseCounts, Record};
pub use statement::Statement;
pub use table::{Cell, Column, Screen, Table, Tone, escaped, to_markdown, wrapped};

#[cfg(test)]
pub(crate) use record::{example, example as example_record, timed_example};
