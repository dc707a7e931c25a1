use crate::simd::{EightLanes, LaneVec3};

/// Eight valid rays side by side.
#[derive(Clone, Copy)]
pub struct EightRays<L> {
    /// Their origins.
    pub origin: LaneVec3<8, L>,
    /// Their directions.
    pub direction: LaneVec3<8, L>,
    /// The beginnings of their intervals, which are not negative.
    pub t_min: L,
    /// The ends of their intervals.
    pub t_max: L,
    /// No component of a direction is larger in magnitude.
    pub longest: f32,
    /// No component of an origin is larger in magnitude.
    pub farthest: f32,
}

/// The hits of eight rays with one triangle.
pub struct EightHits<L: EightLanes> {
    /// The rays that meet the triangle within their intervals.
    pub met: L::Mask,
    /// The rays that miss it, or meet it beyond their current end. Rays in neither mask are undecided, and must be
    /// tested alone. A test of [one stage](super::TriangleTest::ONE_STAGE) decides all rays, and leaves this mask
    /// empty.
    pub missed: L::Mask,
    /// Lower bounds of the `t` of those that meet it.
    pub low: L,
    /// Upper bounds of it.
    pub high: L,
}
