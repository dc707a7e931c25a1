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

    /// Nanoseconds of the last query, if the structure is [`Remote`] and times itself.
    fn own_ns(&self) -> Option<u64> {
        None
    }
}

/// A structure in another process, which may end at any time. It times itself: the time of a query is
/// [`Loaded::own_ns`] of the batch.
///
/// After a failure its queries return misses, which have no meaning.
pub trait Remote {
    /// Nanoseconds of the build, by its own clock.
    fn build_ns(&self) -> u64;

    /// The reason why it failed, as a clause; `None` if it has not failed.
    fn failure(&self) -> Option<String>;

    /// The median ratio of elapsed to reported time of its queries. `None` if all were too short to compare.
    fn outside(&self) -> Option<f64>;
}
