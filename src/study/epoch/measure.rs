//! Measuring one epoch of one scene.

use super::watch::Watch;
use super::{Circumstances, Epoch, RayCounts, RayDetails, Rays, Settings, Shape, Structure, StructureDetails};
use crate::accel::{DynAccel, Remote};
use crate::measure::{Clock, Plan, spread};
use crate::report::CaseCounts;
use crate::scene::{Scene, Workload};
use crate::study::bench::built::Built;
use crate::study::bench::case::Case;
use crate::study::bench::check::{check_all, declined};
use crate::study::bench::counted::{Counted, Events, count_all};
use crate::study::bench::failed::Failed;
use crate::study::bench::placed::Placed;
use crate::study::bench::room::fits;
use crate::study::bench::timing::Timing;
use crate::study::{PANICKED, Stage, StudyError};

/// Builds all structures, checks and counts them if this is the first epoch, and takes their samples. No epoch needs
/// another: what they owe each other is found when they are [joined](super::join). What cannot be built, panics or
/// answers the same rays differently is refused, what answers wrongly gets no time; the others go on.
///
/// # Errors
/// If the structures do not fit into memory, or the guide cannot be built.
pub fn measure(
    scene: &Scene,
    settings: &Settings,
    epoch: usize,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<Epoch, StudyError> {
    let mut bench = Bench::set_up(scene, settings, epoch, clock, progress)?;
    if epoch == 0 {
        bench.check(progress)?;
    }
    let circumstances = bench.sample(epoch, clock, progress);
    if epoch == 0 {
        progress(Stage::Count);
        bench.count();
    }
    // What takes no part keeps no rays.
    bench.structures.iter_mut().filter(|one| one.refused.is_some()).for_each(|one| one.rays.clear());
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
    /// All structures asked for, and what is known of them.
    structures: Vec<Structure>,
    /// Each of them, if it could be built.
    built: Vec<Option<Built>>,
    /// Where they lie.
    _placed: Placed,
}

impl<'a> Bench<'a> {
    /// Builds the structures and makes the rays.
    fn set_up(
        scene: &'a Scene,
        settings: &'a Settings,
        epoch: usize,
        clock: &dyn Clock,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Self, StudyError> {
        let Settings { structures: choices, threads, seed, .. } = settings;
        fits(choices, scene)?;
        let detailed = settings.detailed && epoch == 0;
        let seed = seed.wrapping_add(epoch as u64);
        let mut placed = Placed::new(choices, scene, threads, clock, seed, detailed, progress);
        let mut structures: Vec<Structure> = vec![];
        let mut built: Vec<Option<Built>> = vec![];
        for (choice, ready) in choices.iter().zip(placed.built.drain(..)) {
            let (label, name) = (choice.label.clone(), choice.entry.name.clone());
            let shape = Shape::default();
            let none = Structure {
                label,
                name,
                refused: None,
                wrong: false,
                build_ns: 0,
                outside: None,
                shape,
                rays: vec![],
                details: None,
            };
            match ready {
                Ok(one) => {
                    let details = detailed.then(|| StructureDetails {
                        config: choice.config.clone(),
                        triangle_test: choice.triangle_test().into(),
                        build_peak_bytes: one.peak_bytes,
                        counts: CaseCounts::of(&one.accel.shape()),
                    });
                    let shape = Shape::of(one.accel.as_ref());
                    structures.push(Structure { build_ns: one.build_ns, shape, details, ..none });
                    built.push(Some(one));
                }
                Err(StudyError::Build { cause, .. }) => {
                    structures.push(Structure { refused: Some(cause.to_string()), ..none });
                    built.push(None);
                }
                Err(other) => return Err(other),
            }
        }

        // Rays that start on a surface start where the guide finds it.
        let own;
        let guide = match built.iter().flatten().find(|built| built.choice.label == settings.guide.label) {
            Some(built) => built.accel.as_ref(),
            None => {
                own = Built::new(&settings.guide, scene, &settings.threads, clock)?;
                own.accel.as_ref()
            }
        };
        let workloads = settings.asked.workloads(scene, settings.seed, guide, progress);
        let hashes: Vec<String> = workloads.iter().map(Workload::hash).collect();
        for (structure, built) in structures.iter_mut().zip(&built) {
            let Some(built) = built else { continue };
            let asked = |(workload, hash): (&Workload, &String)| asked(built, workload, hash, detailed);
            structure.rays = workloads.iter().zip(&hashes).map(asked).collect();
        }
        Ok(Self { scene, settings, workloads, structures, built, _placed: placed })
    }

    /// Holds all structures against brute force, and says which have no time for it.
    fn check(&mut self, progress: &mut dyn FnMut(Stage)) -> Result<(), StudyError> {
        let built = self.built.iter().flatten();
        let checks = check_all(self.scene, built, &self.workloads, self.settings.check_tests, progress)?;
        let structures = self.structures.iter_mut().zip(&self.built);
        let structures = structures.filter_map(|(structure, built)| Some((structure, built.as_ref()?)));
        for ((structure, built), checks) in structures.zip(checks) {
            let failure = built.accel.remote().and_then(Remote::failure);
            let Some(checks) = checks.filter(|_| failure.is_none()) else {
                structure.refused = Some(failure.unwrap_or_else(|| PANICKED.into()));
                continue;
            };
            for (rays, check) in structure.rays.iter_mut().zip(checks) {
                if let Some(details) = &mut rays.details {
                    (details.checked, details.errors) = (check.rays, check.errors);
                }
                rays.wrong = rays.untimed.is_none() && check.errors > 0;
                if rays.wrong {
                    rays.untimed = Some(format!("{} wrong answers to {} rays", check.errors, check.rays));
                }
            }
        }
        Ok(())
    }

    /// Takes the samples of everything that is timed. How much of it is decided by all that is asked for, right or
    /// wrong: an epoch in which a program fails, or that checks nothing, decides the same.
    fn sample(&mut self, epoch: usize, clock: &dyn Clock, progress: &mut dyn FnMut(Stage)) -> Circumstances {
        let Settings { structures: choices, asked, runs, budget_ns, slowest, seed, threads, .. } = self.settings;
        let (runs, budget_ns, slowest, most_rays) = (*runs, *budget_ns, *slowest, asked.rays());
        let plan = Plan { runs, budget_ns, slowest, most_rays, seed: *seed, epoch };
        let built: Vec<Option<&Built>> = self.built.iter().map(Option::as_ref).collect();
        let timing = Timing { choices, built: &built, workloads: &self.workloads, threads, clock };
        let asked = Case::all(self.structures.len(), self.workloads.len());
        let allotted = timing.allot(&asked, &plan);

        let is_timed = |case: &Case| {
            let structure = &self.structures[case.structure];
            structure.refused.is_none() && structure.rays[case.workload].untimed.is_none()
        };
        let cases: Vec<Case> = asked.into_iter().filter(is_timed).collect();
        let total = cases.len() * allotted.allotment.runs;
        let mut told = |taken| progress(Stage::Trace(taken, total));
        let _pin = threads.pin();
        let watch = Watch::start(clock, threads.cores().map_or(0, |cores| cores[0]));
        let taken = timing.take(&allotted, &is_timed, &plan, &mut told);
        let circumstances = watch.end(clock);

        for (case, samples) in cases.iter().zip(taken) {
            let structure = &mut self.structures[case.structure];
            let samples = match samples {
                Ok(samples) => samples,
                Err(cause) => {
                    structure.wrong |= cause == Failed::Unsteady && !structure.may_err();
                    structure.refused = Some(cause.to_string());
                    continue;
                }
            };
            structure.outside = built[case.structure].and_then(|built| built.accel.remote()?.outside());
            let rays = &mut structure.rays[case.workload];
            (rays.rays, rays.checksum) = (samples.rays, samples.checksum);
            (rays.ns, rays.parts) = (samples.ns, samples.parts);
        }
        circumstances
    }

    /// Counts what is done for the rays, in a detailed epoch also where answers are wrong.
    fn count(&mut self) {
        let detailed = self.settings.detailed;
        let mut events = (detailed && self.settings.threads.count() == 1).then(Events::of_thread);
        let mut cases = Case::all(self.structures.len(), self.workloads.len());
        cases.retain(|case| {
            let structure = &self.structures[case.structure];
            let counts = |rays: &Rays| rays.untimed.is_none() || detailed && rays.wrong;
            structure.refused.is_none() && structure.rays.get(case.workload).is_some_and(counts)
        });
        for (case, counted) in cases.iter().zip(count_all(&cases, &self.built, &self.workloads)) {
            let Some(built) = &self.built[case.structure] else { continue };
            let (structure, workload) = (&mut self.structures[case.structure], &self.workloads[case.workload]);
            let accel = built.accel.as_ref();
            match counted {
                Some(counted) => keep(&counted, accel, workload, events.as_mut(), &mut structure.rays[case.workload]),
                None => structure.refused = Some(PANICKED.into()),
            }
            let failure = accel.remote().and_then(Remote::failure);
            structure.refused = structure.refused.take().or(failure);
        }
    }
}

/// What a structure is asked, before it is.
fn asked(built: &Built, workload: &Workload, hash: &str, detailed: bool) -> Rays {
    let declined = declined(built.accel.as_ref(), workload);
    Rays {
        workload: workload.name.clone(),
        hash: hash.into(),
        query: workload.query,
        all: workload.rays.len(),
        rays: 0,
        checksum: 0,
        ns: vec![],
        parts: vec![],
        untimed: declined.map(|what| format!("declined: it has no {what}")),
        wrong: false,
        counts: None,
        details: detailed.then(|| RayDetails { declined: declined.map(String::from), ..RayDetails::default() }),
    }
}

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
