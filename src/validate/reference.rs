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

/// Tests one triangle: `t` if the ray hits it within its interval.
pub type ScalarTest = fn(&Ray, [Vec3; 3]) -> Option<f32>;

/// A triangle test with its own reference. Without one, the reference would be brute force with `exact`. The registry
/// offers brute force, and all structures of this crate, only over tests with a reference.
pub(crate) trait HasReference: TriangleTest {}

type OfMesh = fn(&Arc<Mesh>) -> Result<Reference, BuildError>;

macro_rules! references {
    ($($(#[$feature:meta])? $test:ty),* $(,)?) => {
        $($(#[$feature])? impl HasReference for $test {})*

        /// The reference of each test, by its name.
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

/// Rays per task of a thread: few, because brute force takes milliseconds per ray.
const BATCH: usize = 32;

/// A reference, and how strictly hits are compared with its hits.
pub struct Reference {
    /// Returns the hits.
    pub accel: Box<dyn DynAccel>,
    /// The triangle test that structure and reference share, if the reference tests every triangle: their hits must
    /// then be the same bits. `None` if the tests differ, or if the reference may itself have lost hits.
    pub test: Option<ScalarTest>,
    /// The precision of the structure's triangle test, if the reference does not share it: differences that its
    /// rounding explains are not errors of the tree.
    pub precision: Precision,
    /// The structure's own triangle test, if it is known but too slow to run over all triangles. Run on the disputed
    /// triangles, it distinguishes hits lost by the structure from hits that its test does not find.
    pub disputed: Option<ScalarTest>,
}

impl Reference {
    /// Brute force with the triangle test named `test` ([`TRIANGLE_TEST`](crate::accel::Accel::TRIANGLE_TEST)). If this
    /// crate lacks the test, or can run it only on one triangle at a time (Embree), the reference is brute force with
    /// `exact`; in the second case the test itself decides disputed triangles.
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

    /// Brute force with a triangle test that the structure shares.
    pub(super) fn brute_force<T: TriangleTest>(mesh: &Arc<Mesh>) -> Result<Self, BuildError>
    where
        BruteForce<T>: Offered<Config = BruteForceConfig>,
    {
        let accel = BruteForce::<T>::boxed(mesh, &BruteForceConfig::default())?;
        Ok(Self { accel, test: Some(scalar_hit::<T>), precision: Precision::Single, disputed: None })
    }

    #[cfg(feature = "peer-embree")]
    fn in_disputes(disputed: ScalarTest, mesh: &Arc<Mesh>) -> Result<Self, BuildError> {
        // The structure's own test judges disputed triangles: no bound on its rounding is needed.
        let precision = Precision::Exact;
        Ok(Self { test: None, precision, disputed: Some(disputed), ..Self::brute_force::<Exact>(mesh)? })
    }

    /// The closest hits of the reference, one per ray, traced on all threads of the pool.
    pub fn closest_hits(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        self.accel.closest_by_chunks(rays, BATCH)
    }

    /// Whether hits lost by a structure can be distinguished from hits that its triangle test does not find.
    pub fn knows_structure_errors(&self) -> bool {
        self.test.is_some() || self.disputed.is_some()
    }

    /// Uses any other structure as a reference. It may have lost hits, so exact arithmetic judges the differences.
    /// `test` names the triangle test of the structure that is compared with it.
    pub fn structure(accel: Box<dyn DynAccel>, test: &str) -> Self {
        let precision = if test == Exact::NAME { Precision::Exact } else { Precision::Single };
        Self { accel, test: None, precision, disputed: None }
    }
}
