use serde::{Deserialize, Serialize};

use crate::accel::TreeShape;

/// What no machine changes of one case, besides what stands in the record itself; the fields are described in the
/// [module](super).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct CaseCounts {
    pub inner_nodes: usize,
    pub leaves: usize,
    pub empty_leaves: usize,
    pub references: usize,
    pub largest_leaf: usize,
    pub depth: usize,
    pub sah_cost: Option<f64>,
    pub leaf_steps_per_ray: Option<f64>,
    pub empty_leaf_steps_per_ray: Option<f64>,
    pub tests_over_minimum: Option<f64>,
}

impl CaseCounts {
    /// Those of a structure; nothing is known of rays.
    pub fn of(shape: &TreeShape) -> Self {
        Self {
            inner_nodes: shape.inner,
            leaves: shape.leaves,
            empty_leaves: shape.empty,
            references: shape.references,
            largest_leaf: shape.largest_leaf,
            depth: shape.depth,
            sah_cost: shape.sah_cost,
            ..Self::default()
        }
    }
}
