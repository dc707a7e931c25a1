/// What a study is doing, told between timed regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stage<'a> {
    /// A structure is being built.
    Build(&'a str),
    /// Rays are being made.
    Rays(&'a str),
    /// A structure is being held against brute force.
    Check(&'a str),
    /// So many samples of so many are taken.
    Trace(usize, usize),
    /// All samples of the first epoch are taken. What is done for rays is being counted: nothing is timed any more.
    Count,
}
