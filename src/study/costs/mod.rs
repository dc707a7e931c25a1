//! `costs`: what does a step, and what does a triangle test cost on this machine?
//!
//! The time of a ray is taken for a constant, a cost for each node or leaf entered and one for each triangle tested, and these are
//! found by regression over many cases: the performance model of Havran and Purgathofer (2003), which the surface area heuristic
//! builds on.

mod regression;
mod table;
#[cfg(test)]
mod tests;

use serde::Serialize;

use super::epoch::{Draws, Epoch, lines};
use super::fit;
use crate::measure::{Interval, geometric_mean};
use regression::{Costs, regress};

pub use table::{LEGEND, tables};

/// Name of the study, and of its journal; a case is an [`Epoch`].
pub const NAME: &str = "costs";

/// The structures compared unless others are named: of every family several, whose steps and tests are in different proportion.
pub const STRUCTURES: [&str; 14] = [
    "brute-force",
    "median-kd",
    "median-kd:leaf=20",
    "median-kd:leaf=300",
    "sah-kd",
    "sah-kd:intersection_cost=0.2",
    "sah-kd:intersection_cost=3",
    "sah-kd-wide",
    "sah-hybrid",
    "sah-bvh",
    "sah-bvh:block_cost=0.3",
    "sah-bvh:block_cost=4",
    "obvhs-bvh2",
    "obvhs-cwbvh",
];

/// A structure on one kind of rays of one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Observation {
    pub scene: String,
    /// As chosen.
    pub structure: String,
    pub workload: String,
    pub ns_per_ray: f64,
    pub steps_per_ray: f64,
    pub tests_per_ray: f64,
    /// What the costs of its family make of the counts.
    pub predicted_ns: f64,
}

/// The costs of one family of structures, or of all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Family {
    /// `all`, or what the structures have in common.
    pub family: String,
    pub observations: Vec<Observation>,
    /// Nanoseconds of a ray besides its steps and tests.
    pub ray_ns: Interval,
    /// Nanoseconds of a node or leaf entered: K_T.
    pub step_ns: Interval,
    /// Nanoseconds of a triangle test: K_I.
    pub test_ns: Interval,
    /// K_T over K_I. Nothing where a test costs nothing.
    pub steps_per_test: Option<Interval>,
    /// Share of the variance of ln time that the prediction explains; below 0 it is worse than one time for all.
    pub r_squared: f64,
    /// Geometric mean of how far predictions are off, as a factor of at least 1.
    pub typical_factor: f64,
    /// The farthest that a prediction is off, as a factor of at least 1.
    pub worst_factor: f64,
}

/// What structures have in common that share a node, a leaf and a walk.
fn family(structure: &str) -> &str {
    match structure {
        "median-kd" | "sah-kd" => "binary KD-tree",
        "sah-kd-wide" | "sah-kd-tight" | "sah-hybrid" | "sah-bvh" => "eight-wide tree",
        other => other,
    }
}

/// The costs of every family with observations enough, and of all together. Costs are not below 0. The intervals come from drawing
/// observations with replacement: they say how much the costs depend on which cases were looked at.
pub fn result(epochs: &[Epoch], seed: u64) -> Vec<Family> {
    let mut groups: Vec<(&str, Vec<Observation>)> = vec![("all", vec![])];
    let lines = lines(epochs);
    for line in &lines {
        let (Some(steps), Some(tests)) = (line.steps, line.tests) else { continue };
        let observation = Observation {
            scene: line.scene.clone(),
            structure: line.structure.clone(),
            workload: line.workload.clone(),
            ns_per_ray: line.ns_per_ray(),
            steps_per_ray: steps,
            tests_per_ray: tests,
            predicted_ns: 0.0,
        };
        groups[0].1.push(observation.clone());
        let own = family(&line.name);
        match groups.iter_mut().find(|(family, _)| *family == own) {
            Some((_, group)) => group.push(observation),
            None => groups.push((own, vec![observation])),
        }
    }
    groups.into_iter().filter_map(|(family, observations)| costs(family, observations, seed)).collect()
}

/// Fewer observations than this say nothing of three costs.
const FEWEST: usize = 6;

fn costs(family: &str, mut observations: Vec<Observation>, seed: u64) -> Option<Family> {
    if observations.len() < FEWEST {
        return None;
    }
    let rows: Vec<[f64; 3]> = observations.iter().map(|o| [o.steps_per_ray, o.tests_per_ray, o.ns_per_ray]).collect();
    let own = regress(&rows)?;
    let mut draws = Draws::new(seed);
    let drawn: Vec<Costs> = (0..fit::DRAWS)
        .filter_map(|_| regress(&(0..rows.len()).map(|_| rows[draws.below(rows.len())]).collect::<Vec<_>>()))
        .collect();
    let interval = |of: &dyn Fn(&Costs) -> f64| fit::percentiles(of(&own), drawn.iter().map(of).collect());
    let ratio = |costs: &Costs| costs.step / costs.test;
    // Where tests cost nothing in some draws there is no end to the ratio.
    let ratios = (own.test > 0.0 && drawn.iter().all(|costs| costs.test > 0.0)).then(|| interval(&ratio)).flatten();

    for observation in &mut observations {
        observation.predicted_ns = own.predict(observation.steps_per_ray, observation.tests_per_ray);
    }
    let factors: Vec<f64> =
        observations
            .iter()
            .map(|o| {
                if o.predicted_ns > o.ns_per_ray {
                    o.predicted_ns / o.ns_per_ray
                } else {
                    o.ns_per_ray / o.predicted_ns
                }
            })
            .collect();
    Some(Family {
        family: family.into(),
        ray_ns: interval(&|costs| costs.ray)?,
        step_ns: interval(&|costs| costs.step)?,
        test_ns: interval(&|costs| costs.test)?,
        steps_per_test: ratios,
        r_squared: r_squared(&observations),
        typical_factor: geometric_mean(&factors)?,
        worst_factor: factors.iter().copied().fold(1.0, f64::max),
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

/// One observation, for tables that machines read.
#[derive(Clone, Debug, Serialize)]
pub struct Row<'a> {
    pub family: &'a str,
    #[serde(flatten)]
    pub observation: &'a Observation,
}

/// All observations of all families.
pub fn rows(families: &[Family]) -> Vec<Row<'_>> {
    let mut rows = vec![];
    for Family { family, observations, .. } in families {
        rows.extend(observations.iter().map(|observation| Row { family, observation }));
    }
    rows
}
