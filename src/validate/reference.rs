//! The reference that a structure is compared with.

use std::sync::Arc;

use glam::Vec3;

use super::Precision;
use crate::accel::{BuildError, DynAccel};
use crate::brute_force::{BruteForce, BruteForceConfig};
#[cfg(feature = "peer-bvh")]
use crate::external::bvh::SvenstaroTest;
#[cfg(feature = "peer-embree")]
use crate::external::embree::{Embree, alone};
use crate::external::obvhs::RtTest;
#[cfg(feature = "peer-parry")]
use crate::external::parry::ParryTest;
use crate::geometry::{Hit, Mesh, Ray};
use crate::offered::Offered;
use crate::triangle::{
    BaldwinWeber, EdgeF64, Exact, MollerTrumbore, MollerTrumboreF64, Plucker, TriangleTest, Watertight, scalar_hit,
};

/// Returns `t` if the ray hits the triangle in the interval of the ray.
pub type ScalarTest = fn(&Ray, [Vec3; 3]) -> Option<f32>;

/// Marks a triangle test that [`Reference::of_test`] can use for brute force.
pub(crate) trait HasReference: TriangleTest {}

type OfMesh = fn(&Arc<Mesh>) -> Result<Reference, BuildError>;

macro_rules! references {
    ($($(#[$feature:meta])? $test:ty),* $(,)?) => {
        $($(#[$feature])? impl HasReference for $test {})*

        const REFERENCES: &[(&str, OfMesh)] = &[$($(#[$feature])? (<$test>::NAME, Reference::brute_force::<$test>)),*];
    };
}

references!(
    Exact,
    MollerTrumbore,
    Watertight,
    BaldwinWeber,
    Plucker,
    MollerTrumboreF64,
    EdgeF64,
    RtTest,
    #[cfg(feature = "peer-bvh")]
    SvenstaroTest,
    #[cfg(feature = "peer-parry")]
    ParryTest,
);

/// Rays per task of the thread pool. The number is small, because brute force takes milliseconds per ray.
const BATCH: usize = 32;

/// A reference structure, with the rules for comparisons.
pub struct Reference {
    /// The structure whose hits are expected.
    pub accel: Box<dyn DynAccel>,
    /// The common triangle test of the reference and the tested structure. `None` if the triangle tests differ.
    /// [`Reference::structure`] always sets `None`. With a common test, hits on one primitive must have equal bits.
    pub test: Option<ScalarTest>,
    /// The assumed precision of the triangle test of the tested structure. Used only if `test` is `None`.
    pub precision: Precision,
    /// The triangle test of the tested structure, for the triangles of differing hits. `None` unless brute force with
    /// this test is too slow.
    pub disputed: Option<ScalarTest>,
}

impl Reference {
    /// Brute force with the triangle test named `test`. The test `exact` replaces an unknown or slow test.
    ///
    /// # Errors
    /// If the reference cannot be built over the mesh.
    pub fn of_test(test: &str, mesh: &Arc<Mesh>) -> Result<Self, BuildError> {
        match test {
            #[cfg(feature = "peer-embree")]
            <Embree<false> as crate::accel::Accel>::TRIANGLE_TEST => Self::in_disputes(alone::<false>, mesh),
            #[cfg(feature = "peer-embree")]
            <Embree<true> as crate::accel::Accel>::TRIANGLE_TEST => Self::in_disputes(alone::<true>, mesh),
            test => match REFERENCES.iter().find(|(name, _)| *name == test) {
                Some((_, reference)) => reference(mesh),
                None => Ok(Self { test: None, ..Self::brute_force::<Exact>(mesh)? }),
            },
        }
    }

    pub(super) fn brute_force<T: TriangleTest>(mesh: &Arc<Mesh>) -> Result<Self, BuildError>
    where
        BruteForce<T>: Offered<Config = BruteForceConfig>,
    {
        let accel = BruteForce::<T>::boxed(mesh, &BruteForceConfig::default())?;
        Ok(Self { accel, test: Some(scalar_hit::<T>), precision: Precision::Single, disputed: None })
    }

    #[cfg(feature = "peer-embree")]
    fn in_disputes(disputed: ScalarTest, mesh: &Arc<Mesh>) -> Result<Self, BuildError> {
        // No rounding bound is needed, because the test `disputed` judges differing hits.
        let precision = Precision::Exact;
        Ok(Self { test: None, precision, disputed: Some(disputed), ..Self::brute_force::<Exact>(mesh)? })
    }

    /// The closest hits of the reference, one per ray.
    pub fn closest_hits(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        self.accel.closest_by_chunks(rays, BATCH)
    }

    /// Whether a comparison distinguishes errors of the structure from errors of its triangle test.
    pub fn knows_structure_errors(&self) -> bool {
        self.test.is_some() || self.disputed.is_some()
    }

    /// Uses the structure `accel` as the reference. `test` is the name of the triangle test of the tested structure.
    /// Exact arithmetic judges the differences, because `accel` may lose hits.
    pub fn structure(accel: Box<dyn DynAccel>, test: &str) -> Self {
        let precision = if test == Exact::NAME { Precision::Exact } else { Precision::Single };
        Self { accel, test: None, precision, disputed: None }
    }
}
