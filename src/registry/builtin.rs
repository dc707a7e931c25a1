//! The built-in structures: ours, obvhs, and the peers.

use super::Registry;
use crate::brute_force::{BruteForce, BruteForceConfig};
use crate::bvh8::{Bvh8, Bvh8Config, Partition};
use crate::external::obvhs::{Native, ObvhsBvh2, ObvhsConfig, ObvhsCwBvh, Over, RtTest};
use crate::kdtree::{KdConfig, KdTree};
use crate::offered::Offered;
use crate::scene::spheres;
use crate::triangle::{BaldwinWeber, EdgeF64, Exact, MollerTrumbore, MollerTrumboreF64, Plucker, Watertight};
use crate::validate::HasReference;

impl Registry {
    pub fn builtin() -> Self {
        // The first triangle test of a structure name is the default test. Our structures use `Exact` by default.
        // The default test of a peer is the test of the peer's library.
        let ours = Self::empty()
            .over::<Exact>()
            .over::<MollerTrumbore>()
            .over::<Watertight>()
            .over::<BaldwinWeber>()
            .over::<Plucker>()
            .over::<MollerTrumboreF64>()
            .over::<EdgeF64>();
        let with_obvhs = ours
            .offering::<ObvhsBvh2<Native>>("obvhs-bvh2", ObvhsConfig::default())
            .offering::<ObvhsBvh2<Over<MollerTrumbore>>>("obvhs-bvh2", ObvhsConfig::default())
            .offering::<ObvhsBvh2<Over<Exact>>>("obvhs-bvh2", ObvhsConfig::default())
            .offering::<ObvhsCwBvh<Native>>("obvhs-cwbvh", ObvhsConfig::default())
            .offering::<ObvhsCwBvh<Over<MollerTrumbore>>>("obvhs-cwbvh", ObvhsConfig::default())
            .offering::<ObvhsCwBvh<Over<Exact>>>("obvhs-cwbvh", ObvhsConfig::default())
            .brute_force::<RtTest>();
        let mut all = with_obvhs.with_peers().with_generator("icosphere", spheres::generate);
        all.entries.iter_mut().for_each(|entry| entry.is_builtin = true);
        all
    }

    fn brute_force<T: HasReference>(self) -> Self
    where
        BruteForce<T>: Offered<Config = BruteForceConfig>,
    {
        self.offering::<BruteForce<T>>("brute-force", BruteForceConfig::default())
    }

    fn over<T: HasReference>(self) -> Self
    where
        BruteForce<T>: Offered<Config = BruteForceConfig>,
        KdTree<T>: Offered<Config = KdConfig>,
        Bvh8<T>: Offered<Config = Bvh8Config>,
    {
        self.brute_force::<T>()
            .offering::<KdTree<T>>("median-kd", KdConfig::REPORT)
            .offering::<KdTree<T>>("sah-kd", KdConfig::SAH)
            .offering::<Bvh8<T>>("sah-kd-wide", Bvh8Config::new(Partition::Cells))
            .offering::<Bvh8<T>>("sah-kd-tight", Bvh8Config::new(Partition::Tight))
            .offering::<Bvh8<T>>("sah-hybrid", Bvh8Config::new(Partition::Hybrid))
            .offering::<Bvh8<T>>("sah-bvh", Bvh8Config::new(Partition::Objects))
    }

    // If no feature is enabled, this function only returns `this`.
    #[allow(clippy::let_and_return)]
    fn with_peers(self) -> Self {
        let this = self;

        #[cfg(feature = "peer-bvh")]
        let this = {
            use crate::external::bvh::{SvenstaroBvh, SvenstaroTest};
            this.offering::<SvenstaroBvh<SvenstaroTest>>("bvh", ())
                .offering::<SvenstaroBvh<MollerTrumbore>>("bvh", ())
                .offering::<SvenstaroBvh<Exact>>("bvh", ())
                .brute_force::<SvenstaroTest>()
        };

        #[cfg(feature = "peer-parry")]
        let this = {
            use crate::external::parry::{ParryBvh, ParryTest};
            this.offering::<ParryBvh<ParryTest>>("parry", ())
                .offering::<ParryBvh<MollerTrumbore>>("parry", ())
                .offering::<ParryBvh<Exact>>("parry", ())
                .brute_force::<ParryTest>()
        };

        #[cfg(feature = "peer-tinybvh")]
        let this = this.offering::<crate::external::tinybvh::TinyBvh>("tinybvh", ());

        #[cfg(feature = "peer-embree")]
        let this = {
            use crate::external::embree::{Embree, EmbreeConfig};
            this.offering::<Embree<false>>("embree", EmbreeConfig::default())
                .offering::<Embree<true>>("embree-robust", EmbreeConfig::default())
        };

        this
    }
}
