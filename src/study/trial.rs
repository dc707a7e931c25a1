//! One epoch of several structures on the same rays: built, checked, counted and timed, for studies that keep a journal.

use serde::{Deserialize, Serialize};

use super::built::Built;
use super::check::check_all;
use super::{Stage, StudyError};
use crate::accel::{Counts, Query};
use crate::geometry::{Hit, PrimId, Ray};
use crate::measure::{Clock, Pass, Plan, Samples, ThreadClock, Threads, Timed, spread, take, take_again};
use crate::registry::Choice;
use crate::scene::{Scene, Workload};

/// Rays of a workload that are counted, at most; spread evenly.
const COUNTED: usize = 16384;

/// How an epoch is measured.
pub(super) struct Trial<'a> {
    pub scene: &'a Scene,
    /// Built by [`Trial::build`].
    pub built: &'a [Built],
    /// What every structure is asked, none of them empty.
    pub workloads: &'a [Workload],
    /// Samples of every structure on every workload.
    pub runs: usize,
    /// What all samples may take together, nanoseconds.
    pub budget_ns: u64,
    /// What the check of the answers may take, nanoseconds.
    pub check_ns: u64,
    pub seed: u64,
    pub threads: &'a Threads,
    pub clock: &'a dyn Clock,
}

/// What an epoch found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Epoch {
    /// Counted from 0.
    pub number: usize,
    /// In the order of the structures.
    pub trees: Vec<Tree>,
    /// Of the first epoch; builds and answers do not change.
    pub counts: Option<Vec<Counted>>,
}

/// One structure in one epoch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tree {
    pub build_ns: u64,
    /// One for each workload.
    pub times: Vec<Times>,
}

/// One structure on one workload.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Times {
    /// Rays of a sample, fewer than the workload has where the structure is slow.
    pub rays: usize,
    /// Of the answers to these rays.
    pub checksum: u64,
    /// Nanoseconds of each sample; those of two structures with the same index are a pair.
    pub ns: Vec<u64>,
}

impl Times {
    /// Nanoseconds a ray in every sample.
    pub fn paces(&self) -> Vec<f64> {
        self.ns.iter().map(|&ns| ns.max(1) as f64 / self.rays as f64).collect()
    }
}

/// What no machine changes: the tree, and what it does for the rays that are counted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Counted {
    /// Rays that were counted, for each workload: all, or an even sample of many.
    pub rays: Vec<usize>,
    /// Triangles tested, for each workload.
    pub tests: Vec<u64>,
    /// Nodes and leaves entered, for each workload.
    pub steps: Vec<u64>,
    /// References in leaves.
    pub references: usize,
    pub leaves: usize,
    /// Edges from the root to the deepest leaf.
    pub depth: usize,
    pub bytes: usize,
    /// As [`TreeShape::sah_cost`](crate::accel::TreeShape::sah_cost).
    pub sah_cost: Option<f64>,
    /// Rays held against brute force, all of them right.
    pub checked_rays: usize,
}

/// Builds structures for an epoch.
///
/// # Errors
/// If one cannot be built.
pub(super) fn build(
    scene: &Scene,
    choices: &[Choice],
    threads: &Threads,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Vec<Built>, StudyError> {
    let mut built = vec![];
    for choice in choices {
        progress(Stage::Build(&choice.label));
        built.push(Built::new(choice, scene, threads, clock)?);
    }
    Ok(built)
}

impl Trial<'_> {
    /// Measures epoch `number`: the first one is checked and counted. A later one needs the `first`: its structures are timed on
    /// the same rays, and must give the same answers.
    ///
    /// # Errors
    /// If a structure gives wrong answers, or others than in the first epoch.
    pub fn epoch(
        &self,
        number: usize,
        first: Option<&Epoch>,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Epoch, StudyError> {
        let counts = match first {
            None => Some(self.count_all(progress)?),
            Some(_) => None,
        };
        let samples = self.time(number, first, progress)?;
        let trees = self.built.iter().zip(samples.chunks(self.workloads.len())).map(|(built, samples)| Tree {
            build_ns: built.build_ns,
            times: samples.iter().map(|s| Times { rays: s.rays, checksum: s.checksum, ns: s.ns.clone() }).collect(),
        });
        let epoch = Epoch { number, trees: trees.collect(), counts };
        for (i, tree) in first.into_iter().flat_map(|first| first.trees.iter().enumerate()) {
            let sums = |tree: &Tree| tree.times.iter().map(|times| times.checksum).collect::<Vec<_>>();
            if sums(tree) != sums(&epoch.trees[i]) {
                return Err(StudyError::Changed { structure: self.label(i), scene: self.scene.name.clone() });
            }
        }
        Ok(epoch)
    }

    fn label(&self, structure: usize) -> String {
        self.built[structure].choice.label.clone()
    }

    /// Samples of every structure on every workload.
    fn time(
        &self,
        number: usize,
        first: Option<&Epoch>,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Vec<Samples>, StudyError> {
        let mut cases: Vec<Box<dyn Timed + '_>> = vec![];
        for built in self.built {
            for workload in self.workloads {
                cases.push(Box::new(Pass::new(built.accel.as_ref(), &workload.rays, workload.query, self.threads)));
            }
        }
        // The search for the number of rays and the warm-up cost about three passes more than the samples.
        let slots = (cases.len() * (self.runs + 3)) as u64;
        let plan = Plan {
            runs: self.runs,
            sample_budget_ns: (self.budget_ns / slots).max(1),
            warmup: 1,
            seed: self.seed.wrapping_add(number as u64),
        };
        let total = cases.len() * self.runs;
        // What others take of the core is no time of a pass.
        let own = ThreadClock::of(self.threads);
        let clock = own.as_ref().map_or(self.clock, |clock| clock as &dyn Clock);
        let _pin = self.threads.pin();
        let mut told = |taken| progress(Stage::Trace(taken, total));
        let samples = match first {
            None => take(clock, &mut cases, &plan, &mut told),
            Some(first) => {
                let begun = |times: &Times| Samples {
                    rays: times.rays,
                    checksum: times.checksum,
                    same_answers: true,
                    unsteady: 0,
                    ns: vec![],
                };
                let mut samples: Vec<Samples> =
                    first.trees.iter().flat_map(|tree| tree.times.iter().map(begun)).collect();
                take_again(clock, &mut cases, &plan, &mut samples, &mut told).map(|()| samples)
            }
        };
        samples.map_err(|cause| StudyError::Unsteady {
            structure: self.label(cause.case / self.workloads.len()),
            scene: self.scene.name.clone(),
            rays: self.workloads[cause.case % self.workloads.len()].name.clone(),
            cause,
        })
    }

    /// Holds all structures against brute force on some rays, and those of one triangle test against each other on all; counts
    /// what they do.
    fn count_all(&self, progress: &mut dyn FnMut(Stage)) -> Result<Vec<Counted>, StudyError> {
        let batches: Vec<&[Ray]> = self.workloads.iter().map(|workload| &workload.rays[..]).collect();
        let checks = check_all(self.scene, self.built, &batches, self.clock, self.check_ns, progress)?;
        let mut answers: Vec<(&str, Vec<Vec<Option<Hit>>>)> = vec![];
        let mut counted = vec![];
        for (i, checks) in checks.into_iter().enumerate() {
            let built = &self.built[i];
            progress(Stage::Check(&built.choice.label));
            let (scene, structure) = (self.scene.name.clone(), self.label(i));
            let Some(checks) = checks else { return Err(StudyError::Panicked { structure, scene }) };
            if let Some(check) = checks.iter().find(|check| check.errors > 0) {
                return Err(StudyError::Wrong { structure, scene, errors: check.errors, checked: check.rays });
            }
            let of = |workload: &Workload| count(built, &spread(&workload.rays, COUNTED), workload.query);
            let counts: Vec<(Vec<Option<Hit>>, Counts)> = self.workloads.iter().map(of).collect();
            let (hits, counts): (Vec<_>, Vec<_>) = counts.into_iter().unzip();

            // What one triangle test decides is alike to the bit, so that the rays that are counted check all structures.
            let test = built.choice.triangle_test();
            match answers.iter().find(|(other, _)| *other == test) {
                None => answers.push((test, hits)),
                Some((_, expected)) => {
                    let pairs = expected.iter().flatten().zip(hits.iter().flatten());
                    let errors =
                        pairs.filter(|(a, b)| a.map(|hit| hit.t.to_bits()) != b.map(|hit| hit.t.to_bits())).count();
                    let checked = hits.iter().map(Vec::len).sum();
                    if errors > 0 {
                        return Err(StudyError::Wrong { structure, scene, errors, checked });
                    }
                }
            }
            let shape = built.accel.shape();
            counted.push(Counted {
                rays: answers[0].1.iter().map(Vec::len).collect(),
                tests: counts.iter().map(|counts| counts.tests).collect(),
                steps: counts.iter().map(Counts::steps).collect(),
                references: shape.references,
                leaves: shape.leaves,
                depth: shape.depth,
                bytes: built.accel.footprint().total(),
                sah_cost: shape.sah_cost,
                checked_rays: checks.iter().map(|check| check.rays).sum(),
            });
        }
        Ok(counted)
    }
}

/// The answers, and what is done for them; of an any-hit query only that there is one.
fn count(built: &Built, rays: &[Ray], query: Query) -> (Vec<Option<Hit>>, Counts) {
    let mut counts = Counts::default();
    let hits = match query {
        Query::Closest => {
            let mut hits = vec![None; rays.len()];
            built.accel.closest_hits_counted(rays, &mut hits, &mut counts);
            hits
        }
        Query::Any => {
            let mut hits = vec![false; rays.len()];
            built.accel.any_hits_counted(rays, &mut hits, &mut counts);
            let some = Hit { t: 0.0, prim: PrimId::new(0) };
            hits.into_iter().map(|hit| hit.then_some(some)).collect()
        }
    };
    (hits, counts)
}
