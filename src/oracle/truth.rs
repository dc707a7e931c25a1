use crate::exact::ExactT;

/// The exact nearest hit of a ray.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Truth {
    /// The exact `t`.
    pub t: ExactT,
    /// The numbers of all triangles that are hit there, ascending; at least one.
    pub ids: Vec<u32>,
    /// Bits of the `f32` nearest to `t`.
    pub(super) rounded: u32,
}

impl Truth {
    /// The `f32` nearest to `t`, ties to even.
    pub fn rounded(&self) -> f32 {
        f32::from_bits(self.rounded)
    }
}
