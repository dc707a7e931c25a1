use crate::geometry::Hit;

/// A batch of rays that a structure has taken ([`Accel::load`](super::Accel::load)), to be answered as often as one
/// likes: what is timed.
///
/// Every time the answers are those of the structure's own queries to the same rays, bit for bit.
pub trait Loaded: Send + Sync {
    /// The nearest hits of the rays.
    ///
    /// # Panics
    /// If there are not as many slots as rays.
    fn closest_hits(&self, hits: &mut [Option<Hit>]);

    /// For each ray, whether it hits anything.
    ///
    /// # Panics
    /// If there are not as many slots as rays.
    fn any_hits(&self, hits: &mut [bool]);

    /// Nanoseconds of the last answer, where the structure is [`Remote`](super::Remote) and times itself.
    fn own_ns(&self) -> Option<u64> {
        None
    }
}
