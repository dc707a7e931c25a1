//! What came of each scene. Pure functions of what was measured.

use super::design::{CELLS, Factor, TWINS, Treatment};
use super::effects::{self, Weights, value};
use crate::measure::{AaNoise, Estimate, median};
use crate::study::Dataset;
use crate::study::epoch::{Epoch, RayCounts, Structure};
use crate::study::epoch_medians::{epoch_medians, ratio, values};

/// One scene.
pub struct Attribution<'a> {
    /// Each with the trees of the design in their order, then the twins. The first one has counts.
    pub epochs: Vec<(&'a Epoch, Vec<&'a Structure>)>,
    /// Of each epoch the logarithms of the times of its trees.
    medians: Vec<Vec<f64>>,
    /// Of all scenes.
    pub noise: AaNoise,
}

/// How many times less the SAH tree takes than the report's tree, as the product of three parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    pub whole: Estimate,
    parts: [Part; 3],
}

/// What the whole owes to one factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The geometric mean over all orders in which the factors can be switched (Shapley 1953).
    pub times: Estimate,
    /// The least and the most over those orders; they differ by the interactions.
    pub least: f64,
    pub most: f64,
}

/// One result for each scene. A scene without its first epoch has none; an epoch without all trees is passed over.
pub fn results(dataset: &Dataset) -> Vec<Attribution<'_>> {
    let scenes = dataset.scenes();
    let mut results: Vec<Attribution> = scenes.iter().filter_map(|scene| Attribution::new(&scene.epochs)).collect();
    let noise = AaNoise::new(&results.iter().flat_map(Attribution::twins).collect::<Vec<_>>());
    results.iter_mut().for_each(|result| result.noise = noise.clone());
    results
}

/// The trees of the design and the twins. Nothing where one is not there or has no time.
fn trees(epoch: &Epoch) -> Option<Vec<&Structure>> {
    let tree = |cell: Treatment| epoch.in_role(&cell.role());
    let twin = |cell| {
        let label = &tree(cell)?.label;
        epoch.structures.iter().find(|other| other.is_twin() && other.label == *label)
    };
    let is_timed = |tree: &&Structure| tree.rays.first().is_some_and(|rays| !rays.ns.is_empty() && rays.rays > 0);
    let cells = Treatment::all().into_iter().map(tree);
    cells.chain(TWINS.map(twin)).map(|tree| tree.filter(is_timed)).collect()
}

/// Nanoseconds a ray in every sample, on the rays that all trees are timed on.
fn paces(epoch: &Epoch, tree: &Structure) -> Vec<f64> {
    tree.rays[0].paces(epoch.common_rays(&tree.rays[0].workload))
}

impl<'a> Attribution<'a> {
    fn new(epochs: &[&'a Epoch]) -> Option<Self> {
        let epochs: Vec<_> = epochs.iter().filter_map(|epoch| Some((*epoch, trees(epoch)?))).collect();
        let is_counted = epochs.first()?.1.iter().all(|tree| tree.rays[0].counts.is_some());
        let logs = |epoch: &Epoch, tree: &Structure| paces(epoch, tree).into_iter().map(libm::log).collect();
        let of_epoch =
            |(epoch, trees): &(&Epoch, Vec<&Structure>)| trees.iter().map(|tree| logs(epoch, tree)).collect();
        let medians = epoch_medians(epochs.iter().map(of_epoch).collect());
        is_counted.then(|| Self { epochs, medians, noise: AaNoise::default() })
    }

    /// Cells of the A/A noise.
    fn twins(&self) -> [Vec<Vec<f64>>; 2] {
        let log = |i: usize| values(&self.medians, |logs| logs[TWINS[i].number()] - logs[CELLS + i]);
        [0, 1].map(|i| log(i).into_iter().map(|log| vec![log]).collect())
    }

    pub fn first(&self) -> &'a Epoch {
        self.epochs[0].0
    }

    /// That of the tree in the first epoch.
    pub fn tree(&self, cell: Treatment) -> &'a Structure {
        self.epochs[0].1[cell.number()]
    }

    pub fn counts(&self, cell: Treatment) -> RayCounts {
        self.tree(cell).rays[0].counts.unwrap_or_default()
    }

    pub fn workload(&self) -> &'a str {
        &self.tree(Treatment::REPORT).rays[0].workload
    }

    /// Nanoseconds a ray, the median over all samples.
    pub fn ns_per_ray(&self, cell: Treatment) -> f64 {
        let of_epoch = |(epoch, trees): &(&Epoch, Vec<&Structure>)| paces(epoch, trees[cell.number()]);
        median(&self.epochs.iter().flat_map(of_epoch).collect::<Vec<_>>()).expect("every tree is timed")
    }

    /// How many times less time is taken.
    pub fn speedup(&self, weights: &Weights) -> Estimate {
        ratio(&self.medians, |logs| value(weights, logs), self.noise.weighted(weights))
    }

    /// How many times faster the exact SAH plane is than the report's, where both stop at eight triangles, as far as
    /// planes divide them, and have plane intervals.
    pub fn plane_alone(&self) -> Estimate {
        self.speedup(&effects::gain(Treatment([0, 1, 1]), Treatment([5, 1, 1])))
    }

    /// The split of the speedup.
    pub fn time(&self) -> Split {
        Split::new(|weights| self.speedup(weights))
    }

    /// Likewise of what is counted for each ray.
    pub fn counted(&self, count: fn(&RayCounts) -> Option<f64>) -> Split {
        let log = |cell| {
            let counts = self.counts(cell);
            // Nothing done counts as one in all, so that there is a logarithm.
            libm::log(count(&counts).unwrap_or(0.0).max(1.0 / counts.rays as f64))
        };
        let logs: Vec<f64> = Treatment::all().into_iter().map(log).collect();
        Split::new(|weights| Estimate::exact(libm::exp(value(weights, &logs))))
    }
}

impl Split {
    fn new(of: impl Fn(&Weights) -> Estimate) -> Self {
        let part = |factor: Factor| {
            let orders: Vec<f64> = effects::parts_by_order(factor).iter().map(|order| of(order).estimate).collect();
            Part {
                times: of(&effects::part(factor)),
                least: orders.iter().copied().fold(f64::INFINITY, f64::min),
                most: orders.iter().copied().fold(0.0, f64::max),
            }
        };
        Self { whole: of(&effects::gain(Treatment::REPORT, Treatment::SAH)), parts: Factor::ALL.map(part) }
    }

    pub fn part(&self, factor: Factor) -> Part {
        self.parts[factor as usize]
    }
}
