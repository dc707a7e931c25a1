//! Are the answers right? Before any time is taken.

use std::collections::BTreeMap;

use super::built::Built;
use super::{Stage, StudyError};
use crate::geometry::Ray;
use crate::measure::{Clock, spread};
use crate::scene::Scene;
use crate::validate::{Reference, validate};

/// Of one structure on one batch of rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Check {
    /// Rays held against brute force.
    pub rays: usize,
    /// Those with a wrong answer.
    pub errors: usize,
}

/// Rays from which the cost of brute force is learnt, and the fewest that are checked.
const PILOT: usize = 32;

/// Holds every structure against brute force with its own triangle test, on as many rays of each batch as `budget_ns`
/// allows for all together. One row for each structure, one check for each batch; nothing for a structure that panicked.
pub fn check_all(
    scene: &Scene,
    built: &[Built],
    batches: &[&[Ray]],
    clock: &dyn Clock,
    budget_ns: u64,
    progress: &mut dyn FnMut(Stage),
) -> Result<Vec<Option<Vec<Check>>>, StudyError> {
    let budget_ns = budget_ns / (built.len() * batches.len()).max(1) as u64;
    let mut references: BTreeMap<&'static str, Reference> = BTreeMap::new();
    let mut checks = vec![];
    for built in built {
        progress(Stage::Check(&built.choice.label));
        let test = built.choice.triangle_test();
        if !references.contains_key(test) {
            let reference = Reference::of_test(test, &scene.mesh).map_err(|cause| StudyError::Build {
                structure: "brute-force".into(),
                scene: scene.name.clone(),
                cause,
            })?;
            references.insert(test, reference);
        }
        let check = |rays: &[Ray]| validate(built.accel.as_ref(), &references[test], &scene.mesh, rays);
        let of_batch = |batch: &&[Ray]| -> Option<Check> {
            // Learn from a few rays how many can be afforded.
            let start = clock.now_ns();
            let pilot = spread(batch, PILOT);
            let mut found = check(&pilot);
            let ns = (clock.now_ns() - start).max(1);
            let affordable = (pilot.len() as u64).saturating_mul(budget_ns) / ns;
            if affordable > pilot.len() as u64 && batch.len() > pilot.len() {
                // All, or a power of two: another run, a little faster or slower, checks the same rays.
                let all = affordable >= batch.len() as u64;
                found = check(&spread(batch, if all { batch.len() } else { 1 << affordable.ilog2() }));
            }
            let errors = found.errors().min(found.rays) as usize;
            (found.panics == 0).then_some(Check { rays: found.rays as usize, errors })
        };
        checks.push(batches.iter().map(of_batch).collect());
    }
    Ok(checks)
}
