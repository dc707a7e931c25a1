use serde::{Deserialize, Serialize};

/// Build quality. Slower builds give better trees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// Few candidate planes, small samples of large nodes, and at most 1.75 references per triangle on average.
    Fast,
    /// A finer search for splits and more passes of subtree reinsertion than with `Fast`.
    #[default]
    Balanced,
    /// More passes of subtree reinsertion than with `Balanced`. The search for split planes is also more precise.
    High,
}
