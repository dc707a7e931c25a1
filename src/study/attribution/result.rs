//! From the journal to the answer. Pure functions.

use serde::Serialize;

use super::design::{CELLS, Factor, Treatment};
use super::effects::{self, TERMS, Weights, value};
use crate::measure::{AaNoise, Estimate, Rerun, median};
use crate::study::epoch::{Epoch, RayCounts, Structure};
use crate::study::epoch_medians::{epoch_medians, ratio, values};
use crate::study::grouped::grouped;

/// What came of one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Attribution {
    /// Name of the scene, with `(stand-in)` where a mesh of our own stands in for the real one.
    pub scene: String,
    pub triangles: usize,
    pub stand_in: bool,
    pub workload: String,
    /// Epochs and samples in each.
    pub epochs: usize,
    pub runs: usize,
    /// The [A/A noise](AaNoise) of all scenes, as a factor; 1 is none.
    pub aa_noise: f64,
    /// One for each cell of the design, in order.
    pub cells: Vec<CellResult>,
    /// One for each level of each factor.
    pub main_effects: Vec<Effect>,
    /// One for each term of the decomposition.
    pub terms: Vec<Term>,
    /// From the report's tree to the SAH tree: time.
    pub time: Split,
    /// The same: triangle tests.
    pub tests: Split,
    /// The same: nodes entered.
    pub steps: Split,
    /// How many times faster the exact SAH plane is than the report's, where both stop at eight triangles, as far as
    /// planes divide them, and have plane intervals.
    pub plane_alone: Estimate,
}

/// One tree.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CellResult {
    pub plane: &'static str,
    pub stop: &'static str,
    pub traversal: &'static str,
    /// Median over all samples, nanoseconds.
    pub ns_per_ray: f64,
    /// How many times faster than the report's tree.
    pub speedup: Estimate,
    pub tests_per_ray: f64,
    pub steps_per_ray: f64,
    /// References for each triangle.
    pub duplication: f64,
    pub depth: usize,
    pub bytes: usize,
    /// As [`TreeShape::sah_cost`](crate::accel::TreeShape::sah_cost).
    pub sah_cost: Option<f64>,
    /// Median over the epochs, nanoseconds.
    pub build_ns: f64,
    /// Whether a part of the rays was timed.
    pub sampled: bool,
}

/// What a level of a factor does: its mean as a multiple of the mean of all cells, geometric means.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effect {
    pub factor: &'static str,
    pub level: &'static str,
    pub time: Estimate,
    pub tests: f64,
    pub steps: f64,
}

/// A factor, or an interaction of factors: its share of the variance of the logarithms over the cells.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Term {
    pub term: String,
    pub time: Estimate,
    pub tests: f64,
    pub steps: f64,
}

/// A whole as the product of three parts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Split {
    /// How many times less the SAH tree takes.
    pub whole: Estimate,
    /// In the order of [`Factor::ALL`].
    pub parts: Vec<Part>,
}

/// What a whole owes to one factor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    pub factor: &'static str,
    /// The geometric mean over all orders in which the factors can be switched (Shapley 1953).
    pub times: Estimate,
    /// The least and the most over those orders; they differ by the interactions.
    pub least: f64,
    pub most: f64,
}

/// One tree of one scene: a row of a tidy table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row<'a> {
    pub scene: &'a str,
    pub triangles: usize,
    pub stand_in: bool,
    pub workload: &'a str,
    pub tree: &'a CellResult,
}

/// All trees of all scenes.
pub fn rows(results: &[Attribution]) -> Vec<Row<'_>> {
    fn of(r: &Attribution) -> Vec<Row<'_>> {
        let Attribution { scene, triangles, stand_in, workload, cells, .. } = r;
        cells.iter().map(|tree| Row { scene, triangles: *triangles, stand_in: *stand_in, workload, tree }).collect()
    }
    results.iter().flat_map(of).collect()
}

/// One result for each scene, in the order in which the scenes were begun. A scene whose first epoch is missing has
/// none.
pub fn result(epochs: &[Epoch]) -> Vec<Attribution> {
    let name = |epoch: &Epoch| (epoch.scene.clone(), epoch.stand_in, epoch.scene_hash.clone());
    // An epoch that does not hold all cells and twins, timed, is passed over.
    let whole = epochs.iter().filter(|epoch| is_whole(epoch));
    let scenes = grouped(whole, |a, b| name(a) == name(b));
    let scenes: Vec<_> = scenes.into_iter().map(|scene| (logs(&scene), scene)).collect();
    let twins: Vec<Vec<Vec<f64>>> = scenes.iter().flat_map(|(logs, _)| twins(logs)).collect();
    let noise = AaNoise::new(&twins);
    scenes.iter().filter_map(|(logs, epochs)| attribute(epochs, logs, &noise)).collect()
}

fn is_whole(epoch: &Epoch) -> bool {
    let timed = |tree: &Structure| tree.rays.first().is_some_and(|rays| !rays.ns.is_empty() && rays.rays > 0);
    epoch.structures.len() == CELLS + 2 && epoch.structures.iter().all(timed)
}

fn paces(epoch: &Epoch, tree: &Structure) -> Vec<f64> {
    tree.rays[0].paces(epoch.common_rays(&tree.rays[0].workload))
}

fn logs(epochs: &[&Epoch]) -> Vec<Vec<f64>> {
    let logs = |epoch: &Epoch, tree: &Structure| paces(epoch, tree).into_iter().map(libm::log).collect::<Vec<f64>>();
    let of_epoch = |epoch: &&Epoch| epoch.structures.iter().map(|tree| logs(epoch, tree)).collect();
    epoch_medians(epochs.iter().map(of_epoch).collect())
}

fn twins(logs: &[Vec<f64>]) -> [Vec<Vec<f64>>; 2] {
    let twin = |cell: Treatment, twin: usize| values(logs, |logs| logs[cell.number()] - logs[CELLS + twin]);
    [twin(Treatment::REPORT, 0), twin(Treatment::SAH, 1)].map(|logs| logs.into_iter().map(|log| vec![log]).collect())
}

fn counts(structure: &Structure) -> Option<RayCounts> {
    structure.rays.first()?.counts
}

fn attribute(epochs: &[&Epoch], epoch_medians: &[Vec<f64>], noise: &AaNoise) -> Option<Attribution> {
    let first = *epochs.iter().find(|epoch| epoch.structures.iter().all(|tree| counts(tree).is_some()))?;
    let counts: Vec<RayCounts> = first.structures.iter().filter_map(counts).collect();
    let interval = |weights: &Weights| ratio(epoch_medians, |logs| value(weights, logs), noise.weighted(weights));
    let log_counts = |of: fn(&RayCounts) -> Option<f64>| -> Vec<f64> {
        // Nothing done counts as one in all, so that there is a logarithm.
        counts[..CELLS].iter().map(|c| libm::log(of(c).unwrap_or(0.0).max(1.0 / c.rays as f64))).collect()
    };
    let (tests, steps) = (log_counts(RayCounts::tests_per_ray), log_counts(RayCounts::steps_per_ray));

    let cells = Treatment::all().into_iter().enumerate().map(|(i, cell)| {
        let trees = || epochs.iter().map(|epoch| &epoch.structures[i]);
        let ns: Vec<f64> = epochs.iter().flat_map(|epoch| paces(epoch, &epoch.structures[i])).collect();
        let builds: Vec<f64> = trees().map(|tree| tree.build_ns as f64).collect();
        let [plane, stop, traversal] = Factor::ALL.map(|factor| factor.levels()[cell.level(factor)].name);
        let Structure { shape, rays, .. } = &first.structures[i];
        CellResult {
            plane,
            stop,
            traversal,
            ns_per_ray: median(&ns).expect("there is a sample"),
            speedup: interval(&effects::gain(Treatment::REPORT, cell)),
            tests_per_ray: counts[i].tests_per_ray().unwrap_or(0.0),
            steps_per_ray: counts[i].steps_per_ray().unwrap_or(0.0),
            duplication: shape.references as f64 / first.triangles.max(1) as f64,
            depth: shape.depth,
            bytes: shape.bytes,
            sah_cost: shape.sah_cost,
            build_ns: median(&builds).expect("there is an epoch"),
            sampled: first.common_rays(&rays[0].workload) < rays[0].all,
        }
    });
    let levels =
        Factor::ALL.into_iter().flat_map(|factor| (0..factor.levels().len()).map(move |level| (factor, level)));
    let main_effects = levels.map(|(factor, level)| {
        let weights = effects::main_effect(factor, level);
        let of = |logs: &[f64]| libm::exp(value(&weights, logs));
        let time = interval(&weights);
        let (factor, level) = (factor.name(), factor.levels()[level].name);
        Effect { factor, level, time, tests: of(&tests), steps: of(&steps) }
    });
    Some(Attribution {
        scene: first.title(),
        triangles: first.triangles,
        stand_in: first.stand_in,
        workload: first.structures[0].rays[0].workload.clone(),
        epochs: epochs.len(),
        runs: first.structures[0].rays[0].ns.len(),
        aa_noise: libm::exp(noise.log().unwrap_or(0.0)),
        cells: cells.collect(),
        main_effects: main_effects.collect(),
        terms: terms(epoch_medians, &tests, &steps, noise),
        time: split(interval, &mean_of(epoch_medians)),
        tests: split(|weights| exact(weights, &tests), &tests),
        steps: split(|weights| exact(weights, &steps), &steps),
        plane_alone: interval(&effects::gain(Treatment([0, 1, 1]), Treatment([5, 1, 1]))),
    })
}

fn mean_of(epoch_medians: &[Vec<f64>]) -> Vec<f64> {
    let n = epoch_medians.len() as f64;
    (0..CELLS).map(|i| epoch_medians.iter().map(|logs| logs[i]).sum::<f64>() / n).collect()
}

fn exact(weights: &Weights, logs: &[f64]) -> Estimate {
    Estimate::exact(libm::exp(value(weights, logs)))
}

fn split(interval: impl Fn(&Weights) -> Estimate, logs: &[f64]) -> Split {
    let part = |factor: Factor| {
        let orders = effects::parts_by_order(factor);
        let orders = orders.iter().map(|weights| libm::exp(value(weights, logs)));
        Part {
            factor: factor.name(),
            times: interval(&effects::part(factor)),
            least: orders.clone().fold(f64::INFINITY, f64::min),
            most: orders.fold(0.0, f64::max),
        }
    };
    Split { whole: interval(&effects::gain(Treatment::REPORT, Treatment::SAH)), parts: Factor::ALL.map(part).into() }
}

/// Shares of the variance: of the mean over the epochs, jackknifed.
pub(super) fn terms(epoch_medians: &[Vec<f64>], tests: &[f64], steps: &[f64], noise: &AaNoise) -> Vec<Term> {
    let none = [0.0; TERMS.len()];
    let of = |logs: &[f64]| effects::shares(logs).unwrap_or(none);
    let (tests, steps) = (of(tests), of(steps));
    let mean = |kept: &[usize]| mean_of(&kept.iter().map(|&e| epoch_medians[e].clone()).collect::<Vec<_>>());
    let own = mean_of(epoch_medians);
    let term = |i: usize| {
        let noise = noise.of_figure(&own, |logs| Some(of(logs)[i]));
        let share = Rerun::jackknife(epoch_medians.len(), noise, |kept| Some(of(&mean(kept))[i]));
        // A share is no less than nothing and no more than all.
        let time = share.expect("there is an epoch").plain().map(|share| share.clamp(0.0, 1.0));
        Term { term: effects::term_name(TERMS[i]), time, tests: tests[i], steps: steps[i] }
    };
    (0..TERMS.len()).map(term).collect()
}
