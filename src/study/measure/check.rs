//! Checks hits against brute force before the timing.

use std::collections::BTreeMap;

use super::built::Built;
use crate::accel::{DynAccel, Query};
use crate::geometry::{Hit, Ray};
use crate::measure::{Clock, spread};
use crate::request::BRUTE_FORCE;
use crate::scene::{Scene, Workload};
use crate::study::epoch::Checked;
use crate::study::{Stage, StudyError};
use crate::validate::{ExpectedHits, Reference, Validation, validate_any_hits, validate_hits, validate_known};

/// Returns a feature that the workload needs and the structure lacks.
pub fn declined(accel: &dyn DynAccel, workload: &Workload) -> Option<&'static str> {
    let can = accel.capabilities();
    if workload.query == Query::Any && !can.any_hit {
        return Some("any hit");
    }
    workload.rays.iter().find_map(|ray| can.declines(ray))
}

/// Bounds on the number of checked rays per workload. A time limit may reduce the number below `FEWEST`.
const MOST: usize = 1 << 13;
const FEWEST: usize = 1 << 6;

/// The number of rays to check. Without a time limit, every run must check the same number of rays.
fn affordable(rays: usize, triangles: usize, tests: usize) -> usize {
    if rays <= FEWEST {
        return rays;
    }
    let affordable = (tests / triangles.max(1)).clamp(FEWEST, MOST);
    rays.min(1 << affordable.ilog2())
}

struct Known {
    reference: Reference,
    answers: Vec<Vec<Option<Hit>>>,
}

pub struct Checks<'a> {
    pub scene: &'a Scene,
    pub workloads: &'a [Workload],
    /// The approximate maximum number of brute-force triangle tests per workload.
    pub tests: usize,
    /// Time limit for all checks together.
    pub limit_ns: Option<u64>,
    pub clock: &'a dyn Clock,
}

/// Brute force traces this number of rays to estimate its time per ray.
const PILOT: usize = 8;

impl Checks<'_> {
    /// Compares every structure with brute force that uses the same triangle test. Returns one row per structure. A row
    /// contains one check per workload. A row is `None` if the structure panicked.
    pub fn all<'b>(
        &self,
        built: impl IntoIterator<Item = &'b Built>,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Vec<Option<Vec<Checked>>>, StudyError> {
        let built: Vec<&Built> = built.into_iter().collect();
        let mut batches: Option<Vec<Vec<Ray>>> = None;
        let mut all: BTreeMap<&'static str, Known> = BTreeMap::new();
        let mut checks = vec![];
        for own in &built {
            progress(Stage::Check((&own.choice.label).into()));
            let test = own.choice.triangle_test();
            if !all.contains_key(test) {
                let reference = Reference::of_test(test, &self.scene.mesh);
                let reference = reference.map_err(StudyError::of_build(BRUTE_FORCE, &self.scene.name))?;
                let batches = batches.get_or_insert_with(|| self.batches(&reference, built.len()));
                let answers = batches.iter().map(|rays| reference.closest_hits(rays)).collect();
                all.insert(test, Known { reference, answers });
            }
            checks.push(self.of(own, &all[test], batches.as_deref().unwrap_or(&[])));
        }
        Ok(checks)
    }

    fn batches(&self, reference: &Reference, structures: usize) -> Vec<Vec<Ray>> {
        let rays = |workload: &Workload| {
            let mut count = affordable(workload.rays.len(), self.scene.mesh.len(), self.tests);
            if let Some(limit) = self.limit_ns {
                let start = self.clock.now_ns();
                reference.closest_hits(&spread(&workload.rays, PILOT));
                let each = (self.clock.now_ns() - start) / PILOT as u64;
                let share = limit / (self.workloads.len() * (structures + 1)).max(1) as u64;
                count = count.min((share / each.max(1)).max(PILOT as u64) as usize);
            }
            spread(&workload.rays, count)
        };
        self.workloads.iter().map(rays).collect()
    }

    fn of(&self, built: &Built, known: &Known, batches: &[Vec<Ray>]) -> Option<Vec<Checked>> {
        let Known { reference, answers } = known;
        // A few rays suffice to compare brute force with itself.
        let most = if built.choice.entry.name == BRUTE_FORCE { FEWEST } else { MOST };
        let of_batch = |((rays, answers), workload): ((&Vec<Ray>, &Vec<Option<Hit>>), &Workload)| {
            let step = rays.len().div_ceil(most).max(1);
            let rays: Vec<Ray> = rays.iter().copied().step_by(step).collect();
            let answers: Vec<Option<Hit>> = answers.iter().copied().step_by(step).collect();
            let expected = ExpectedHits { reference, mesh: &self.scene.mesh, rays: &rays, hits: &answers };
            let accel = built.accel.as_ref();
            let found = match accel.remote() {
                Some(_) => validate_remote(accel, &expected, workload.query),
                None => validate_known(accel, &expected),
            };
            (found.panics == 0).then(|| Checked::from(&found))
        };
        batches.iter().zip(answers).zip(self.workloads).map(of_batch).collect()
    }
}

/// Queries of a remote structure are slow, so only `query` is checked.
fn validate_remote(accel: &dyn DynAccel, expected: &ExpectedHits, query: Query) -> Validation {
    match query {
        Query::Closest => validate_hits(expected, &accel.closest(expected.rays)),
        Query::Any if !accel.capabilities().any_hit => Validation::default(),
        Query::Any => validate_any_hits(expected, &accel.any(expected.rays), Some(accel)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::case::TESTS;

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
