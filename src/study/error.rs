use super::journal::JournalError;
use crate::accel::BuildError;
use crate::report::number::plural;

/// An error of a whole study or of one scene.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    #[error("{structure} cannot be built over {scene}: {cause}")]
    Build { structure: String, scene: String, cause: BuildError },
    #[error(
        "{scene}: {structures} structures need about {needed:.0} GB at once, but this machine has {there:.0} GB: name \
         {}a smaller scene",
        fewer(*most)
    )]
    Memory { scene: String, structures: usize, needed: f64, there: f64, most: usize },
    #[error("{0}")]
    Threads(String),
    #[error("{0}")]
    Rays(String),
    #[error("{failure} The study compares all of its trees or none.")]
    Missing { failure: String, wrong: bool },
    #[error(
        "{one} and {other}, with the same triangle test, return different hits for the {rays} rays of {scene}: one is \
         wrong"
    )]
    Disagree { one: String, other: String, scene: String, rays: String },
    #[error("nothing was measured: these scenes have no rays of these workloads; name other scenes or workloads")]
    Nothing,
    #[error("{scene} has no rays of this workload: omit the scene, or name another workload")]
    NoRays { scene: String },
    #[error(
        "{structure} on {scene}{}: epochs 0 and {epoch} differ in {what}, so their times are not comparable",
        workload(rays)
    )]
    EpochsDiffer { structure: String, scene: String, rays: String, epoch: usize, what: &'static str },
    #[error("the process that measures {key} failed: {cause}; rerun with --in-process to see more")]
    Process { key: String, cause: String },
    #[error("{key} cannot be measured: {cause}")]
    Case { key: String, cause: String },
    #[error("{sentence}")]
    Reported { sentence: String, of_one_scene: bool, wrong_answer: bool },
    #[error(transparent)]
    Journal(#[from] JournalError),
}

/// The value of `what` in [`StudyError::EpochsDiffer`] if two epochs return different hits.
pub const HITS: &str = "the hits";

fn workload(rays: &str) -> String {
    if rays.is_empty() { String::new() } else { format!(", {rays} rays") }
}

fn fewer(most: usize) -> String {
    if most == 0 { String::new() } else { format!("at most {}, or ", plural(most, "structure")) }
}

impl StudyError {
    pub fn of_build(structure: &str, scene: &str) -> impl FnOnce(BuildError) -> Self {
        move |cause| Self::Build { structure: structure.into(), scene: scene.into(), cause }
    }

    /// Whether other scenes can still be measured.
    pub fn is_of_one_scene(&self) -> bool {
        match self {
            Self::Threads(_) | Self::Nothing | Self::Journal(_) => false,
            Self::Reported { of_one_scene, .. } => *of_one_scene,
            _ => true,
        }
    }

    pub fn is_wrong_hit(&self) -> bool {
        matches!(
            self,
            Self::EpochsDiffer { what: HITS, .. }
                | Self::Disagree { .. }
                | Self::Missing { wrong: true, .. }
                | Self::Reported { wrong_answer: true, .. }
        )
    }
}
