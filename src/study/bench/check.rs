//! Are the answers right? Before any time is taken.

use std::collections::BTreeMap;

use super::built::Built;
use crate::accel::{DynAccel, Query};
use crate::geometry::{Hit, Ray};
use crate::measure::spread;
use crate::scene::{Scene, Workload};
use crate::study::BRUTE_FORCE;
use crate::study::{Stage, StudyError};
use crate::validate::{Reference, Validation, validate_answers, validate_any_answers, validate_known};

/// What of a workload a structure declines, if anything is: then it has no time.
pub fn declined(accel: &dyn DynAccel, workload: &Workload) -> Option<&'static str> {
    let can = accel.capabilities();
    if workload.query == Query::Any && !can.any_hit {
        return Some("any hit");
    }
    workload.rays.iter().find_map(|ray| can.declines(ray))
}

/// Of one structure on one batch of rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Check {
    /// Rays held against brute force.
    pub rays: usize,
    /// Those with a wrong answer.
    pub errors: usize,
}

/// Rays of a batch that are checked, at most, and those that are whatever they take.
const MOST: usize = 1 << 13;
const FEWEST: usize = 1 << 6;

/// Triangle tests that brute force may make for a batch: two tenths of a second, about.
pub const TESTS: usize = 1 << 27;

/// Rays of a batch that are checked, a number that neither a clock nor the field decides: another run checks the same.
fn affordable(rays: usize, triangles: usize, tests: usize) -> usize {
    if rays <= FEWEST {
        return rays;
    }
    let affordable = (tests / triangles.max(1)).clamp(FEWEST, MOST);
    rays.min(1 << affordable.ilog2())
}

/// Brute force with a triangle test, and its answers to the rays of each batch that are checked.
struct Known {
    reference: Reference,
    answers: Vec<Vec<Option<Hit>>>,
}

/// Holds every structure against brute force with its own triangle test, on rays of each batch that are evenly spread, for which brute
/// force makes about `tests` triangle tests.
/// One row for each structure, one check for each workload; nothing for a structure that panicked.
pub fn check_all<'a>(
    scene: &Scene,
    built: impl IntoIterator<Item = &'a Built>,
    workloads: &[Workload],
    tests: usize,
    progress: &mut dyn FnMut(Stage),
) -> Result<Vec<Option<Vec<Check>>>, StudyError> {
    let spread = |of: &Workload| spread(&of.rays, affordable(of.rays.len(), scene.mesh.len(), tests));
    let batches: Vec<Vec<Ray>> = workloads.iter().map(spread).collect();
    let mut all: BTreeMap<&'static str, Known> = BTreeMap::new();
    let mut checks = vec![];
    for built in built {
        progress(Stage::Check(&built.choice.label));
        let test = built.choice.triangle_test();
        if !all.contains_key(test) {
            let reference = Reference::of_test(test, &scene.mesh);
            let reference = reference.map_err(StudyError::of_build(BRUTE_FORCE, &scene.name))?;
            let answers = batches.iter().map(|rays| reference.closest_hits(rays)).collect();
            all.insert(test, Known { reference, answers });
        }
        let Known { reference, answers } = &all[test];
        // Brute force is held against itself: that it repeats itself is seen on a few rays.
        let most = if built.choice.entry.name == BRUTE_FORCE { FEWEST } else { MOST };
        let of_batch = |((rays, answers), workload): ((&Vec<Ray>, &Vec<Option<Hit>>), &Workload)| -> Option<Check> {
            let step = rays.len().div_ceil(most).max(1);
            let rays: Vec<Ray> = rays.iter().copied().step_by(step).collect();
            let answers: Vec<Option<Hit>> = answers.iter().copied().step_by(step).collect();
            let accel = built.accel.as_ref();
            let found = match accel.remote() {
                Some(_) => validate_remote(accel, reference, &answers, scene, &rays, workload.query),
                None => validate_known(accel, reference, &answers, &scene.mesh, &rays),
            };
            let errors = found.errors().min(found.rays) as usize;
            (found.panics == 0).then_some(Check { rays: found.rays as usize, errors })
        };
        checks.push(batches.iter().zip(answers).zip(workloads).map(of_batch).collect());
    }
    Ok(checks)
}

/// As [`validate_known`], of a structure of which each question takes time: only what is timed is asked, once.
fn validate_remote(
    accel: &dyn DynAccel,
    reference: &Reference,
    expected: &[Option<Hit>],
    scene: &Scene,
    rays: &[Ray],
    query: Query,
) -> Validation {
    match query {
        Query::Closest => validate_answers(reference, expected, &scene.mesh, rays, &accel.closest(rays)),
        Query::Any if !accel.capabilities().any_hit => Validation::default(),
        Query::Any => validate_any_answers(reference, expected, &scene.mesh, rays, &accel.any(rays)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_rays_of_a_small_batch_are_checked_and_a_power_of_two_of_a_large_one() {
        assert_eq!(affordable(50, 1 << 30, TESTS), 50);
        assert_eq!(affordable(100, 12, TESTS), 100);
        assert_eq!(affordable(1 << 18, 12, TESTS), 1 << 13);
        assert_eq!(affordable(1 << 18, 130_862, TESTS), 1 << 10);
        assert_eq!(affordable(1 << 18, 30_000_000, TESTS), 1 << 6);
        assert_eq!(affordable(1 << 18, 0, TESTS), 1 << 13);
        assert_eq!(affordable(1 << 18, 130_862, TESTS / 8), 1 << 7);
    }
}
