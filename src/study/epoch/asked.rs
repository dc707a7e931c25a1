//! What is asked of structures.

use crate::accel::DynAccel;
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use crate::study::Stage;

/// Pixels of the report's pictures, to each side.
pub const PICTURE: [u32; 2] = [512, 512];

fn picture(scene: &Scene) -> Sampling {
    Sampling { size: PICTURE, ..Sampling::of(scene) }
}

/// The rays of a study.
#[derive(Clone, Debug)]
pub enum Asked {
    /// These kinds of rays about the scene, of each so many timed at most.
    Kinds(Vec<WorkloadKind>, usize),
    /// Rays made before; of them so many are timed at most.
    Replayed(Workload, usize),
    /// All rays of the picture that the source report draws.
    Picture,
    /// The primary rays of that picture alone.
    PrimaryPicture,
}

impl Asked {
    /// The same rays for all structures; those that start on a surface start where `guide` finds it. What a scene has no rays of is
    /// left out.
    pub fn workloads(
        &self,
        scene: &Scene,
        seed: u64,
        guide: &dyn DynAccel,
        progress: &mut dyn FnMut(Stage),
    ) -> Vec<Workload> {
        let (kinds, sampling): (&[WorkloadKind], Sampling) = match self {
            Self::Replayed(workload, _) => return vec![workload.clone()],
            Self::Kinds(kinds, _) => (kinds, Sampling { seed, ..Sampling::of(scene) }),
            Self::Picture => (&[WorkloadKind::Image, WorkloadKind::ImageShadow], picture(scene)),
            Self::PrimaryPicture => (&[WorkloadKind::Primary], picture(scene)),
        };
        let mut workloads = vec![];
        for &kind in kinds.iter().filter(|&&kind| kind != WorkloadKind::Mirror || scene.has_mirrors()) {
            progress(Stage::Rays(kind.name()));
            workloads.push(Workload::new(scene, kind, &sampling, guide));
        }
        workloads.retain(|workload| !workload.rays.is_empty());
        workloads
    }

    /// Rays of a workload that are timed, at most.
    pub(super) fn rays(&self) -> usize {
        match self {
            Self::Kinds(_, rays) | Self::Replayed(_, rays) => *rays,
            Self::Picture | Self::PrimaryPicture => usize::MAX,
        }
    }

    /// As journals keep it: names of the kinds, and how many rays of each at most.
    pub(super) fn kept(&self) -> (String, Option<usize>) {
        match self {
            Self::Kinds(kinds, rays) => {
                let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
                (names.join(" "), Some(*rays))
            }
            Self::Replayed(workload, rays) => (format!("replayed {}", workload.hash()), Some(*rays)),
            Self::Picture => ("picture".into(), None),
            Self::PrimaryPicture => ("primary-picture".into(), None),
        }
    }
}
