//! How fast are the answers, and how much work do they take?

use super::{Settings, declined};
use crate::measure::{Clock, Pass, Plan, Timed, spread, take};
use crate::scene::{Scene, Workload};
use crate::study::built::Built;
use crate::study::check::Check;
use crate::study::counted::Counted;
use crate::study::guarded::Guarded;
use crate::study::{Stage, StudyError, guarded};

/// Of one structure on one workload.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trace {
    /// Rays of a sample.
    pub rays: usize,
    /// Those that hit.
    pub hits: usize,
    /// Samples; none when an answer was wrong.
    pub ns: Vec<f64>,
    pub tests_per_ray: Option<f64>,
    pub steps_per_ray: Option<f64>,
    pub leaf_steps_per_ray: Option<f64>,
    pub empty_leaf_steps_per_ray: Option<f64>,
    pub tests_over_minimum: Option<f64>,
}

/// A full pass that takes longer runs on a sample of its rays, whatever the budget.
const LONGEST_SAMPLE_NS: u64 = 1_000_000_000;

/// Rays that a case without times is counted on.
const COUNTED: usize = 4096;

/// Times every case whose answers are right, all interleaved, and counts it on the rays it was timed on. Nothing for a
/// structure that panicked.
#[allow(clippy::too_many_arguments)]
pub(super) fn trace_all(
    scene: &Scene,
    built: &[Built],
    workloads: &[Workload],
    checks: &[Vec<Check>],
    settings: &Settings,
    clock: &dyn Clock,
    budget_ns: u64,
    progress: &mut dyn FnMut(Stage),
) -> Result<Vec<Option<Vec<Trace>>>, StudyError> {
    let right: Vec<(usize, usize)> = (0..built.len())
        .flat_map(|s| (0..workloads.len()).map(move |w| (s, w)))
        .filter(|&(s, w)| checks[s][w].errors == 0 && declined(built[s].accel.as_ref(), &workloads[w]).is_none())
        .collect();
    let (mut cases, panicked): (Vec<Box<dyn Timed>>, Vec<_>) = right
        .iter()
        .map(|&(s, w)| {
            let workload = &workloads[w];
            let pass = Pass::new(built[s].accel.as_ref(), &workload.rays, workload.query, &settings.threads);
            let (pass, panicked) = Guarded::new(pass);
            (Box::new(pass) as Box<dyn Timed>, panicked)
        })
        .collect();

    // The warm-up costs about two passes more than the samples.
    let slots = (cases.len() * (settings.runs + 2)).max(1) as u64;
    let plan = Plan {
        runs: settings.runs,
        sample_budget_ns: (budget_ns / slots).clamp(1, LONGEST_SAMPLE_NS),
        warmup: 1,
        seed: settings.seed,
    };
    let total = cases.len() * settings.runs;
    let samples = take(clock, &mut cases, &plan, &mut |taken| progress(Stage::Trace(taken, total)));
    let samples = samples.map_err(|cause| {
        let (s, w) = right[cause.case];
        StudyError::Unsteady {
            structure: built[s].choice.label.clone(),
            scene: scene.name.clone(),
            rays: workloads[w].name.clone(),
            cause,
        }
    })?;

    let mut traces = vec![Some(vec![Trace::default(); workloads.len()]); built.len()];
    for ((&(s, w), samples), panicked) in right.iter().zip(samples).zip(panicked) {
        if panicked.get() {
            traces[s] = None;
        }
        if let Some(traces) = &mut traces[s] {
            traces[w].rays = samples.rays;
            traces[w].ns = samples.ns.iter().map(|&ns| ns as f64).collect();
        }
    }
    let counted = |(built, traces): (&Built, Option<Vec<Trace>>)| {
        let mut traces = traces?;
        for (trace, workload) in traces.iter_mut().zip(workloads) {
            if declined(built.accel.as_ref(), workload).is_some() {
                continue;
            }
            if trace.ns.is_empty() {
                trace.rays = COUNTED.min(workload.rays.len());
            }
            let rays = spread(&workload.rays, trace.rays);
            let counted = guarded(|| Counted::new(built.accel.as_ref(), &rays, workload.query))?;
            trace.hits = counted.hits;
            trace.tests_per_ray = counted.tests_per_ray();
            trace.steps_per_ray = counted.steps_per_ray();
            trace.leaf_steps_per_ray = counted.leaf_steps_per_ray();
            trace.empty_leaf_steps_per_ray = counted.empty_leaf_steps_per_ray();
            trace.tests_over_minimum = counted.tests_over_minimum();
        }
        Some(traces)
    };
    Ok(built.iter().zip(traces).map(counted).collect())
}
