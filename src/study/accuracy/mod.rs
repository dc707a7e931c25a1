//! `accuracy`: how wrong, how fast. Every structure over every triangle test answers the same rays; the exact oracle
//! judges, one thread is timed.

mod batch;
mod figure;
mod front;
mod kind;
mod record;
mod section;
mod slowest;
mod study;
mod table;
#[cfg(test)]
mod tests;

use super::bench::built::Built;
use super::bench::case::Case;
use super::bench::failed::Failed;
use super::bench::ray_cost::picoseconds;
use super::bench::room::fits;
use super::bench::timing::Timing;
use super::{PANICKED, Refused, Stage, StudyError, documented_defect, guarded};
use crate::accel::{BuildError, Query};
use crate::geometry::Ray;
use crate::measure::{Clock, Plan, Samples, Threads, median, spread};
use crate::oracle::Oracle;
use crate::registry::Choice;
use crate::scene::{Scene, Workload};
use crate::validate::{ErrorCounts, Rate};

use batch::Batch;
use slowest::slowest;

pub use figure::figure;
pub use kind::RayKind;
pub use record::AccuracyRecord;
pub use study::AccuracyStudy;
pub use table::{legend, table};

/// What is measured, and for how long.
pub struct AccuracySettings {
    /// Structures over triangle tests, in the order of the tables.
    pub choices: Vec<Choice>,
    pub kinds: Vec<RayKind>,
    /// Rays made before, in place of those kinds where there are any.
    pub replayed: Option<Workload>,
    /// Rays of each kind.
    pub rays: usize,
    /// Samples of every case.
    pub runs: usize,
    /// What a scene may take for samples, nanoseconds, and again half as much for the judging of what is slow: slow
    /// cases run on a part of the rays to keep within it.
    pub budget_ns: u64,
    /// Seed of the rays and of the order of samples.
    pub seed: u64,
}

/// What judging a case may always take.
const SHORT_JUDGING_NS: u64 = 2_000_000_000;

/// One record for each kind of rays and structure, kind by kind; and the structures that cannot be built, panic or
/// answer the same rays differently, which have none.
///
/// # Errors
/// If the structures do not fit into memory together, or the thread cannot be pinned.
pub fn accuracy_scene(
    scene: &Scene,
    settings: &AccuracySettings,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<(Vec<AccuracyRecord>, Vec<Refused>), StudyError> {
    fits(&settings.choices, scene)?;
    let threads = Threads::pinned(1).map_err(StudyError::Threads)?;
    let refusal =
        |label: &str, reason: String| Refused { label: label.into(), scene: scene.name.clone(), reason, wrong: false };
    let (mut built, mut refused) = (vec![], vec![]);
    for choice in &settings.choices {
        progress(Stage::Build(&choice.label));
        match Built::new(choice, scene, &threads, clock) {
            Ok(structure) => built.push(structure),
            Err(StudyError::Build { structure, cause, .. }) => refused.push(refusal(&structure, cause.to_string())),
            Err(other) => return Err(other),
        }
    }

    progress(Stage::Rays("the truth about all"));
    let oracle = Oracle::new(&scene.mesh);
    let of_kind = |kind: &RayKind| (kind.name().to_owned(), kind.rays(scene, settings.rays, settings.seed));
    let made: Vec<(String, Vec<Ray>)> = match &settings.replayed {
        Some(replayed) => vec![(replayed.name.clone(), replayed.rays.clone())],
        None => settings.kinds.iter().map(of_kind).collect(),
    };
    let (names, rays): (Vec<String>, Vec<Vec<Ray>>) = made.into_iter().unzip();
    let batches: Vec<Batch> = rays.into_iter().map(|rays| Batch::new(rays, &oracle)).collect();
    let batch = |(name, batch): (&String, &Batch)| Workload {
        name: name.clone(),
        query: Query::Closest,
        rays: batch.rays.clone(),
    };
    let workloads: Vec<Workload> = names.iter().zip(&batches).map(batch).collect();
    built.retain(|built| {
        let can = built.accel.capabilities();
        let declined = batches.iter().flat_map(|batch| &batch.rays).find_map(|ray| can.declines(ray));
        refused.extend(declined.map(|what| refusal(&built.choice.label, BuildError::Declined(what).to_string())));
        declined.is_none()
    });

    let cases = Case::all(built.len(), workloads.len());
    let costs = picoseconds(&cases, &built.iter().map(Some).collect::<Vec<_>>(), &workloads);
    let budget_ns = (settings.budget_ns / 2 / cases.len().max(1) as u64).max(SHORT_JUDGING_NS);
    let (mut judged, mut of_structures) = (vec![], vec![]);
    for (built, costs) in built.into_iter().zip(costs.chunks(workloads.len().max(1))) {
        progress(Stage::Check(&built.choice.label));
        let accel = built.accel.as_ref();
        let judge = |(batch, &ps): (&Batch, &u64)| batch.judge(accel, ps, budget_ns);
        match guarded(|| batches.iter().zip(costs).map(judge).collect::<Vec<_>>()) {
            Some(of_structure) => {
                judged.push(built);
                of_structures.push(of_structure);
            }
            None => refused.push(refusal(&built.choice.label, PANICKED.into())),
        }
    }
    let built = judged;
    let verdicts: Vec<&ErrorCounts> =
        (0..batches.len()).flat_map(|batch| of_structures.iter().map(move |verdicts| &verdicts[batch])).collect();
    let timed = time(&built, workloads, settings, &threads, clock, progress);

    // What fails on one kind of rays has no time on any.
    let failure = |place: usize| timed.iter().skip(place).step_by(built.len()).find_map(|times| times.as_ref().err());
    let failures: Vec<Option<&Failed>> = (0..built.len()).map(failure).collect();
    for (Built { choice, .. }, cause) in built.iter().zip(&failures) {
        let Some(cause) = cause else { continue };
        let wrong = **cause == Failed::Unsteady && documented_defect(&choice.entry.name).is_none();
        refused.push(Refused { wrong, ..refusal(&choice.label, cause.to_string()) });
    }

    let hash = scene.hash();
    let mut records = vec![];
    for (case, (judged, times)) in verdicts.iter().zip(&timed).enumerate() {
        let (batch, place) = (case / built.len(), case % built.len());
        let (None, Ok(times)) = (failures[place], times) else { continue };
        let kind = (names[batch].as_str(), batches[batch].rays.len());
        records.push(record(scene, &hash, &built[place], kind, settings, judged, times));
    }
    // What is not proven is not credited: an error that was seen once may be less than one that was not seen in fewer
    // rays.
    for of_kind in records.chunk_by_mut(AccuracyRecord::is_beside) {
        let points: Vec<(f64, f64)> = of_kind.iter().map(|r| (r.ns_per_ray, r.error_bound)).collect();
        let labels: Vec<String> = of_kind.iter().map(|r| r.label.clone()).collect();
        for (record, dominator) in of_kind.iter_mut().zip(front::dominators(&points)) {
            record.dominated_by = dominator.map(|i| labels[i].clone());
        }
    }
    Ok((records, refused))
}

/// How long a case takes.
struct Times {
    samples: Samples,
    /// The longest that a single ray takes, nanoseconds.
    slowest_ns: u64,
}

/// Those of all structures on all workloads, interleaved; in the order of the workloads, structure by structure.
fn time(
    built: &[Built],
    mut workloads: Vec<Workload>,
    settings: &AccuracySettings,
    threads: &Threads,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Vec<Result<Times, Failed>> {
    // Besides its samples a workload has lead-ins.
    let of_all = settings.budget_ns / (workloads.len() * (settings.runs + 1)).max(1) as u64;
    let mut cases = Case::all(built.len(), workloads.len());
    cases.sort_by_key(|case| case.workload);
    let choices: Vec<Choice> = built.iter().map(|built| built.choice.clone()).collect();
    let all: Vec<Option<&Built>> = built.iter().map(Some).collect();
    let costs = picoseconds(&cases, &all, &workloads);
    for (workload, costs) in workloads.iter_mut().zip(costs.chunks(built.len().max(1))) {
        workload.rays = common(&workload.rays, costs, of_all);
    }
    let plan = Plan {
        runs: settings.runs,
        budget_ns: settings.budget_ns,
        slowest: f64::INFINITY,
        most_rays: usize::MAX,
        seed: settings.seed,
        epoch: 0,
    };
    let timing = Timing { choices: &choices, built: &all, workloads: &workloads, threads, clock };
    let allotted = timing.allot(&cases, &plan);
    // After its samples every case is asked single rays.
    let sampled = cases.len() * allotted.allotment.runs;
    let total = sampled + cases.len();
    let taken = timing.take(&allotted, &|_| true, &plan, &mut |taken| progress(Stage::Trace(taken, total)));
    let _pin = threads.pin();
    let mut times = vec![];
    for (case, samples) in cases.iter().zip(taken) {
        progress(Stage::Trace(sampled + times.len(), total));
        times.push(samples.map(|samples| {
            let rays = spread(&workloads[case.workload].rays, samples.rays);
            Times { slowest_ns: slowest(built[case.structure].accel.as_ref(), &rays, clock), samples }
        }));
    }
    times
}

/// Rays that are timed at least.
const FEWEST: usize = 256;

/// Structures that are slower than this times the fastest do not decide how many rays are timed.
const SLOW: u64 = 30;

/// As many of the rays, evenly spread, as all structures together answer in `budget_ns`, one of which takes them so
/// many picoseconds: rays differ so much in what they cost that only times on the same ones can be compared.
fn common(rays: &[Ray], costs: &[u64], budget_ns: u64) -> Vec<Ray> {
    let fastest = costs.iter().copied().min().unwrap_or(1);
    let together: u64 = costs.iter().filter(|&&ps| ps <= SLOW * fastest).sum();
    let count = u128::from(budget_ns) * 1000 / u128::from(together.max(1));
    let fewest = FEWEST.min(rays.len()) as u128;
    spread(rays, count.clamp(fewest, rays.len() as u128) as usize)
}

fn record(
    scene: &Scene,
    hash: &str,
    built: &Built,
    (kind, rays): (&str, usize),
    settings: &AccuracySettings,
    judged: &ErrorCounts,
    Times { samples, slowest_ns }: &Times,
) -> AccuracyRecord {
    let both = |rate: Rate| Some([rate.share()?, rate.bound()?]);
    let [error, error_bound] = both(judged.error()).expect("some rays are judged");
    AccuracyRecord {
        schema: AccuracyRecord::SCHEMA,
        scene: scene.name.clone(),
        scene_hash: hash.into(),
        triangles: scene.mesh.len(),
        stand_in: !scene.stand_ins.is_empty(),
        structure: built.choice.entry.name.clone(),
        label: built.choice.label.clone(),
        config: built.choice.config.clone(),
        triangle_test: built.choice.triangle_test().into(),
        rays: kind.into(),
        seed: settings.seed,
        judged: judged.rays,
        sampled: judged.rays < rays as u64,
        hits: judged.hits,
        missed: judged.missed,
        false_hits: judged.false_hits,
        wrong_depth: judged.wrong_depth,
        wrong_primitive: judged.wrong_primitive,
        error,
        error_bound,
        miss_rate: both(judged.miss_rate()),
        false_hit_rate: both(judged.false_hit_rate()),
        wrong_depth_rate: both(judged.wrong_depth_rate()),
        ulps: judged.ulps,
        ns_per_ray: median(&samples.ns_per_ray()).expect("there is a sample"),
        slowest_ns: Some(*slowest_ns),
        timed: samples.rays,
        runs: samples.ns.len(),
        dominated_by: None,
        provenance: None,
    }
}
