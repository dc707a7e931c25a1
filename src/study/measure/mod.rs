//! Measures one epoch of one scene.

mod build_watch;
mod built;
mod check;
mod counted;
mod environment;
mod guarded;
mod judge;
mod memory;
mod pair;
mod prepared;
mod ray_cost;
mod rays;
mod timed_check;
mod timing;

use rayon::prelude::*;

use super::epoch::{RayCounts, Rays, Structure};
use super::{Case, Check, Epoch, Stage, StudyError};
use crate::accel::{BuildError, Remote};
use crate::measure::{Clock, SamplePlan, spread};
use crate::oracle::Oracle;
use crate::scene::Workload;
use built::Built;
use check::{Checks, declined};
use judge::{Judge, slowest};
use pair::Pair;
use prepared::build_all;
use rays::{drop_times_of_wrong_tree, new_record, record_check};
use timed_check::{TimedCheck, checking_tree};
use timing::{SampleFailure, Timing};

pub use build_watch::BuildWatch;
pub use environment::Environment;
pub use guarded::{PANICKED, guarded};
pub use prepared::Prepared;

/// Measures all structures of a case in one epoch. In epoch 0, also checks hits and counts work.
///
/// A structure that cannot be built, panics or changes its hits is refused, without an error. Returns an error if the
/// structures do not fit into memory, or if the rays or the references of the checks cannot be made.
pub fn measure(
    case: &Case,
    prepared: &Prepared,
    clock: &dyn Clock,
    watch: &BuildWatch,
    progress: &mut dyn FnMut(Stage),
) -> Result<Epoch, StudyError> {
    let mut bench = Bench::set_up(case, prepared, clock, watch, progress)?;
    let is_first = case.epoch == 0;
    if is_first {
        match case.settings.check {
            Check::BruteForce { tests, limit_ns } => bench.check(tests, limit_ns, progress)?,
            Check::Oracle => bench.judge(progress),
        }
    }
    let environment = bench.sample(progress);
    if is_first {
        if let Check::BruteForce { tests, .. } = case.settings.check {
            bench.check_timed(tests, progress)?;
        }
        progress(Stage::Count);
        bench.count();
        bench.structures.iter_mut().for_each(drop_times_of_wrong_tree);
    }
    bench.structures.iter_mut().filter(|one| one.refused.is_some()).for_each(|one| one.rays.clear());
    let scene = &prepared.scene;
    Ok(Epoch {
        scene: scene.name.clone(),
        scene_hash: scene.hash(),
        stand_in: !scene.stand_ins.is_empty(),
        triangles: scene.mesh.len(),
        degenerate: scene.mesh.degenerate().len(),
        epoch: case.epoch,
        environment,
        structures: bench.structures,
    })
}

struct Bench<'a> {
    case: &'a Case,
    prepared: &'a Prepared,
    clock: &'a dyn Clock,
    workloads: Vec<Workload>,
    structures: Vec<Structure>,
    /// In the order of `structures`. An entry is `None` if the structure was not built.
    built: Vec<Option<Built>>,
    /// Checksums of the hits on the timed rays of this epoch.
    checksums: Vec<(Pair, u64)>,
    /// Memory blocks of random sizes. The blocks give the structures different addresses in each epoch.
    _blocks: Vec<Vec<u8>>,
}

impl<'a> Bench<'a> {
    fn set_up(
        case: &'a Case,
        prepared: &'a Prepared,
        clock: &'a dyn Clock,
        watch: &BuildWatch,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<Self, StudyError> {
        let Prepared { scene, choices, threads, .. } = prepared;
        memory::fits(choices, scene)?;
        let (all_built, blocks) = build_all(case, prepared, clock, watch, progress);
        let mut structures: Vec<Structure> = vec![];
        let mut built: Vec<Option<Built>> = vec![];
        for ((choice, request), ready) in choices.iter().zip(&case.structures).zip(all_built) {
            let mut structure = Structure {
                label: choice.label.clone(),
                role: request.role.clone(),
                name: choice.entry.name.clone(),
                config: choice.config.clone(),
                triangle_test: choice.triangle_test().into(),
                ..Structure::default()
            };
            match &ready {
                Ok(one) => {
                    structure.shape = one.accel.as_ref().into();
                    (structure.build_ns, structure.build_peak_bytes) = (one.build_ns, one.peak_bytes);
                }
                Err(reason) => structure.refused = Some(reason.clone()),
            }
            structures.push(structure);
            built.push(ready.ok());
        }

        // Secondary rays start at hit points that `tracer` finds.
        let own;
        let tracer =
            match built.iter().flatten().find(|built| built.choice.label == prepared.secondary_ray_structure.label) {
                Some(built) => built,
                None => {
                    let refused = StudyError::of_build(&prepared.secondary_ray_structure.label, &scene.name);
                    own = Built::new(&prepared.secondary_ray_structure, scene, threads, clock).map_err(refused)?;
                    &own
                }
            };
        let mut report = |kind: &str| progress(Stage::Rays(kind.into()));
        let workloads = case.workloads.workloads(scene, case.settings.seed, tracer.accel.as_ref(), &mut report);
        let workloads = workloads.map_err(|cause| StudyError::Rays(format!("{cause:#}")))?;
        let hashes: Vec<String> = workloads.iter().map(Workload::hash).collect();
        for (structure, built) in structures.iter_mut().zip(&built) {
            let Some(built) = built else { continue };
            let rays = |(workload, hash): (&Workload, &String)| new_record(built, workload, hash);
            structure.rays = workloads.iter().zip(&hashes).map(rays).collect();
        }
        Ok(Self { case, prepared, clock, workloads, structures, built, checksums: vec![], _blocks: blocks })
    }

    fn check(
        &mut self,
        tests: usize,
        limit_ns: Option<u64>,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<(), StudyError> {
        let Self { clock, ref workloads, .. } = *self;
        let checks = Checks { scene: &self.prepared.scene, workloads, tests, limit_ns, clock };
        let checks = checks.all(self.built.iter().flatten(), progress)?;
        let structures = self.structures.iter_mut().zip(&self.built);
        let structures = structures.filter_map(|(structure, built)| Some((structure, built.as_ref()?)));
        for ((structure, built), checks) in structures.zip(checks) {
            let Some(checks) = refuse_unless(structure, built, checks) else { continue };
            for (rays, check) in structure.rays.iter_mut().zip(checks) {
                record_check(rays, check, &self.case.scene.word, built);
            }
        }
        Ok(())
    }

    fn check_timed(&mut self, tests: usize, progress: &mut dyn FnMut(Stage)) -> Result<(), StudyError> {
        let Prepared { scene, .. } = self.prepared;
        let mut checks = TimedCheck::new(scene, &self.workloads, self.case.epochs, tests);
        for pair in Pair::all(self.structures.len(), self.workloads.len()) {
            let (structure, built) = (&mut self.structures[pair.structure], &self.built[pair.structure]);
            let Some(built) = built.as_ref().filter(|_| structure.refused.is_none()) else { continue };
            let Some(&(_, checksum)) = self.checksums.iter().find(|(own, _)| *own == pair) else { continue };
            let timed = structure.rays[pair.workload].rays;
            progress(Stage::Check((&structure.label).into()));
            let failed = StudyError::of_build(checking_tree(built), &scene.name);
            let check = checks.check(built, &pair, timed, checksum).map_err(failed)?;
            if let Some(check) = refuse_unless(structure, built, check) {
                record_check(&mut structure.rays[pair.workload], check, &self.case.scene.word, built);
            }
        }
        Ok(())
    }

    /// A structure that declines a workload is refused, because its error rate would cover fewer rays.
    fn judge(&mut self, progress: &mut dyn FnMut(Stage)) {
        progress(Stage::Rays("exact results for all".into()));
        let oracle = Oracle::new(&self.prepared.scene.mesh);
        let budget_ns = self.case.settings.budget_ns.unwrap_or(u64::MAX / 2);
        let pairs = Pair::all(self.structures.len(), self.workloads.len());
        let all: Vec<Option<&Built>> = self.built.iter().map(Option::as_ref).collect();
        let costs = ray_cost::picoseconds(&pairs, &all, &self.workloads);
        let judges: Vec<Judge> = self.workloads.iter().map(|workload| Judge::new(&workload.rays, &oracle)).collect();
        for (place, structure) in self.structures.iter_mut().enumerate() {
            let Some(built) = &self.built[place] else { continue };
            if let Some(what) = self.workloads.iter().find_map(|workload| declined(built.accel.as_ref(), workload)) {
                structure.refused = Some(BuildError::Declined(what).to_string());
                continue;
            }
            progress(Stage::Check((&structure.label).into()));
            let costs = &costs[place * judges.len()..][..judges.len()];
            let judge = |(judge, &ps): (&Judge, &u64)| judge.errors(built.accel.as_ref(), ps, budget_ns, pairs.len());
            let judged = guarded(|| judges.iter().zip(costs).map(judge).collect::<Vec<_>>());
            let judged = refuse_unless(structure, built, judged).unwrap_or_default();
            structure.rays.iter_mut().zip(judged).for_each(|(rays, errors)| rays.errors = Some(errors));
        }
    }

    /// A failed structure does not change the numbers of rays and samples of other structures. The function `join`
    /// requires equal numbers in all epochs.
    fn sample(&mut self, progress: &mut dyn FnMut(Stage)) -> Environment {
        let (clock, settings) = (self.clock, &self.case.settings);
        let plan = SamplePlan {
            runs: settings.runs,
            budget_ns: settings.budget_ns.unwrap_or(u64::MAX),
            slowest: settings.slowest.filter(|_| settings.budget_ns.is_some()).unwrap_or(f64::INFINITY),
            most_rays: self.case.workloads.most_rays(),
            seed: settings.seed,
            epoch: self.case.epoch,
        };
        let Prepared { choices, threads, .. } = self.prepared;
        let built: Vec<Option<&Built>> = self.built.iter().map(Option::as_ref).collect();
        let by_clock = settings.is_quick();
        let all = Pair::all(self.structures.len(), self.workloads.len());
        let timing =
            Timing { cases: &all, choices, built: &built, workloads: &self.workloads, threads, clock, by_clock };
        let allotment = timing.allot(&plan);

        let is_timed = |pair: &Pair| {
            let structure = &self.structures[pair.structure];
            structure.refused.is_none() && structure.rays[pair.workload].untimed.is_none()
        };
        let pairs: Vec<Pair> = all.iter().copied().filter(is_timed).collect();
        let total = pairs.len() * allotment.runs;
        let mut report = |taken| progress(Stage::Trace(taken, total));
        let _pin = threads.pin();
        let core = threads.cores().map_or(0, |cores| cores[0]);
        let (taken, environment) =
            Environment::during(clock, core, || timing.take(&allotment, &is_timed, &plan, &mut report));

        let times_single_rays = settings.check == Check::Oracle && self.case.epoch == 0;
        for (pair, samples) in pairs.iter().zip(taken) {
            let structure = &mut self.structures[pair.structure];
            let samples = match samples {
                Ok(samples) => samples,
                Err(cause) => {
                    structure.wrong |= cause == SampleFailure::Unsteady && !structure.may_err();
                    structure.refused = Some(cause.to_string());
                    continue;
                }
            };
            structure.outside = built[pair.structure].and_then(|built| built.accel.remote()?.outside());
            let rays = &mut structure.rays[pair.workload];
            if let Some(built) = built[pair.structure].filter(|_| times_single_rays) {
                let alone = spread(&self.workloads[pair.workload].rays, samples.rays);
                rays.slowest_ns = Some(slowest(built.accel.as_ref(), &alone, clock));
            }
            self.checksums.push((*pair, samples.timed_checksum));
            (rays.rays, rays.checksum) = (samples.rays, samples.checksum);
            (rays.ns, rays.parts) = (samples.ns, samples.parts);
        }
        environment
    }

    fn count(&mut self) {
        let settings = &self.case.settings;
        let mut pairs = Pair::all(self.structures.len(), self.workloads.len());
        pairs.retain(|pair| {
            let structure = &self.structures[pair.structure];
            let counts = |rays: &Rays| rays.untimed.is_none() || rays.wrong;
            structure.refused.is_none() && structure.rays.get(pair.workload).is_some_and(counts)
        });
        let count = if settings.is_quick() { counted::few } else { counted::affordable };
        let (built, workloads) = (&self.built, &self.workloads);
        let counted = |pair: &Pair| {
            let (built, workload) = (built[pair.structure].as_ref()?, &workloads[pair.workload]);
            guarded(|| count(built.accel.as_ref(), &workload.rays, workload.query))
        };
        let counted: Vec<Option<RayCounts>> = pairs.par_iter().map(counted).collect();
        for (pair, counted) in pairs.iter().zip(counted) {
            let Some(built) = &built[pair.structure] else { continue };
            let (structure, workload) = (&mut self.structures[pair.structure], &workloads[pair.workload]);
            let Some(mut counts) = refuse_unless(structure, built, counted) else { continue };
            if settings.whole_counts.contains(&self.case.structures[pair.structure].spec) {
                counts.whole_tests = counted::all(built.accel.as_ref(), &workload.rays, workload.query).tests;
            }
            structure.rays[pair.workload].counts = Some(counts);
        }
    }
}

/// Refuses the structure after a panic or a failure of the runner. `result` is `None` after a panic.
fn refuse_unless<T>(structure: &mut Structure, built: &Built, result: Option<T>) -> Option<T> {
    let panicked = result.is_none().then(|| PANICKED.into());
    let Some(reason) = built.accel.remote().and_then(Remote::failure).or(panicked) else { return result };
    structure.refused.get_or_insert(reason);
    None
}

#[cfg(test)]
pub(crate) mod tests;
