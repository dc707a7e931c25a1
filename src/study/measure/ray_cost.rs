//! Predicts the time per ray from counts of traversal steps and tested blocks of triangles.
//!
//! The prediction uses no clock, because the prediction must be equal in all epochs.

use rayon::prelude::*;

use super::built::Built;
use super::check::declined;
use super::counted::few;
use super::guarded::guarded;
use super::pair::Pair;
use crate::accel::Observed;
use crate::measure::median;
use crate::request::BRUTE_FORCE;
use crate::scene::Workload;

// The following three constants are rounded from a regression over all families of structures (papers/TUNING.md). A
// prediction is wrong by a factor of about 1.5, but the possible numbers of rays differ by factors of four.

/// Fixed nanoseconds per ray.
const RAY_NS: f64 = 20.0;
/// Nanoseconds per entered inner node or leaf.
const STEP_NS: f64 = 15.0;
/// Nanoseconds per tested block of triangles.
const BLOCK_NS: f64 = 8.0;

/// The slowdown factor if the crate is compiled without optimisation.
const UNOPTIMISED: f64 = if cfg!(debug_assertions) { 12.0 } else { 1.0 };

/// Assumed steps per ray if the workload has no predicted case. A tree over a hundred thousand triangles needs about as
/// many.
const STEPS: f64 = 12.0;

/// Predicted picoseconds per ray, one value per case.
///
/// A case without a prediction gets the median prediction for its workload. The median excludes brute force.
pub fn picoseconds(cases: &[Pair], built: &[Option<&Built>], workloads: &[Workload]) -> Vec<u64> {
    let predicted: Vec<Option<f64>> = cases.par_iter().map(|case| predicted(case, built, workloads)).collect();
    let is_brute = |case: &Pair| built[case.structure].is_some_and(|built| built.choice.entry.name == BRUTE_FORCE);
    let others = |case: &Pair| {
        let alike =
            cases.iter().zip(&predicted).filter(|(other, _)| other.workload == case.workload && !is_brute(other));
        median(&alike.filter_map(|(_, ns)| *ns).collect::<Vec<f64>>())
    };
    let nanoseconds = |(case, own): (&Pair, &Option<f64>)| {
        let ns = own.or_else(|| others(case)).unwrap_or(RAY_NS + STEP_NS * STEPS);
        (UNOPTIMISED * ns * 1000.0) as u64
    };
    cases.iter().zip(&predicted).map(nanoseconds).collect()
}

/// Nanoseconds per ray.
fn predicted(case: &Pair, built: &[Option<&Built>], workloads: &[Workload]) -> Option<f64> {
    let (accel, workload) = (built[case.structure]?.accel.as_ref(), &workloads[case.workload]);
    if accel.remote().is_some() || accel.observed() != Observed::ALL || declined(accel, workload).is_some() {
        return None;
    }
    let counted = guarded(|| few(accel, &workload.rays, workload.query))?;
    let per_ray = |n: Option<u64>| Some(n? as f64 / counted.rays.max(1) as f64);
    Some(RAY_NS + STEP_NS * per_ray(counted.steps)? + BLOCK_NS * per_ray(counted.blocks)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin::Builtin;
    use crate::measure::{SystemClock, Threads};
    use crate::registry::Registry;
    use crate::scene::{Sampling, WorkloadKind};

    #[test]
    fn costs_follow_counts_and_what_does_not_count_is_taken_for_the_median() {
        let scene = Builtin::find("torus").unwrap().scene(None).unwrap();
        let (registry, threads) = (Registry::builtin(), Threads::unstarted(1));
        let build = |spec: &str| {
            let choice = registry.choose(spec).unwrap();
            Built::new(&choice, &scene, &threads, &SystemClock::start()).unwrap()
        };
        let all = ["brute-force", "median-kd", "sah-kd", "sah-bvh"].map(build);
        let tracer = all[2].accel.as_ref();
        let workloads = [Workload::new(&scene, WorkloadKind::Primary, &Sampling::of(&scene), tracer)];
        let cases = Pair::all(all.len(), 1);
        let mut built = all.each_ref().map(Some);
        let costs = picoseconds(&cases, &built, &workloads);
        // Brute force is one leaf with 2304 triangles in blocks of eight.
        let brute = UNOPTIMISED * (RAY_NS + STEP_NS + 288.0 * BLOCK_NS) * 1000.0;
        assert_eq!(costs[0], brute as u64);
        assert!(costs[1] < costs[0] / 4 && costs[2..].iter().all(|&cost| cost < costs[1]), "{costs:?}");
        assert_eq!(picoseconds(&cases, &built, &workloads), costs, "costs do not depend on a clock");
        assert!(picoseconds(&[], &built, &workloads).is_empty());

        // A structure that failed to build gets the median cost of `sah-kd` and `sah-bvh`.
        built[1] = None;
        let without = picoseconds(&cases, &built, &workloads);
        assert!(without[1].abs_diff(costs[2].midpoint(costs[3])) <= 1, "{without:?} {costs:?}");
        assert_eq!([without[0], without[2], without[3]], [costs[0], costs[2], costs[3]]);
    }
}
