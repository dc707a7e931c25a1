//! The ratio of two structures along the family, and where it crosses 1.

use serde::Serialize;

use crate::measure::{AaNoise, Estimate, Rerun};
use crate::study::least_squares;

/// A place where one overtakes the other.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Crossing {
    /// Depth complexity, between two members on a line between logarithms. Without an interval where the crossing is
    /// not sure: nowhere between it and its neighbours is the one or the other surely ahead.
    pub complexity: Estimate,
    /// Whether the KD-tree is the faster one beyond.
    pub kd_wins_beyond: bool,
}

impl Crossing {
    /// Whether one of the two is surely ahead before it and the other beyond, all members considered.
    pub fn is_sure(&self) -> bool {
        self.complexity.interval.is_some()
    }
}

pub(super) struct Curve<'a> {
    depths: Vec<f64>,
    /// Of each depth, of each epoch.
    ratios: Vec<Vec<f64>>,
    noise: &'a AaNoise,
}

impl<'a> Curve<'a> {
    /// Of points by growing depth, each with the ratio in every epoch: only epochs that all points have count.
    pub fn new(points: Vec<(f64, Vec<f64>)>, noise: &'a AaNoise) -> Self {
        let epochs = points.iter().map(|(_, ratios)| ratios.len()).min().unwrap_or(0);
        let (depths, ratios) = points.into_iter().map(|(depth, ratios)| (depth, ratios[..epochs].to_vec())).unzip();
        Self { depths, ratios, noise }
    }

    /// A sum of the ratios with these weights, of which each epoch has a value.
    fn sum(&self, weights: &[f64]) -> Option<Rerun> {
        let epochs = self.ratios.first()?.len();
        let value = |e: usize| weights.iter().zip(&self.ratios).map(|(weight, ratios)| weight * ratios[e]).sum();
        // A ratio is of two builds.
        let builds: Vec<f64> = weights.iter().flat_map(|&weight| [weight, -weight]).collect();
        Rerun::of(&(0..epochs).map(value).collect::<Vec<f64>>(), self.noise.weighted(&builds))
    }

    /// The ratio at any depth of the family, on a line between its neighbours.
    fn at(&self, depth: f64) -> Option<Estimate> {
        let after = self.depths.iter().position(|&other| other >= depth)?.max(1);
        let (low, high) = (self.depths[after - 1], *self.depths.get(after)?);
        let share = (depth - low) / (high - low);
        let mut weights = vec![0.0; self.depths.len()];
        (weights[after - 1], weights[after]) = (1.0 - share, share);
        Some(self.sum(&weights)?.plain())
    }

    /// Where the line through the estimates crosses 0, each with whether it falls.
    fn zeros(&self) -> Vec<(f64, bool)> {
        let mean = |ratios: &Vec<f64>| ratios.iter().sum::<f64>() / ratios.len() as f64;
        let ratios: Vec<f64> = self.ratios.iter().map(mean).collect();
        let mut zeros = vec![];
        for i in 1..self.depths.len() {
            let (before, after) = (ratios[i - 1], ratios[i]);
            if (before > 0.0) != (after > 0.0) {
                let share = before / (before - after);
                zeros.push((self.depths[i - 1] + (self.depths[i] - self.depths[i - 1]) * share, before > 0.0));
            }
        }
        zeros
    }

    /// All crossings. Another run may find one at the depths about it where the ratio may be 1 in it.
    pub fn crossings(&self) -> Vec<Crossing> {
        let zeros = self.zeros();
        let crossing = |(i, &(at, falls)): (usize, &(f64, bool))| {
            let from = if i == 0 { self.depths[0] } else { zeros[i - 1].0 };
            let to = zeros.get(i + 1).map_or(self.depths[self.depths.len() - 1], |next| next.0);
            let ends = self.end(at, from).zip(self.end(at, to));
            let complexity = match ends.filter(|_| self.is_sure(at, from) && self.is_sure(at, to)) {
                Some((low, high)) => Estimate::between(at, low, high),
                None => Estimate::alone(at),
            };
            Crossing { complexity: complexity.map(libm::exp), kd_wins_beyond: falls }
        };
        zeros.iter().enumerate().map(crossing).collect()
    }

    /// Places between a crossing and its neighbour that are looked at.
    fn places(at: f64, to: f64) -> impl Iterator<Item = f64> {
        const STEPS: u32 = 64;
        (1..=STEPS).map(move |i| at + (to - at) * f64::from(i) / f64::from(STEPS))
    }

    /// Whether somewhere between the two one is surely ahead, as one of all members that are looked at.
    fn is_sure(&self, at: f64, to: f64) -> bool {
        let looks = self.depths.len();
        Self::places(at, to).any(|x| self.at(x).is_some_and(|y| y.interval.is_some() && !y.among(looks).holds(0.0)))
    }

    /// The first place on the way from the crossing at which the ratio cannot be 1.
    fn end(&self, at: f64, to: f64) -> Option<f64> {
        let outside = |x: f64| self.at(x).is_some_and(|ratio| ratio.interval.is_some() && !ratio.holds(0.0));
        let mut out = Self::places(at, to).find(|&x| outside(x))?;
        let mut inside = at;
        for _ in 0..40 {
            let middle = 0.5 * (inside + out);
            if outside(middle) { out = middle } else { inside = middle }
        }
        Some(out)
    }

    /// The slope of the ratio over the depth, both as logarithms. Nothing of fewer than three points.
    pub fn trend(&self) -> Option<Estimate> {
        let weights = least_squares::slope_weights(&self.depths).filter(|weights| weights.len() > 2)?;
        Some(self.sum(&weights)?.plain())
    }
}
