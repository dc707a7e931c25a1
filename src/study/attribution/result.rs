//! What came of each scene. Pure functions of what was measured.

use super::design::{CELLS, Factor, TWINS, Treatment, trees};
use crate::measure::{AaNoise, Estimate, median};
use crate::study::epoch_medians::{epoch_medians, ratio, values};
use crate::study::measurement::{Measurement, of_scene};
use crate::study::{Dataset, Epoch, SceneEpochs};

pub struct Attribution<'a> {
    /// Each has the [`trees`] of the design.
    pub epochs: Vec<&'a Epoch>,
    /// Of each cell, in their order.
    pub trees: Vec<Measurement>,
    /// Of each epoch the logarithms of the times of its trees.
    medians: Vec<Vec<f64>>,
    /// Of all scenes.
    pub noise: AaNoise,
}

/// One result for each scene with the trees of the design.
pub fn results(dataset: &Dataset) -> Vec<Attribution<'_>> {
    let roles: Vec<String> = trees().map(|(_, role)| role).collect();
    let is_designed = |epoch: &&Epoch| epoch.structures.iter().map(|own| &own.role).eq(&roles);
    let scenes = dataset.scenes().into_iter().filter(|scene| scene.epochs.iter().all(is_designed));
    let mut results: Vec<Attribution> = scenes.map(Attribution::new).collect();
    let noise = AaNoise::new(&results.iter().flat_map(Attribution::twins).collect::<Vec<_>>());
    results.iter_mut().for_each(|result| result.noise = noise.clone());
    results
}

/// Nanoseconds a ray in every sample of a tree, on the rays that all trees are timed on.
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

    /// Cells of the A/A noise.
    fn twins(&self) -> [Vec<Vec<f64>>; 2] {
        let log = |i: usize| values(&self.medians, |logs| logs[TWINS[i].number()] - logs[CELLS + i]);
        [0, 1].map(|i| log(i).into_iter().map(|log| vec![log]).collect())
    }

    /// That of the report's tree: what all trees of the scene share.
    pub fn first(&self) -> &Measurement {
        &self.trees[0]
    }

    /// The median over all samples.
    pub fn ns_per_ray(&self, cell: Treatment) -> f64 {
        let paces = self.epochs.iter().flat_map(|epoch| paces(epoch, cell.number()));
        median(&paces.collect::<Vec<_>>()).expect("every tree is timed")
    }

    /// How many times less time is taken.
    pub fn speedup(&self, weights: &Weights) -> Estimate {
        let sum = |logs: &[f64]| weights.iter().zip(logs).map(|(weight, log)| weight * log).sum();
        ratio(&self.medians, sum, self.noise.weighted(weights))
    }

    /// How many times less the SAH tree takes than the report's tree.
    pub fn whole(&self) -> Estimate {
        self.speedup(&gain(Treatment::REPORT, Treatment::SAH))
    }

    /// What the whole owes to `factor`; the three parts multiply to it.
    pub fn part(&self, factor: Factor) -> Estimate {
        self.speedup(&part(factor))
    }

    /// The least and the most that `factor` gives, over the orders of switching; they differ by the interactions.
    pub fn range(&self, factor: Factor) -> [f64; 2] {
        let orders = parts_by_order(factor).map(|order| self.speedup(&order).estimate);
        [orders.iter().copied().fold(f64::INFINITY, f64::min), orders.iter().copied().fold(0.0, f64::max)]
    }

    /// How many times faster the exact SAH plane is than the report's, where both stop at eight triangles, as far as
    /// planes divide them, and have plane intervals.
    pub fn plane_alone(&self) -> Estimate {
        self.speedup(&gain(Treatment([0, 1, 1]), Treatment([5, 1, 1])))
    }
}

/// One weight for each cell.
type Weights = [f64; CELLS];

/// How much less `to` takes than `from`.
pub fn gain(from: Treatment, to: Treatment) -> Weights {
    let mut weights = [0.0; CELLS];
    weights[from.number()] += 1.0;
    weights[to.number()] -= 1.0;
    weights
}

/// What the whole step from the report's tree to the SAH tree owes to `factor`: its gain, averaged over all orders in
/// which the three factors can be switched (Shapley, "A value for n-person games", 1953). The three parts add up to the
/// whole.
fn part(factor: Factor) -> Weights {
    let mut sum = [0.0; CELLS];
    for gain in parts_by_order(factor) {
        sum.iter_mut().zip(gain).for_each(|(sum, weight)| *sum += weight / ORDERS.len() as f64);
    }
    sum
}

/// The gain of `factor` in every order of switching.
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

const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
