use crate::geometry::Hit;

/// A batch of rays that a structure has loaded ([`Accel::load`](super::Accel::load)).
///
/// The results are bit-identical to the results of `Accel::closest_hits` and `Accel::any_hits`.
pub trait Loaded: Send + Sync {
    /// The nearest hits of the rays.
    ///
    /// # Panics
    /// If `hits` and the batch differ in length.
    fn closest_hits(&self, hits: &mut [Option<Hit>]);

    /// Whether each ray hits anything.
    ///
    /// # Panics
    /// If `hits` and the batch differ in length.
    fn any_hits(&self, hits: &mut [bool]);

    /// Nanoseconds of the previous query, measured by a structure in another process. `None` for a structure in this
    /// process.
    fn own_ns(&self) -> Option<u64> {
        None
    }
}

/// A structure in another process. The other process may exit at any time.
///
/// After a failure, every query returns a miss for every ray. These misses are not valid results.
pub trait Remote {
    /// Nanoseconds of the build, measured by the other process.
    fn build_ns(&self) -> u64;

    /// The reason for the failure, as a clause. `None` if no failure has occurred.
    fn failure(&self) -> Option<String>;

    /// The median ratio of elapsed time to reported time. Very short queries are excluded. `None` if no query remains.
    fn outside(&self) -> Option<f64>;
}
