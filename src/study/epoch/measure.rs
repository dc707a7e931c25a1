//! Measuring one epoch of one scene.

use super::{Epoch, RayCounts, Rays, Settings, Structure};
use crate::geometry::Ray;
use crate::measure::{Clock, Pass, Plan, Samples, Timed, spread, take, take_again};
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};
use crate::study::attribution::scene_name;
use crate::study::built::Built;
use crate::study::check::check_all;
use crate::study::compare::declined;
use crate::study::counted::Counted;
use crate::study::guarded::Guarded;
use crate::study::{PANICKED, Stage, StudyError, guarded};

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
    let _pin = settings.threads.pin();
    let mut bench = Bench::set_up(scene, settings, clock, progress)?;
    match first {
        None => bench.check(clock, progress)?,
        Some(first) => bench.resume(first),
    }
    bench.sample(epoch, first.is_some(), clock, progress)?;
    if first.is_none() {
        bench.count();
    }
    Ok(Epoch {
        scene: scene_name(&scene.name, !scene.stand_ins.is_empty()),
        scene_hash: scene.hash(),
        triangles: scene.mesh.len(),
        epoch,
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
    /// Those that could be built.
    built: Vec<Built>,
    /// The number of each of them among all.
    places: Vec<usize>,
}

impl<'a> Bench<'a> {
    /// Builds the structures and makes the rays.
    fn set_up(
        scene: &'a Scene,
        settings: &'a Settings,
        clock: &dyn Clock,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Self, StudyError> {
        let (mut structures, mut built, mut places) = (vec![], vec![], vec![]);
        for choice in &settings.structures {
            progress(Stage::Build(&choice.label));
            let (label, name) = (choice.label.clone(), choice.entry.name.clone());
            let none = Structure { label, name, refused: None, build_ns: 0, bytes: 0, leaves: 0, rays: vec![] };
            match Built::new(choice, scene, &settings.threads, clock) {
                Ok(one) => {
                    let (bytes, leaves) = (one.accel.footprint().total(), one.accel.shape().leaves);
                    places.push(structures.len());
                    structures.push(Structure { build_ns: one.build_ns, bytes, leaves, ..none });
                    built.push(one);
                }
                Err(StudyError::Build { cause, .. }) => {
                    structures.push(Structure { refused: Some(cause.to_string()), ..none });
                }
                Err(other) => return Err(other),
            }
        }

        // Rays that start on a surface start where the guide finds it.
        let own;
        let guide = match built.iter().find(|built| built.choice.label == settings.guide.label) {
            Some(built) => built.accel.as_ref(),
            None => {
                own = Built::new(&settings.guide, scene, &settings.threads, clock)?;
                own.accel.as_ref()
            }
        };
        let sampling = Sampling::about(scene, settings.rays, settings.seed);
        let mut workloads = vec![];
        for &kind in settings.workloads.iter().filter(|&&kind| kind != WorkloadKind::Mirror || scene.has_mirrors()) {
            progress(Stage::Rays(kind.name()));
            workloads.push(Workload::new(scene, kind, &sampling, guide));
        }
        workloads.retain(|workload| !workload.rays.is_empty());
        Ok(Self { scene, settings, workloads, structures, built, places })
    }

    /// Holds all structures against brute force, and says which are timed on which rays.
    fn check(&mut self, clock: &dyn Clock, progress: &mut dyn FnMut(Stage)) -> Result<(), StudyError> {
        let batches: Vec<&[Ray]> = self.workloads.iter().map(|workload| &workload.rays[..]).collect();
        let checks = check_all(self.scene, &self.built, &batches, clock, self.settings.check_ns, progress)?;
        for ((&place, built), checks) in self.places.iter().zip(&self.built).zip(checks) {
            let Some(checks) = checks else {
                self.structures[place].refused = Some(PANICKED.into());
                continue;
            };
            for (workload, check) in self.workloads.iter().zip(checks) {
                let declined =
                    declined(built.accel.as_ref(), workload).map(|what| format!("declined: it has no {what}"));
                let wrong =
                    (check.errors > 0).then(|| format!("{} wrong answers to {} rays", check.errors, check.rays));
                self.structures[place].rays.push(Rays {
                    workload: workload.name.clone(),
                    query: workload.query,
                    rays: 0,
                    checksum: 0,
                    ns: vec![],
                    wrong: declined.is_none() && wrong.is_some(),
                    untimed: declined.or(wrong),
                    counts: None,
                });
            }
        }
        Ok(())
    }

    /// Takes over what was found in the first epoch.
    fn resume(&mut self, first: &Epoch) {
        for structure in &mut self.structures {
            let Some(before) = first.structures.iter().find(|before| before.label == structure.label) else { continue };
            structure.refused = structure.refused.take().or_else(|| before.refused.clone());
            let again = |rays: &Rays| Rays { ns: vec![], counts: None, ..rays.clone() };
            structure.rays = before.rays.iter().map(again).collect();
        }
    }

    /// What is timed: by its number among those built, its kind of rays among those of the structure and among all.
    fn slots(&self) -> Vec<(usize, usize, usize)> {
        let mut slots = vec![];
        for (b, &place) in self.places.iter().enumerate() {
            let structure = &self.structures[place];
            let timed = structure.rays.iter().enumerate().filter(|(_, rays)| rays.untimed.is_none());
            for (r, rays) in timed.filter(|_| structure.refused.is_none()) {
                let workload = self.workloads.iter().position(|workload| workload.name == rays.workload);
                slots.extend(workload.map(|w| (b, r, w)));
            }
        }
        slots
    }

    /// Takes the samples of everything that is timed, interleaved; with `again` on as many rays as before.
    fn sample(
        &mut self,
        epoch: usize,
        again: bool,
        clock: &dyn Clock,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<(), StudyError> {
        let slots = self.slots();
        let threads = &self.settings.threads;
        let (mut cases, panicked): (Vec<Box<dyn Timed>>, Vec<_>) = slots
            .iter()
            .map(|&(b, _, w)| {
                let workload = &self.workloads[w];
                let pass = Pass::new(self.built[b].accel.as_ref(), &workload.rays, workload.query, threads);
                let (pass, panicked) = Guarded::new(pass);
                (Box::new(pass) as Box<dyn Timed>, panicked)
            })
            .collect();

        // The search for the number of rays and the warm-up cost about three passes more than the samples.
        let passes = (cases.len() * (self.settings.runs + 3)).max(1) as u64;
        let plan = Plan {
            runs: self.settings.runs,
            sample_budget_ns: (self.settings.budget_ns / passes).max(1),
            warmup: 1,
            seed: self.settings.seed.wrapping_add(epoch as u64),
        };
        let total = cases.len() * self.settings.runs;
        let mut told = |taken| progress(Stage::Trace(taken, total));
        let structures = &mut self.structures;
        let samples = if again {
            let none = |&(b, r, _): &(usize, usize, usize)| {
                let rays = structures[self.places[b]].rays[r].rays;
                Samples { rays, checksum: 0, same_answers: true, unsteady: 0, ns: vec![] }
            };
            let mut samples: Vec<Samples> = slots.iter().map(none).collect();
            take_again(clock, &mut cases, &plan, &mut samples, &mut told).map(|()| samples)
        } else {
            take(clock, &mut cases, &plan, &mut told)
        };
        let scene = &self.scene.name;
        let samples = samples.map_err(|cause| {
            let (b, _, w) = slots[cause.case];
            let (structure, rays) = (self.built[b].choice.label.clone(), self.workloads[w].name.clone());
            StudyError::Unsteady { structure, scene: scene.clone(), rays, cause }
        })?;

        for ((&(b, r, _), samples), panicked) in slots.iter().zip(samples).zip(panicked) {
            let structure = &mut structures[self.places[b]];
            if panicked.get() {
                structure.refused = Some(PANICKED.into());
            }
            let rays = &mut structure.rays[r];
            if again && rays.checksum != samples.checksum {
                return Err(StudyError::Changed { structure: structure.label.clone(), scene: scene.clone() });
            }
            (rays.rays, rays.checksum, rays.ns) = (samples.rays, samples.checksum, samples.ns);
        }
        Ok(())
    }

    /// Counts what was done for the rays that were timed.
    fn count(&mut self) {
        for (b, r, w) in self.slots() {
            let structure = &mut self.structures[self.places[b]];
            let (rays, workload) = (&mut structure.rays[r], &self.workloads[w]);
            let asked = spread(&workload.rays, rays.rays);
            match guarded(|| Counted::new(self.built[b].accel.as_ref(), &asked, workload.query)) {
                Some(counted) => {
                    let (tests, steps) = (counted.tests_per_ray(), counted.steps_per_ray());
                    rays.counts = Some(RayCounts { hit_rate: counted.hit_rate(), tests, steps });
                }
                None => structure.refused = Some(PANICKED.into()),
            }
        }
    }
}
