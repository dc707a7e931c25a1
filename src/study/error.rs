use super::guarded::PANICKED;
use super::journal::JournalError;
use crate::accel::BuildError;
use crate::measure::UnsteadyAnswers;
use crate::registry::ChoiceError;

/// Why a study cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    #[error("{structure} cannot be built over {scene}: {cause}")]
    Build { structure: String, scene: String, cause: BuildError },
    #[error("{structure} on the {rays} rays of {scene}: {cause}")]
    Unsteady { structure: String, scene: String, rays: String, cause: UnsteadyAnswers },
    #[error("{structure} on {scene}: {PANICKED}")]
    Panicked { structure: String, scene: String },
    #[error("the system gives no thread to trace on: {0}")]
    Threads(String),
    #[error("the study needs a structure that is not registered as it expects: {0}")]
    Structure(#[from] ChoiceError),
    #[error("{structure} gives {errors} wrong answers to {checked} rays of {scene}: its times would mean nothing")]
    Wrong { structure: String, scene: String, errors: usize, checked: usize },
    #[error("{scene} has no {rays} rays: leave the scene out, or ask for another kind of rays")]
    NoRays { scene: String, rays: String },
    #[error("{structure} on {scene}, built again, gives other answers than before: its times cannot be compared")]
    Changed { structure: String, scene: String },
    #[error(transparent)]
    Journal(#[from] JournalError),
}
