use crate::geometry::Hit;

/// A batch of rays that a structure has loaded ([`Accel::load`](super::Accel::load)).
///
/// Its results equal the results of the structure's queries for the same rays, bit for bit.
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

    /// Nanoseconds of the last query, measured by a [`Remote`] structure; `None` for all other structures.
    fn own_ns(&self) -> Option<u64> {
        None
    }
}

/// A structure in another process, which may exit at any time. That process measures the times of builds
/// ([`Remote::build_ns`]) and queries ([`Loaded::own_ns`]).
///
/// After a failure, every query returns only misses, which have no meaning.
pub trait Remote {
    /// Nanoseconds of the build, measured by the other process.
    fn build_ns(&self) -> u64;

    /// The reason for the failure, as a clause; `None` if there was none.
    fn failure(&self) -> Option<String>;

    /// The median, over the queries, of elapsed time divided by reported time. `None` if all queries were too short.
    fn outside(&self) -> Option<f64>;
}
