//! Samples, epoch by epoch: each builds all structures anew, so that the luck of where they lie in memory is in the
//! samples.

use super::Settings;
use super::prepare::{Prepared, Subject, prepare, twin_of};
use crate::accel::{DynAccel, Query};
use crate::measure::advice::Conditions;
use crate::measure::{Clock, Instructions, Plan, Samples, machine, spread};
use crate::report::CaseCounts;
use crate::scene::{Scene, Workload};
use crate::study::built::Built;
use crate::study::counted::{Counted, count_all};
use crate::study::placed::Placed;
use crate::study::timing::{Case, Taken, Timing};
use crate::study::{PANICKED, Refused, Stage, StudyError};

/// A structure that takes more than so many times as long as the median one is timed on fewer rays: its ratios hardly
/// gain from more of them, and the run would be about it alone.
const SLOWEST: f64 = 4.0;

/// Of one structure on one workload, over a pass that nobody times, on rays that no clock decides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tally {
    pub rays: usize,
    /// Rays that hit.
    pub hits: usize,
    pub tests_per_ray: Option<f64>,
    pub steps_per_ray: Option<f64>,
    pub instructions_per_ray: Option<f64>,
    pub counts: CaseCounts,
}

/// The comparison on one scene while it runs.
pub struct Trial<'a> {
    pub(super) scene: &'a Scene,
    pub(super) settings: &'a Settings,
    clock: &'a dyn Clock,
    pub(super) workloads: Vec<Workload>,
    /// The twin comes last.
    pub(super) subjects: Vec<Subject>,
    /// Number of the structure that has a twin.
    pub(super) twin: Option<usize>,
    pub(super) refused: Vec<Refused>,
    pub(super) cases: Vec<Case>,
    /// Of each case; none before the first epoch.
    pub(super) samples: Vec<Samples>,
    /// Of each structure on each workload; none before the first epoch.
    pub(super) tallies: Vec<Vec<Tally>>,
    pub(super) epochs: usize,
    /// Samples of every case in an epoch.
    runs: usize,
    /// What those of an epoch may take together, nanoseconds.
    epoch_ns: u64,
    pub(super) conditions: Conditions,
}

impl<'a> Trial<'a> {
    /// Builds every structure, makes the rays and checks the answers. No sample is taken.
    ///
    /// # Errors
    /// If the structure that tells where secondary rays start cannot be built.
    pub fn new(
        scene: &'a Scene,
        settings: &'a Settings,
        clock: &'a dyn Clock,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Self, StudyError> {
        let start = clock.now_ns();
        let Prepared { workloads, mut subjects, refused, builds_ns } = prepare(scene, settings, clock, progress)?;
        let twin = twin_of(&subjects).filter(|_| settings.twin);
        subjects.extend(twin.map(|of| subjects[of].twin()));
        let mut cases = Case::all(subjects.len(), workloads.len());
        cases.retain(|case| subjects[case.structure].is_timed(case.workload));

        // What checks and builds leave of the time is for passes, but at least a half.
        let spent = (clock.now_ns() - start).saturating_add(builds_ns.saturating_mul(settings.epochs as u64));
        let budget_ns = settings.budget_ns.saturating_sub(spent).max(settings.budget_ns / 2);
        Ok(Self {
            scene,
            settings,
            clock,
            workloads,
            subjects,
            twin,
            refused,
            cases,
            samples: vec![],
            tallies: vec![],
            epochs: 0,
            runs: settings.rounds(),
            epoch_ns: settings.epoch_ns.unwrap_or(budget_ns / settings.epochs as u64),
            conditions: Conditions::default(),
        })
    }

    /// The name of the scene.
    pub fn scene_name(&self) -> &'a str {
        &self.scene.name
    }

    /// Builds every structure anew and takes [`Settings::rounds`] samples of every case, or as many as there is time
    /// for.
    ///
    /// # Errors
    /// If a structure answers the same rays differently.
    pub fn epoch(&mut self, progress: &mut dyn FnMut(Stage)) -> Result<(), StudyError> {
        let pin = self.settings.threads.pin();
        let (built, _placed) = self.build(progress);
        self.forget_refused();

        let plan = Plan {
            runs: self.runs,
            budget_ns: self.epoch_ns,
            slowest: SLOWEST,
            most_rays: self.settings.rays,
            seed: self.settings.seed,
            epoch: self.epochs,
        };
        let total = self.cases.len() * self.runs * self.settings.epochs.max(self.epochs + 1);
        let done = self.cases.len() * self.runs * self.epochs;
        let timing = Timing {
            scene: self.scene,
            built: &built,
            workloads: &self.workloads,
            threads: &self.settings.threads,
            clock: self.clock,
        };
        let before = (self.epochs > 0).then(|| std::mem::take(&mut self.samples));
        let core = self.settings.threads.cores().map_or(0, |cores| cores[0]);
        let watch = Watch::start(self.clock, core);
        let Taken { runs, samples, panicked } =
            timing.take(&self.cases, &plan, before, &mut |taken| progress(Stage::Trace(done + taken, total)))?;
        watch.end(self.clock, &mut self.conditions);
        (self.runs, self.samples) = (runs, samples);
        drop(pin);

        for (case, panicked) in self.cases.iter().zip(panicked) {
            if panicked {
                refuse(&mut self.refused, self.scene, &self.subjects[case.structure], PANICKED);
            }
        }
        if self.epochs == 0 {
            self.count(&built);
        }
        self.epochs += 1;
        drop(built);
        self.forget_refused();
        Ok(())
    }

    /// Every structure that is not refused, built anew. The places are to be kept as long as the structures.
    fn build(&mut self, progress: &mut dyn FnMut(Stage)) -> (Vec<Built>, Placed) {
        let Settings { seed, threads, .. } = self.settings;
        let choices = self.subjects.iter().map(|subject| &subject.choice);
        let seed = seed.wrapping_add(self.epochs as u64);
        let mut placed = Placed::new(choices, self.scene, threads, self.clock, seed, progress);
        let mut built = vec![];
        for (subject, structure) in self.subjects.iter_mut().zip(placed.built.drain(..)) {
            match structure {
                Ok(structure) => {
                    subject.build_ns.push(structure.build_ns);
                    built.push(structure);
                }
                Err(error) => refuse(&mut self.refused, self.scene, subject, &error.to_string()),
            }
        }
        // One of two twins is refused with the other.
        let lost = |built: &Built| self.refused.iter().any(|refused| refused.label == built.choice.label);
        built.retain(|built| !lost(built));
        (built, placed)
    }

    /// Takes those that were refused after they had been admitted, and their cases and samples, out of the run.
    fn forget_refused(&mut self) {
        let lost = |subject: &Subject| self.refused.iter().any(|refused| refused.label == subject.choice.label);
        let place: Vec<Option<usize>> = self
            .subjects
            .iter()
            .scan(0, |next, subject| {
                let place = (!lost(subject)).then_some(*next);
                *next += usize::from(place.is_some());
                Some(place)
            })
            .collect();
        if place.iter().all(Option::is_some) {
            return;
        }
        let kept: Vec<bool> = self.cases.iter().map(|case| place[case.structure].is_some()).collect();
        let moved = |case: &Case| Some(Case { structure: place[case.structure]?, ..*case });
        self.cases = self.cases.iter().filter_map(moved).collect();
        keep(&mut self.samples, &kept);
        let kept: Vec<bool> = place.iter().map(Option::is_some).collect();
        keep(&mut self.subjects, &kept);
        keep(&mut self.tallies, &kept);
        self.twin = self.twin.and_then(|twin| place[twin]);
    }

    /// Counts hits, steps and tests on all threads, and instructions on this one.
    fn count(&mut self, built: &[Built]) {
        let mut counter = Instructions::open().filter(|_| self.settings.threads.count() == 1);
        let asked = |case: &Case| self.subjects[case.structure].declined[case.workload].is_none();
        let mut cases = Case::all(built.len(), self.workloads.len());
        cases.retain(asked);
        let mut counted = count_all(&cases, built, &self.workloads).into_iter();
        let mut tallies = vec![];
        for (structure, built) in built.iter().enumerate() {
            let of = |(workload, rays): (usize, &Workload)| {
                if !asked(&Case { structure, workload }) {
                    return Some(Tally::default());
                }
                let counted = counted.next().expect("one for each case that is asked")?;
                Some(tally(&counted, built.accel.as_ref(), rays, counter.as_mut()))
            };
            let all: Vec<Option<Tally>> = self.workloads.iter().enumerate().map(of).collect();
            let all: Option<Vec<Tally>> = all.into_iter().collect();
            if all.is_none() {
                refuse(&mut self.refused, self.scene, &self.subjects[structure], PANICKED);
            }
            tallies.push(all.unwrap_or_default());
        }
        self.tallies = tallies;
    }
}

/// Says once of a structure why it no longer takes part.
fn refuse(refused: &mut Vec<Refused>, scene: &Scene, subject: &Subject, reason: &str) {
    let label = &subject.choice.label;
    if refused.iter().all(|refused| refused.label != *label) {
        refused.push(Refused { label: label.clone(), scene: scene.name.clone(), reason: reason.into() });
    }
}

/// Those of `values` that are to be kept.
fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut i = 0;
    values.retain(|_| {
        i += 1;
        kept[i - 1]
    });
}

/// What was counted, and the instructions of a pass of as many rays where they can be.
fn tally(counted: &Counted, accel: &dyn DynAccel, workload: &Workload, counter: Option<&mut Instructions>) -> Tally {
    let instructions = counter.and_then(|counter| {
        let rays = spread(&workload.rays, counted.rays);
        let (mut hits, mut any) = (vec![None; rays.len()], vec![false; rays.len()]);
        counter.count(|| match workload.query {
            Query::Closest => accel.closest_hits(&rays, &mut hits),
            Query::Any => accel.any_hits(&rays, &mut any),
        })
    });
    Tally {
        rays: counted.rays,
        hits: counted.hits,
        tests_per_ray: counted.tests_per_ray(),
        steps_per_ray: counted.steps_per_ray(),
        instructions_per_ray: instructions.map(|n| n as f64 / counted.rays as f64),
        counts: CaseCounts {
            leaf_steps_per_ray: counted.leaf_steps_per_ray(),
            empty_leaf_steps_per_ray: counted.empty_leaf_steps_per_ray(),
            tests_over_minimum: counted.tests_over_minimum(),
            ..CaseCounts::of(&accel.shape())
        },
    }
}

/// What the timed part of an epoch does to the measuring thread.
struct Watch {
    start_ns: u64,
    interruptions: Option<u64>,
    core: usize,
    clock_rate: Option<f64>,
}

impl Watch {
    fn start(clock: &dyn Clock, core: usize) -> Self {
        let (interruptions, clock_rate) = (machine::interruptions(), machine::clock_rate(core));
        Self { start_ns: clock.now_ns(), interruptions, core, clock_rate }
    }

    /// Adds what happened since to `conditions`.
    fn end(self, clock: &dyn Clock, conditions: &mut Conditions) {
        conditions.seconds += (clock.now_ns() - self.start_ns) as f64 * 1e-9;
        if let (Some(before), Some(after)) = (self.interruptions, machine::interruptions()) {
            *conditions.interruptions.get_or_insert(0) += after.saturating_sub(before);
        }
        // From the first epoch to the last.
        if let (Some(before), Some(after)) = (self.clock_rate, machine::clock_rate(self.core)) {
            let first = conditions.clock_rates.map_or(before, |(first, _)| first);
            conditions.clock_rates = Some((first, after));
        }
    }
}
