/// A structure in another process, which may end at any time. It times itself: the time of a query is
/// [`Loaded::own_ns`](super::Loaded::own_ns) of the batch.
///
/// After a failure its queries return no hits.
pub trait Remote {
    /// Nanoseconds of the build, by its own clock.
    fn build_ns(&self) -> u64;

    /// The reason of its failure, as a clause; `None` before a failure. After a failure its hits have no meaning.
    fn failure(&self) -> Option<String>;

    /// The median ratio of the elapsed time of its queries to the time that it reported. `None` if all times were too
    /// short to compare.
    fn outside(&self) -> Option<f64>;
}
