//! The structures of other projects whose features are enabled.

use super::Registry;

impl Registry {
    /// Each over its own triangle test first, then over the tests of this crate that it supports.
    // Without any feature nothing is added.
    #[allow(clippy::let_and_return)]
    pub(super) fn with_peers(self) -> Self {
        let this = self;

        #[cfg(feature = "peer-bvh")]
        let this = {
            use crate::external::bvh::{SvenstaroBvh, SvenstaroBvhConfig, SvenstaroTest};
            use crate::triangle::{Exact, MollerTrumbore};
            let config = SvenstaroBvhConfig::default();
            this.offering::<SvenstaroBvh<SvenstaroTest>>("bvh", config)
                .offering::<SvenstaroBvh<MollerTrumbore>>("bvh", config)
                .offering::<SvenstaroBvh<Exact>>("bvh", config)
                .brute_force::<SvenstaroTest>()
        };

        #[cfg(feature = "peer-parry")]
        let this = {
            use crate::external::parry::{ParryBvh, ParryConfig, ParryTest};
            use crate::triangle::{Exact, MollerTrumbore};
            let config = ParryConfig::default();
            this.offering::<ParryBvh<ParryTest>>("parry", config)
                .offering::<ParryBvh<MollerTrumbore>>("parry", config)
                .offering::<ParryBvh<Exact>>("parry", config)
                .brute_force::<ParryTest>()
        };

        #[cfg(feature = "peer-tinybvh")]
        let this = this.offering::<crate::external::tinybvh::TinyBvh>("tinybvh", Default::default());

        #[cfg(feature = "peer-embree")]
        let this = {
            use crate::external::embree::{Embree, EmbreeConfig};
            this.offering::<Embree<false>>("embree", EmbreeConfig::default())
                .offering::<Embree<true>>("embree-robust", EmbreeConfig::default())
        };

        this
    }
}
