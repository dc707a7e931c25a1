use serde::{Deserialize, Serialize};

use crate::study::epoch::Epoch;

/// One epoch of one member of the family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemberEpoch {
    pub layers: u32,
    /// Of each kind of rays of the epoch's, by name.
    pub complexity: Vec<(String, f64)>,
    pub epoch: Epoch,
}
