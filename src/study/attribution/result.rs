//! The result of each scene, computed from the measurements.

use super::design::{CELLS, Factor, TWINS, Treatment, trees};
use crate::measure::{AaNoise, Estimate, median};
use crate::study::epoch_medians::{epoch_medians, ratio, values};
use crate::study::measurement::{Measurement, of_scene};
use crate::study::{Dataset, Epoch, SceneEpochs};

pub struct Attribution<'a> {
    pub epochs: Vec<&'a Epoch>,
    /// One measurement per cell, in the order of [`Treatment::number`].
    pub trees: Vec<Measurement>,
    /// Median log time by epoch and tree, including twins.
    medians: Vec<Vec<f64>>,
    /// The A/A noise of all scenes together.
    pub noise: AaNoise,
}

/// A scene is omitted if its structures do not match [`trees`].
pub fn results(dataset: &Dataset) -> Vec<Attribution<'_>> {
    let roles: Vec<String> = trees().map(|(_, role)| role).collect();
    let is_designed = |epoch: &&Epoch| epoch.structures.iter().map(|own| &own.role).eq(&roles);
    let scenes = dataset.scenes().into_iter().filter(|scene| scene.epochs.iter().all(is_designed));
    let mut results: Vec<Attribution> = scenes.map(Attribution::new).collect();
    let noise = AaNoise::new(&results.iter().flat_map(Attribution::twins).collect::<Vec<_>>());
    results.iter_mut().for_each(|result| result.noise = noise.clone());
    results
}

/// Nanoseconds per ray of each sample, on the common rays of all trees.
fn paces(epoch: &Epoch, tree: usize) -> Vec<f64> {
    let rays = &epoch.structures[tree].rays[0];
    rays.ns_per_ray(epoch.common_rays(&rays.workload))
}

impl<'a> Attribution<'a> {
    fn new(scene: SceneEpochs<'a>) -> Self {
        let logs = |epoch: &Epoch, tree| paces(epoch, tree).into_iter().map(libm::log).collect();
        let of_epoch = |epoch: &&Epoch| (0..CELLS + TWINS.len()).map(|tree| logs(epoch, tree)).collect();
        let medians = epoch_medians(scene.epochs.iter().map(of_epoch).collect());
        Self { trees: of_scene(&scene), epochs: scene.epochs, medians, noise: AaNoise::default() }
    }

    /// ln(time of the first build / time of the twin) for each twin and epoch.
    fn twins(&self) -> [Vec<Vec<f64>>; 2] {
        let log = |i: usize| values(&self.medians, |logs| logs[TWINS[i].number()] - logs[CELLS + i]);
        [0, 1].map(|i| log(i).into_iter().map(|log| vec![log]).collect())
    }

    /// The measurement of [`Treatment::REPORT`]. All trees have the same scene and workload.
    pub fn first(&self) -> &Measurement {
        &self.trees[0]
    }

    /// The median over all samples.
    pub fn ns_per_ray(&self, cell: Treatment) -> f64 {
        let paces = self.epochs.iter().flat_map(|epoch| paces(epoch, cell.number()));
        median(&paces.collect::<Vec<_>>()).expect("every tree is timed")
    }

    /// Returns exp(sum of weight * ln(time)) with an interval.
    pub fn speedup(&self, weights: &Weights) -> Estimate {
        let sum = |logs: &[f64]| weights.iter().zip(logs).map(|(weight, log)| weight * log).sum();
        ratio(&self.medians, sum, self.noise.weighted(weights))
    }

    /// Time of [`Treatment::REPORT`] / time of [`Treatment::SAH`].
    pub fn whole(&self) -> Estimate {
        self.speedup(&gain(Treatment::REPORT, Treatment::SAH))
    }

    /// The speedup that `factor` contributes. The product of the three contributions is the whole speedup.
    pub fn part(&self, factor: Factor) -> Estimate {
        self.speedup(&part(factor))
    }

    /// The smallest and the largest gain of `factor` over all `ORDERS`.
    pub fn range(&self, factor: Factor) -> [f64; 2] {
        let orders = parts_by_order(factor).map(|order| self.speedup(&order).estimate);
        [orders.iter().copied().fold(f64::INFINITY, f64::min), orders.iter().copied().fold(0.0, f64::max)]
    }

    /// Speedup of the plane `SAH exact` over the plane `vertex median cyclic`, with `leaf 8` and `plane intervals`.
    pub fn plane_alone(&self) -> Estimate {
        self.speedup(&gain(Treatment([0, 1, 1]), Treatment([5, 1, 1])))
    }
}

type Weights = [f64; CELLS];

/// The weights of ln(time of `from` / time of `to`).
pub fn gain(from: Treatment, to: Treatment) -> Weights {
    let mut weights = [0.0; CELLS];
    weights[from.number()] += 1.0;
    weights[to.number()] -= 1.0;
    weights
}

/// The weights of the Shapley value: the mean gain of `factor` over all `ORDERS`.
///
/// # References
/// Shapley: A value for n-person games. In: Contributions to the Theory of Games II, 1953.
fn part(factor: Factor) -> Weights {
    let gains = parts_by_order(factor);
    std::array::from_fn(|cell| gains.iter().map(|gain| gain[cell] / ORDERS.len() as f64).sum())
}

fn parts_by_order(factor: Factor) -> [Weights; 6] {
    ORDERS.map(|order| {
        let before = order.into_iter().take_while(|&other| other != factor as usize);
        let mut from = Treatment::REPORT;
        before.for_each(|other| from.0[other] = Treatment::SAH.0[other]);
        let mut to = from;
        to.0[factor as usize] = Treatment::SAH.0[factor as usize];
        gain(from, to)
    })
}

/// All orders in which the three factors can change from `REPORT` to `SAH`.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
