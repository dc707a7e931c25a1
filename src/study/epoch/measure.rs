//! Measuring one epoch of one scene.

use super::watch::Watch;
use super::{Circumstances, Epoch, RayCounts, RayDetails, Rays, Settings, Shape, Structure, StructureDetails};
use crate::accel::{DynAccel, Remote};
use crate::measure::tiles::level_of;
use crate::measure::{Clock, Part, Plan, Samples, spread};
use crate::report::CaseCounts;
use crate::scene::{Scene, Workload};
use crate::study::built::Built;
use crate::study::check::{check_all, declined};
use crate::study::counted::{Counted, Events, count_all};
use crate::study::placed::Placed;
use crate::study::timing::{Case, Taken, Timing};
use crate::study::{PANICKED, Stage, StudyError};

/// Builds all structures, checks and counts them if this is the first epoch, and takes their samples. A later epoch needs the
/// `first` one: what took part then is timed on the same rays, and must give the same answers. What cannot be built or panics is
/// refused, what answers wrongly gets no time; the others go on.
///
/// # Errors
/// If the guide cannot be built, or a structure answers the same rays differently.
pub fn measure(
    scene: &Scene,
    settings: &Settings,
    epoch: usize,
    first: Option<&Epoch>,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Epoch, StudyError> {
    let mut bench = Bench::set_up(scene, settings, epoch, first, clock, progress)?;
    match first {
        None => bench.check(progress)?,
        Some(first) => bench.resume(first)?,
    }
    let circumstances = bench.sample(epoch, first, clock, progress)?;
    if first.is_none() {
        bench.count();
    }
    Ok(Epoch {
        scene: scene.name.clone(),
        scene_hash: scene.hash(),
        stand_in: !scene.stand_ins.is_empty(),
        triangles: scene.mesh.len(),
        degenerate: if settings.detailed { scene.mesh.degenerate().len() } else { 0 },
        epoch,
        circumstances: settings.detailed.then_some(circumstances),
        structures: bench.structures,
    })
}

/// Everything that is timed in an epoch.
struct Bench<'a> {
    scene: &'a Scene,
    settings: &'a Settings,
    workloads: Vec<Workload>,
    /// Of each workload.
    hashes: Vec<String>,
    /// All structures asked for, and what is known of them.
    structures: Vec<Structure>,
    /// Those that could be built.
    built: Vec<Built>,
    /// The number of each of them among all.
    places: Vec<usize>,
    /// Where they lie.
    _placed: Placed,
}

impl<'a> Bench<'a> {
    /// Builds the structures and makes the rays.
    fn set_up(
        scene: &'a Scene,
        settings: &'a Settings,
        epoch: usize,
        first: Option<&Epoch>,
        clock: &dyn Clock,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Self, StudyError> {
        let Settings { structures: choices, threads, seed, .. } = settings;
        let detailed = settings.detailed && epoch == 0;
        let seed = seed.wrapping_add(epoch as u64);
        // What was refused in the first epoch would take its time to be refused again.
        let is_refused = |place: usize| first.is_some_and(|first| first.structures[place].refused.is_some());
        let asked = || choices.iter().enumerate().filter(|(place, _)| !is_refused(*place)).map(|(_, choice)| choice);
        let mut placed = Placed::new(asked(), scene, threads, clock, seed, detailed, progress);
        let mut ready = placed.built.drain(..);
        let (mut structures, mut built, mut places) = (vec![], vec![], vec![]);
        for (place, choice) in choices.iter().enumerate() {
            let (label, name) = (choice.label.clone(), choice.entry.name.clone());
            let shape = Shape::default();
            let none = Structure {
                label,
                name,
                refused: None,
                build_ns: 0,
                outside: None,
                shape,
                rays: vec![],
                details: None,
            };
            if is_refused(place) {
                structures.push(none);
                continue;
            }
            match ready.next().expect("as many as are asked for") {
                Ok(one) => {
                    places.push(structures.len());
                    let details = detailed.then(|| StructureDetails {
                        config: choice.config.clone(),
                        triangle_test: choice.triangle_test().into(),
                        build_peak_bytes: one.peak_bytes,
                        counts: CaseCounts::of(&one.accel.shape()),
                    });
                    let shape = Shape::of(one.accel.as_ref());
                    structures.push(Structure { build_ns: one.build_ns, shape, details, ..none });
                    built.push(one);
                }
                Err(StudyError::Build { cause, .. }) => {
                    structures.push(Structure { refused: Some(cause.to_string()), ..none });
                }
                Err(other) => return Err(other),
            }
        }

        drop(ready);

        // Rays that start on a surface start where the guide finds it.
        let own;
        let guide = match built.iter().find(|built| built.choice.label == settings.guide.label) {
            Some(built) => built.accel.as_ref(),
            None => {
                own = Built::new(&settings.guide, scene, &settings.threads, clock)?;
                own.accel.as_ref()
            }
        };
        let workloads = settings.asked.workloads(scene, settings.seed, guide, progress);
        let hashes = workloads.iter().map(Workload::hash).collect();
        Ok(Self { scene, settings, workloads, hashes, structures, built, places, _placed: placed })
    }

    /// Holds all structures against brute force, and says which are timed on which rays.
    fn check(&mut self, progress: &mut dyn FnMut(Stage)) -> Result<(), StudyError> {
        let checks = check_all(self.scene, &self.built, &self.workloads, progress)?;
        for ((&place, built), checks) in self.places.iter().zip(&self.built).zip(checks) {
            let failure = built.accel.remote().and_then(Remote::failure);
            let Some(checks) = checks.filter(|_| failure.is_none()) else {
                self.structures[place].refused = failure.or(Some(PANICKED.into()));
                continue;
            };
            for ((workload, hash), check) in self.workloads.iter().zip(&self.hashes).zip(checks) {
                let what = declined(built.accel.as_ref(), workload);
                let declined = what.map(|what| format!("declined: it has no {what}"));
                let details = self.settings.detailed.then(|| RayDetails {
                    checked: check.rays,
                    errors: check.errors,
                    declined: what.map(String::from),
                    ..RayDetails::default()
                });
                let wrong =
                    (check.errors > 0).then(|| format!("{} wrong answers to {} rays", check.errors, check.rays));
                self.structures[place].rays.push(Rays {
                    workload: workload.name.clone(),
                    hash: hash.clone(),
                    query: workload.query,
                    all: workload.rays.len(),
                    rays: 0,
                    checksum: 0,
                    ns: vec![],
                    parts: vec![],
                    wrong: declined.is_none() && wrong.is_some(),
                    untimed: declined.or(wrong),
                    counts: None,
                    details,
                });
            }
        }
        Ok(())
    }

    /// Takes over what was found in the first epoch, if it was of these rays.
    fn resume(&mut self, first: &Epoch) -> Result<(), StudyError> {
        let same = |rays: &[Rays]| {
            let timed = |rays: &Rays| {
                let mut parts = std::iter::once(rays.rays).chain(rays.parts.iter().map(|part| part.rays));
                rays.untimed.is_some() || parts.all(|part| level_of(rays.all, part).is_some())
            };
            rays.iter().map(|rays| &rays.hash).eq(&self.hashes) && rays.iter().all(timed)
        };
        // By place: twins have one label.
        for (structure, before) in self.structures.iter_mut().zip(&first.structures) {
            if before.refused.is_none() && !same(&before.rays) {
                let (structure, scene) = (structure.label.clone(), self.scene.name.clone());
                return Err(StudyError::Changed { structure, scene });
            }
            structure.refused = structure.refused.take().or_else(|| before.refused.clone());
            let again = |rays: &Rays| Rays { ns: vec![], counts: None, details: None, ..rays.clone() };
            structure.rays = before.rays.iter().map(again).collect();
        }
        Ok(())
    }

    /// What is timed: structures by their numbers among those built.
    fn cases(&self) -> Vec<Case> {
        let mut cases = Case::all(self.built.len(), self.workloads.len());
        cases.retain(|case| {
            let structure = &self.structures[self.places[case.structure]];
            structure.refused.is_none() && structure.rays[case.workload].untimed.is_none()
        });
        cases
    }

    /// Takes the samples of everything that is timed; of as many rays as `before`.
    fn sample(
        &mut self,
        epoch: usize,
        before: Option<&Epoch>,
        clock: &dyn Clock,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Circumstances, StudyError> {
        let cases = self.cases();
        let Settings { asked, runs, budget_ns, slowest, seed, threads, .. } = self.settings;
        let rays_of = |case: &Case| &self.structures[self.places[case.structure]].rays[case.workload];
        let runs = before.map_or(*runs, Epoch::runs);
        let (budget_ns, slowest, most_rays) = (*budget_ns, *slowest, asked.rays());
        let plan = Plan { runs, budget_ns, slowest, most_rays, seed: *seed, epoch };
        let samples = before.map(|_| {
            let none = |case: &Case| {
                let Rays { rays, checksum, ref parts, .. } = *rays_of(case);
                let parts = parts.iter().map(|part| Part { ns: vec![], ..part.clone() }).collect();
                Samples { checksum, parts, ..Samples::none(rays) }
            };
            cases.iter().map(none).collect()
        });
        let total = cases.len() * runs;
        let mut told = |taken| progress(Stage::Trace(taken, total));
        let timing = Timing { scene: self.scene, built: &self.built, workloads: &self.workloads, threads, clock };
        let _pin = threads.pin();
        let watch = Watch::start(clock, threads.cores().map_or(0, |cores| cores[0]));
        let Taken { samples, failures } = timing.take(&cases, &plan, samples, &mut told)?;
        let circumstances = watch.end(clock);

        for ((case, samples), failure) in cases.iter().zip(samples).zip(failures) {
            let structure = &mut self.structures[self.places[case.structure]];
            let remote = self.built[case.structure].accel.remote();
            let changed = || remote.filter(|_| !samples.same_answers).map(|_| CHANGED.into());
            if let Some(why) = failure.or_else(changed) {
                structure.refused = Some(why);
                continue;
            }
            structure.outside = remote.and_then(Remote::outside);
            let rays = &mut structure.rays[case.workload];
            if !samples.same_answers {
                let (structure, scene) = (structure.label.clone(), self.scene.name.clone());
                return Err(StudyError::Changed { structure, scene });
            }
            (rays.rays, rays.checksum) = (samples.rays, samples.checksum);
            (rays.ns, rays.parts) = (samples.ns, samples.parts);
        }
        Ok(circumstances)
    }

    /// Counts what is done for the rays, in a detailed epoch also where answers are wrong.
    fn count(&mut self) {
        let detailed = self.settings.detailed;
        let mut events = (detailed && self.settings.threads.count() == 1).then(Events::of_thread);
        let mut cases = Case::all(self.built.len(), self.workloads.len());
        cases.retain(|case| {
            let structure = &self.structures[self.places[case.structure]];
            let counts = |rays: &Rays| rays.untimed.is_none() || detailed && rays.wrong;
            structure.refused.is_none() && structure.rays.get(case.workload).is_some_and(counts)
        });
        for (case, counted) in cases.iter().zip(count_all(&cases, &self.built, &self.workloads)) {
            let structure = &mut self.structures[self.places[case.structure]];
            let (accel, workload) = (self.built[case.structure].accel.as_ref(), &self.workloads[case.workload]);
            match counted {
                Some(counted) => keep(&counted, accel, workload, events.as_mut(), &mut structure.rays[case.workload]),
                None => structure.refused = Some(PANICKED.into()),
            }
            let failure = accel.remote().and_then(Remote::failure);
            structure.refused = structure.refused.take().or(failure);
        }
    }
}

/// Said of a program that answers otherwise once it is started again.
const CHANGED: &str = "built again, it gives other answers than before: its times cannot be compared";

/// Keeps what was counted in a pass that is not timed, and what the processor counts.
fn keep(counted: &Counted, accel: &dyn DynAccel, workload: &Workload, events: Option<&mut Events>, into: &mut Rays) {
    if let Some(details) = &mut into.details {
        let rays = spread(&workload.rays, counted.rays);
        let events = events.filter(|_| accel.remote().is_none());
        let events = events.map(|events| events.per_ray(accel, &rays, workload.query)).unwrap_or_default();
        details.leaf_steps_per_ray = counted.leaf_steps_per_ray();
        details.empty_leaf_steps_per_ray = counted.empty_leaf_steps_per_ray();
        details.tests_over_minimum = counted.tests_over_minimum();
        details.instructions_per_ray = events.instructions;
        details.branch_misses_per_ray = events.branch_misses;
    }
    into.counts = Some(RayCounts {
        rays: counted.rays,
        hits: counted.hits,
        distances: counted.distances,
        tests: counted.observed.tests.then_some(counted.counts.tests),
        blocks: counted.observed.tests.then_some(counted.counts.blocks),
        steps: counted.observed.steps.then_some(counted.counts.steps()),
    });
}

impl Shape {
    fn of(accel: &dyn DynAccel) -> Self {
        let shape = accel.shape();
        let (leaves, references, depth, sah_cost) = (shape.leaves, shape.references, shape.depth, shape.sah_cost);
        Self { bytes: accel.footprint().total(), leaves, references, depth, sah_cost }
    }
}
