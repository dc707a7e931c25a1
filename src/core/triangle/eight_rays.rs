use crate::simd::{EightLanes, LaneVec3};

/// Eight valid rays, one per lane.
#[derive(Clone, Copy)]
pub struct EightRays<L> {
    /// The origins of the rays.
    pub origin: LaneVec3<8, L>,
    /// The directions of the rays.
    pub direction: LaneVec3<8, L>,
    /// The starts of the intervals. They are not negative.
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
    /// The rays that hit the triangle within their intervals.
    pub met: L::Mask,
    /// The rays without a hit up to the `to` of [`meet_eight`](super::TriangleTest::meet_eight).
    ///
    /// Rays in neither mask must be tested individually. A [one-stage test](super::TriangleTest::ONE_STAGE) leaves
    /// `missed` empty. Then all rays outside `met` miss.
    pub missed: L::Mask,
    /// Lower bounds of `t` for the rays in `met`.
    pub low: L,
    /// Upper bounds of `t` for the rays in `met`.
    pub high: L,
}
