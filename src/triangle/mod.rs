//! Triangle tests: common property of all structures, so that hits with the same test are bit-identical.

mod moller_trumbore;

use glam::Vec3;

pub use moller_trumbore::MollerTrumbore;

use crate::geometry::Ray;
use crate::simd::{Lanes, Portable};

/// A way to decide whether and where a ray meets a triangle.
///
/// A test is written once, over lanes; one lane is the scalar form. All widths give the same bits.
pub trait TriangleTest: Send + Sync + 'static {
    /// The name used by the command line and records.
    const NAME: &'static str;

    /// What is prepared once a ray.
    type Ray: Copy;

    /// `N` triangles, stored as the test wants them.
    type Block<const N: usize>: Copy + Send + Sync;

    fn prepare(ray: &Ray) -> Self::Ray;

    /// The block of at most `N` triangles, given by their corners. The lanes left over hit nothing.
    ///
    /// # Panics
    /// If there are more than `N` triangles.
    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> Self::Block<N>;

    /// The lanes that the whole line of the ray hits, as bits, and in those lanes `t`, which is not NaN.
    /// The caller holds `t` against its interval.
    fn hits<const N: usize, L: Lanes<N>>(ray: &Self::Ray, block: &Self::Block<N>) -> (u32, L);

    /// The scalar form: `t` where the line of the ray hits the triangle.
    #[inline(always)]
    fn hit(ray: &Self::Ray, triangle: &Self::Block<1>) -> Option<f32> {
        let (hit, t) = Self::hits::<1, Portable<1>>(ray, triangle);
        (hit != 0).then(|| t.store()[0])
    }
}
