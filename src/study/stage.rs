use std::borrow::Cow;

use serde::{Deserialize, Serialize};

/// What a study is doing, told between timed regions.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage<'a> {
    /// A structure is being built.
    Build(#[serde(borrow)] Cow<'a, str>),
    /// Rays are being made.
    Rays(#[serde(borrow)] Cow<'a, str>),
    /// A structure is being held against brute force.
    Check(#[serde(borrow)] Cow<'a, str>),
    /// So many samples of so many are taken.
    Trace(usize, usize),
    /// All samples of the first epoch are taken. What is done for rays is being counted: nothing is timed any more.
    Count,
}
