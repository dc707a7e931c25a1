//! What comes before the first sample: rays, the truth, and which structures take part.

use super::{Settings, declined};
use crate::geometry::Ray;
use crate::measure::{Clock, peak_bytes};
use crate::registry::Choice;
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use crate::study::baselines::{BRUTE_FORCE, SAH_TREE};
use crate::study::built::Built;
use crate::study::check::{Check, check_all};
use crate::study::{PANICKED, Refused, Stage, StudyError};

/// A structure that takes part, and what is known of it on each workload.
pub(super) struct Subject {
    pub choice: Choice,
    /// Nanoseconds of the build of each epoch.
    pub build_ns: Vec<u64>,
    /// Most bytes held during a build beyond those held before; nothing where they are not counted.
    pub build_peak_bytes: Option<usize>,
    /// Of the finished structure.
    pub bytes: usize,
    pub checks: Vec<Check>,
    pub declined: Vec<Option<&'static str>>,
}

/// Rays, structures, and what is right.
pub(super) struct Prepared {
    pub workloads: Vec<Workload>,
    pub subjects: Vec<Subject>,
    pub refused: Vec<Refused>,
    /// What building all structures once took, nanoseconds.
    pub builds_ns: u64,
}

/// Builds every structure once, counting its memory and not its time; makes the rays; and holds the answers against brute force.
pub(super) fn prepare(
    scene: &Scene,
    settings: &Settings,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Prepared, StudyError> {
    let start = clock.now_ns();
    let (mut built, mut peaks, mut refused) = (vec![], vec![], vec![]);
    for choice in &settings.structures {
        progress(Stage::Build(&choice.label));
        let (structure, peak) = peak_bytes(|| Built::once(choice, scene, &settings.threads, clock));
        match structure {
            Ok(structure) => {
                // What is less than the structure itself was not seen: its memory is C++'s.
                peaks.push(peak.filter(|&peak| peak >= structure.accel.footprint().total()));
                built.push(structure);
            }
            Err(StudyError::Build { structure, cause, .. }) => {
                refused.push(Refused { label: structure, scene: scene.name.clone(), reason: cause.to_string() });
            }
            Err(other) => return Err(other),
        }
    }
    let builds_ns = clock.now_ns() - start;

    let workloads = workloads(scene, settings, &built, clock, progress)?;
    let batches: Vec<&[Ray]> = workloads.iter().map(|workload| &workload.rays[..]).collect();
    let checks = check_all(scene, &built, &batches, progress)?;

    let mut subjects = vec![];
    for ((built, build_peak_bytes), checks) in built.into_iter().zip(peaks).zip(checks) {
        match checks {
            Some(checks) => subjects.push(Subject {
                build_ns: vec![],
                build_peak_bytes,
                bytes: built.accel.footprint().total(),
                checks,
                declined: workloads.iter().map(|workload| declined(built.accel.as_ref(), workload)).collect(),
                choice: built.choice,
            }),
            None => {
                refused.push(Refused { label: built.choice.label, scene: scene.name.clone(), reason: PANICKED.into() })
            }
        }
    }
    Ok(Prepared { workloads, subjects, refused, builds_ns })
}

/// The same rays for all structures; those that start on a surface start where the guide finds it. A workload may come out empty and
/// is left out: nothing casts shadows where nothing is hit.
fn workloads(
    scene: &Scene,
    settings: &Settings,
    built: &[Built],
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Vec<Workload>, StudyError> {
    let own_guide;
    let guide = match built.iter().find(|built| built.choice.label == settings.guide.label) {
        Some(built) => built.accel.as_ref(),
        None => {
            own_guide = Built::once(&settings.guide, scene, &settings.threads, clock)?;
            own_guide.accel.as_ref()
        }
    };
    let mut workloads: Vec<Workload> = settings.replayed.iter().cloned().collect();
    let sampling = Sampling { seed: settings.seed, ..Sampling::of(scene) };
    let made =
        |kind: &&WorkloadKind| settings.replayed.is_none() && (**kind != WorkloadKind::Mirror || scene.has_mirrors());
    for &kind in settings.workloads.iter().filter(made) {
        progress(Stage::Rays(kind.name()));
        workloads.push(Workload::new(scene, kind, &sampling, guide));
    }
    workloads.retain(|workload| !workload.rays.is_empty());
    Ok(workloads)
}

/// The structure that gets a twin: the SAH tree, or another one with a case to time, brute force last.
pub(super) fn twin_of(subjects: &[Subject]) -> Option<usize> {
    let rank = |name: &str| match name {
        SAH_TREE => 0,
        BRUTE_FORCE => 2,
        _ => 1,
    };
    let timed = (0..subjects.len()).filter(|&s| (0..subjects[s].checks.len()).any(|w| subjects[s].is_timed(w)));
    timed.min_by_key(|&s| rank(&subjects[s].choice.entry.name))
}

impl Subject {
    /// Whether workload `w` is timed: its answers are right, and nothing of it is declined.
    pub fn is_timed(&self, w: usize) -> bool {
        self.checks[w].errors == 0 && self.declined[w].is_none()
    }

    /// The same, not yet built.
    pub fn twin(&self) -> Self {
        Self {
            choice: self.choice.clone(),
            build_ns: vec![],
            build_peak_bytes: self.build_peak_bytes,
            bytes: self.bytes,
            checks: self.checks.clone(),
            declined: self.declined.clone(),
        }
    }
}
