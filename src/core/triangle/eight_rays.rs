use crate::simd::{EightLanes, LaneVec3};

/// Eight valid rays side by side.
#[derive(Clone, Copy)]
pub struct EightRays<L> {
    /// Where they start.
    pub origin: LaneVec3<8, L>,
    /// Where they go.
    pub direction: LaneVec3<8, L>,
    /// Where their intervals begin: not negative.
    pub t_min: L,
    /// Where they end.
    pub t_max: L,
    /// No component of a direction is larger in magnitude.
    pub longest: f32,
    /// No component of an origin is larger in magnitude.
    pub farthest: f32,
}

/// What eight rays find of one triangle.
pub struct EightMet<L: EightLanes> {
    /// Those that meet it within their intervals.
    pub met: L::Mask,
    /// Those that do not, or not before where they look. Of rays that are in neither nothing is known: they have to ask alone. A test of
    /// [one stage](super::TriangleTest::ONE_STAGE) knows all that meet it, and leaves this empty.
    pub missed: L::Mask,
    /// The `t` of those that meet it is not below this.
    pub low: L,
    /// It is not above this.
    pub high: L,
}
