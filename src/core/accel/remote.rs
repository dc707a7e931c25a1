/// A structure in a process of its own, which may end at any time and times itself: what
/// [`Loaded::own_ns`](super::Loaded::own_ns) of its batches says is taken for the time of an answer.
///
/// Once it has failed, it answers that nothing is hit.
pub trait Remote {
    /// Nanoseconds of the build, by its own clock.
    fn build_ns(&self) -> u64;

    /// Why its answers mean nothing, once it has failed: a clause.
    fn failure(&self) -> Option<String>;

    /// How long its answers took as seen from outside, as a multiple of what it said itself; the median. Nothing where all
    /// were too short to tell.
    fn outside(&self) -> Option<f64>;
}
