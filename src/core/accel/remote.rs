/// A structure in another process, which may end at any time. It times itself: the time of a query is
/// [`Loaded::own_ns`](super::Loaded::own_ns) of the batch.
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
