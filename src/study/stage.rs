use std::borrow::Cow;

use serde::{Deserialize, Serialize};

/// The current activity of a study, reported between timed regions.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage<'a> {
    /// A structure is being built.
    Build(#[serde(borrow)] Cow<'a, str>),
    /// Rays are being made.
    Rays(#[serde(borrow)] Cow<'a, str>),
    /// A structure is being compared with brute force.
    Check(#[serde(borrow)] Cow<'a, str>),
    /// The number of samples taken, and of all samples.
    Trace(usize, usize),
    /// All samples of epoch 0 are taken. The work per ray is being counted: no more timing follows.
    Count,
}
