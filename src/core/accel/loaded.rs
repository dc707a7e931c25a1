use crate::geometry::Hit;

/// A batch of rays that a structure has loaded ([`Accel::load`](super::Accel::load)).
///
/// The results always equal those from the structure's queries for the same rays, bit for bit.
pub trait Loaded: Send + Sync {
    /// The nearest hits of the rays.
    ///
    /// # Panics
    /// If `hits` and the batch differ in length.
    fn closest_hits(&self, hits: &mut [Option<Hit>]);

    /// For each ray, whether it hits anything.
    ///
    /// # Panics
    /// If `hits` and the batch differ in length.
    fn any_hits(&self, hits: &mut [bool]);

    /// Nanoseconds of the last query, if the structure is [`Remote`](super::Remote) and times itself.
    fn own_ns(&self) -> Option<u64> {
        None
    }
}
