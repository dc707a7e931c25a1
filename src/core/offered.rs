//! Builds structures with code that is compiled in this crate and not in the crates of the callers.
//!
//! To add a structure, add its type to a call of `offered!`.

use std::sync::Arc;

use crate::accel::{Accel, BuildError, DynAccel};
use crate::brute_force::BruteForce;
use crate::bvh8::Bvh8;
#[cfg(feature = "peer-bvh")]
use crate::external::bvh::{SvenstaroBvh, SvenstaroTest};
#[cfg(feature = "peer-embree")]
use crate::external::embree::Embree;
use crate::external::obvhs::{Native, ObvhsBvh2, ObvhsCwBvh, Over, RtTest};
#[cfg(feature = "peer-parry")]
use crate::external::parry::{ParryBvh, ParryTest};
use crate::geometry::Mesh;
use crate::kdtree::KdTree;
use crate::triangle::{BaldwinWeber, EdgeF64, Exact, MollerTrumbore, MollerTrumboreF64, Plucker, Watertight};

/// A structure whose function `boxed` is compiled in this crate and not in the crates of the callers.
pub trait Offered: Accel {
    /// Builds the structure and erases its type.
    ///
    /// # Errors
    /// If the mesh or the configuration is rejected.
    fn boxed(mesh: &Arc<Mesh>, config: &Self::Config) -> Result<Box<dyn DynAccel>, BuildError>;
}

macro_rules! offered {
    ($($structure:ty),* $(,)?) => {$(
        impl Offered for $structure {
            // A function that is neither generic nor inlined is compiled only in this crate.
            #[inline(never)]
            fn boxed(mesh: &Arc<Mesh>, config: &Self::Config) -> Result<Box<dyn DynAccel>, BuildError> {
                Ok(Box::new(Self::build(mesh, config)?))
            }
        }
    )*};
}

macro_rules! offered_over {
    ($($test:ty),* $(,)?) => {
        $(offered!(BruteForce<$test>, KdTree<$test>, Bvh8<$test>);)*
    };
}

offered_over!(Exact, MollerTrumbore, Watertight, BaldwinWeber, Plucker, MollerTrumboreF64, EdgeF64);

offered!(
    ObvhsBvh2<Native>,
    ObvhsBvh2<Over<MollerTrumbore>>,
    ObvhsBvh2<Over<Exact>>,
    ObvhsCwBvh<Native>,
    ObvhsCwBvh<Over<MollerTrumbore>>,
    ObvhsCwBvh<Over<Exact>>,
    BruteForce<RtTest>,
);

#[cfg(feature = "peer-bvh")]
offered!(SvenstaroBvh<SvenstaroTest>, SvenstaroBvh<MollerTrumbore>, SvenstaroBvh<Exact>, BruteForce<SvenstaroTest>);

#[cfg(feature = "peer-parry")]
offered!(ParryBvh<ParryTest>, ParryBvh<MollerTrumbore>, ParryBvh<Exact>, BruteForce<ParryTest>);

#[cfg(feature = "peer-tinybvh")]
offered!(crate::external::tinybvh::TinyBvh);

#[cfg(feature = "peer-embree")]
offered!(Embree<false>, Embree<true>);
