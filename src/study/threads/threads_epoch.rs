use serde::{Deserialize, Serialize};

use crate::study::epoch::Epoch;

/// One epoch of one scene with so many threads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ThreadsEpoch {
    pub threads: usize,
    pub epoch: Epoch,
}
