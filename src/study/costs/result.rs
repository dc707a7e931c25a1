//! From what was measured to costs.

use serde::Serialize;

use super::regression::{Costs, regress};
use crate::measure::{Estimate, Rerun, Variance, median};
use crate::report::words::each_once;
use crate::study::epoch::{Epoch, lines};

/// A structure on one kind of rays of one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Observation {
    pub scene: String,
    /// As chosen.
    pub structure: String,
    pub workload: String,
    pub ns_per_ray: f64,
    pub steps_per_ray: f64,
    /// Blocks of triangles that were tested at once.
    pub blocks_per_ray: f64,
    pub tests_per_ray: f64,
    /// What the costs of its family make of the counts.
    pub predicted_ns: f64,
    /// The same of the costs found on all other scenes; nothing where there are none, or they do not tell the costs.
    pub foreseen_ns: Option<f64>,
}

/// The costs of one family of structures, or of all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Family {
    /// `all`, or what the structures have in common.
    pub family: String,
    /// How many scenes there are: intervals are for as many others.
    pub scenes: usize,
    pub observations: Vec<Observation>,
    /// Nanoseconds of a ray besides its steps and blocks.
    pub ray_ns: Estimate,
    /// Nanoseconds of a node or leaf entered: K_T.
    pub step_ns: Estimate,
    /// Nanoseconds of a block of triangles tested: K_B.
    pub block_ns: Estimate,
    /// K_B over K_T. Nothing where a step costs nothing.
    pub steps_per_block: Option<Estimate>,
    /// Share of the variance of ln time that the prediction explains; below 0 it is worse than one time for all.
    pub r_squared: f64,
    /// How far predictions are off on the scenes that the costs were found on.
    pub known: Option<Off>,
    /// How far they are off on a scene that the costs were not found on.
    pub foreseen: Option<Off>,
}

/// How far predictions are off, as factors of at least 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Off {
    pub median: f64,
    pub worst: f64,
}

impl Off {
    /// Of pairs of a prediction and what was measured; nothing of none.
    fn of(pairs: impl IntoIterator<Item = (f64, f64)>) -> Option<Self> {
        let factors: Vec<f64> = pairs.into_iter().map(|(one, other)| f64::max(one / other, other / one)).collect();
        Some(Self { median: median(&factors)?, worst: factors.iter().copied().fold(1.0, f64::max) })
    }
}

/// What structures have in common that share a node, a leaf and a walk.
fn family(structure: &str) -> &str {
    match structure {
        "median-kd" | "sah-kd" => "binary KD-tree",
        "sah-kd-wide" | "sah-kd-tight" | "sah-hybrid" | "sah-bvh" => "eight-wide tree",
        other => other,
    }
}

/// The costs of every family with observations enough, and of all together. Costs are not below 0. What varies is the
/// scene: all cases of one share its triangles and its luck, so that the intervals are jackknifed over scenes and hold
/// the costs found on as many others.
pub fn result(epochs: &[Epoch]) -> Vec<Family> {
    let mut groups: Vec<(&str, Vec<Observation>)> = vec![("all", vec![])];
    let lines = lines(epochs);
    for line in &lines {
        let (Some(steps), Some(blocks), Some(tests)) = (line.steps, line.blocks, line.tests) else { continue };
        let observation = Observation {
            scene: line.scene.clone(),
            structure: line.structure.clone(),
            workload: line.workload.clone(),
            ns_per_ray: line.ns_per_ray(),
            steps_per_ray: steps,
            blocks_per_ray: blocks,
            tests_per_ray: tests,
            predicted_ns: 0.0,
            foreseen_ns: None,
        };
        groups[0].1.push(observation.clone());
        let own = family(&line.name);
        match groups.iter_mut().find(|(family, _)| *family == own) {
            Some((_, group)) => group.push(observation),
            None => groups.push((own, vec![observation])),
        }
    }
    groups.into_iter().filter_map(|(family, observations)| costs(family, observations)).collect()
}

/// Fewer observations than this say nothing of three costs.
const FEWEST: usize = 6;

/// The scene, whichever mesh it was measured with: a stand-in is built after the real one.
fn scene(observation: &Observation) -> &str {
    observation.scene.split(" (").next().unwrap_or_default()
}

pub(super) fn costs(family: &str, mut observations: Vec<Observation>) -> Option<Family> {
    if observations.len() < FEWEST {
        return None;
    }
    let scenes = each_once(observations.iter().map(|observation| scene(observation).to_owned()));
    let row = |o: &Observation| [o.steps_per_ray, o.blocks_per_ray, o.ns_per_ray];
    let on = |kept: &[usize]| {
        let kept = |o: &&Observation| kept.iter().any(|&i| scenes[i] == scene(o));
        regress(&observations.iter().filter(kept).map(row).collect::<Vec<_>>())
    };
    let all: Vec<usize> = (0..scenes.len()).collect();
    let own = on(&all)?;
    // Without each of the scenes.
    let without: Vec<Option<Costs>> =
        all.iter().map(|&out| on(&all.iter().copied().filter(|&i| i != out).collect::<Vec<_>>())).collect();
    let figure = |of: &dyn Fn(&Costs) -> f64| {
        let of_kept = |kept: &[usize]| match all.iter().find(|i| !kept.contains(i)) {
            None => Some(of(&own)),
            Some(&out) => without[out].as_ref().map(of),
        };
        Some(Rerun::jackknife(scenes.len(), Variance::NONE, of_kept)?.plain().map(|cost| cost.max(0.0)))
    };
    let steps_per_block = |costs: &Costs| costs.block / costs.step;
    // Where steps cost nothing there is no end to the ratio.
    let has_steps = |costs: &Costs| costs.step > 0.0;
    let ratio = has_steps(&own).then(|| {
        if without.iter().flatten().all(has_steps) {
            figure(&steps_per_block)
        } else {
            Some(Estimate::alone(steps_per_block(&own)))
        }
    });
    let figures = [figure(&|costs| costs.ray)?, figure(&|costs| costs.step)?, figure(&|costs| costs.block)?];

    let numbers: Vec<Option<usize>> =
        observations.iter().map(|o| scenes.iter().position(|known| known == scene(o))).collect();
    for (observation, number) in observations.iter_mut().zip(numbers) {
        let of = |costs: &Costs| costs.predict(observation.steps_per_ray, observation.blocks_per_ray);
        let foreseen = number.and_then(|number| without[number].as_ref()).map(of);
        (observation.predicted_ns, observation.foreseen_ns) = (of(&own), foreseen);
    }
    let [ray_ns, step_ns, block_ns] = figures;
    Some(Family {
        family: family.into(),
        scenes: scenes.len(),
        ray_ns,
        step_ns,
        block_ns,
        steps_per_block: ratio.flatten(),
        r_squared: r_squared(&observations),
        known: Off::of(observations.iter().map(|o| (o.predicted_ns, o.ns_per_ray))),
        foreseen: Off::of(observations.iter().filter_map(|o| Some((o.foreseen_ns?, o.ns_per_ray)))),
        observations,
    })
}

/// Of the logarithms of measured and predicted times.
fn r_squared(observations: &[Observation]) -> f64 {
    let logs: Vec<f64> = observations.iter().map(|o| libm::log(o.ns_per_ray)).collect();
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    let square = |x: f64| x * x;
    let all: f64 = logs.iter().map(|log| square(log - mean)).sum();
    let rest: f64 = logs.iter().zip(observations).map(|(log, o)| square(log - libm::log(o.predicted_ns))).sum();
    1.0 - rest / all
}
