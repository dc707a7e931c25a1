/// A structure in a process of its own, which may end at any time and times itself: what
/// [`Loaded::own_ns`](super::Loaded::own_ns) of its batches says is taken for the time of an answer.
///
/// Once it has failed, its queries return no hit.
pub trait Remote {
    /// Nanoseconds of the build, by its own clock.
    fn build_ns(&self) -> u64;

    /// Why it has failed, as a clause, once it has: its hits mean nothing then.
    fn failure(&self) -> Option<String>;

    /// The median ratio of the time of its queries as seen from outside to the time that it reported. Nothing where all
    /// were too short to compare.
    fn outside(&self) -> Option<f64>;
}
