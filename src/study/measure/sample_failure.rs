/// Why the samples of a case mean nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SampleFailure {
    /// The structure panicked, or the program that it runs in failed: a clause.
    #[error("{0}")]
    Ended(String),
    #[error("it returns other hits when it traces the same rays again: the structure is not deterministic")]
    Unsteady,
}
