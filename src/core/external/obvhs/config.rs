use obvhs::BvhBuildParams;
use serde::{Deserialize, Serialize};

/// The build options of obvhs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObvhsConfig {
    /// One of the crate's presets.
    pub preset: Preset,
    /// When its rays are prepared.
    pub rays: Rays,
}

/// When a ray is converted to the ray of obvhs, with its inverse direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rays {
    /// In the query, inside the timed region, like the structures of this crate.
    #[default]
    Asked,
    /// When a batch is loaded, before the clock starts.
    Loaded,
}

/// The presets of obvhs, from the fastest build to the best tree. Only `slow` and `very-slow` split large triangles, so
/// only these two compare fairly with a KD-tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum Preset {
    Fastest,
    VeryFast,
    Fast,
    Medium,
    Slow,
    #[default]
    VerySlow,
}

impl Preset {
    pub(super) fn params(self) -> BvhBuildParams {
        match self {
            Self::Fastest => BvhBuildParams::fastest_build(),
            Self::VeryFast => BvhBuildParams::very_fast_build(),
            Self::Fast => BvhBuildParams::fast_build(),
            Self::Medium => BvhBuildParams::medium_build(),
            Self::Slow => BvhBuildParams::slow_build(),
            Self::VerySlow => BvhBuildParams::very_slow_build(),
        }
    }
}
