use crate::simd::{EightLanes, LaneVec3};

/// Eight [valid](crate::geometry::Ray::is_valid) rays, one per lane.
#[derive(Clone, Copy)]
pub struct EightRays<L> {
    /// The origins of the rays.
    pub origin: LaneVec3<8, L>,
    /// The directions of the rays.
    pub direction: LaneVec3<8, L>,
    /// The starts of the intervals. No start is negative.
    pub t_min: L,
    /// The ends of the intervals.
    pub t_max: L,
    /// An upper bound of the magnitudes of all direction components.
    pub longest: f32,
    /// An upper bound of the magnitudes of all origin components.
    pub farthest: f32,
}

/// The hits of eight rays with one triangle.
pub struct EightHits<L: EightLanes> {
    /// Rays that certainly hit the triangle within their intervals.
    pub met: L::Mask,
    /// Rays that have no hit up to the argument `to` of [`meet_eight`](super::TriangleTest::meet_eight).
    ///
    /// If [`ONE_STAGE`](super::TriangleTest::ONE_STAGE) is true, all rays outside `met` miss. Otherwise, rays in
    /// neither `met` nor `missed` must be tested individually.
    pub missed: L::Mask,
    /// Lower bounds of `t` for the rays in `met`.
    pub low: L,
    /// Upper bounds of `t` for the rays in `met`.
    pub high: L,
}
