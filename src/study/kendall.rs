//! Kendall's tau measures the agreement of two rankings.

use std::collections::BTreeMap;

use super::claims::CLAIMS;
use crate::measure::{Estimate, Rerun, Variance};

/// Kendall's tau-b of points `(x, y)` (Kendall, "The treatment of ties in ranking problems", 1945). The value is 1 for
/// equal rankings and -1 for opposite rankings. Points `i` and `j`, with `i > j`, are compared only if
/// `compared(i, j)` is true. Returns `None` if all compared pairs have equal x or all compared pairs have equal y.
pub fn kendall(points: &[(f64, f64)], compared: impl Fn(usize, usize) -> bool) -> Option<f64> {
    let (mut same, mut x_differ, mut y_differ) = (0.0, 0.0, 0.0);
    for i in 0..points.len() {
        for j in (0..i).filter(|&j| compared(i, j)) {
            let sign = |d: f64| f64::from(i8::from(d > 0.0) - i8::from(d < 0.0));
            let (x, y): (f64, f64) = (sign(points[i].0 - points[j].0), sign(points[i].1 - points[j].1));
            same += x * y;
            x_differ += x * x;
            y_differ += y * y;
        }
    }
    (x_differ > 0.0 && y_differ > 0.0).then(|| same / libm::sqrt(x_differ * y_differ))
}

pub struct Order {
    /// Kendall's tau. The lower bound counts pairs without a significant order as reversed. The upper bound counts
    /// pairs without a significant order as correctly ordered.
    pub tau: Estimate,
    /// Indices of the significantly reversed pairs. The estimate of the first index is expected to be larger.
    pub reversed: Vec<[usize; 2]>,
}

impl Order {
    /// Each estimate is positive and has an expected rank. The largest estimate is expected at rank 0. Estimates of
    /// equal rank are not compared. The intervals are corrected for `looks` times the number of compared pairs.
    pub fn of(ranked: &[(Estimate, usize)], looks: usize) -> Self {
        let all = || 0..ranked.len();
        let couples = all().flat_map(|i| all().map(move |j| [i, j])).filter(|&[i, j]| ranked[i].1 < ranked[j].1);
        let couples: Vec<[usize; 2]> = couples.collect();
        let looks = looks * couples.len();
        let quotients: Vec<Estimate> =
            couples.iter().map(|&[i, j]| ranked[i].0.over(ranked[j].0).ratio_among(looks)).collect();
        let all = couples.len().max(1) as f64;
        let share = |of: &dyn Fn(&Estimate) -> bool| quotients.iter().filter(|q| of(q)).count() as f64 / all;
        let (sure, reversed) = (share(&|q| q.is_above(1.0)), share(&|q| q.is_below(1.0)));
        let estimate = 2.0 * share(&|q| q.estimate > 1.0) - 1.0;
        let tau = match quotients.iter().all(|q| q.interval.is_some()) {
            true => Estimate::between(estimate, 2.0 * sure - 1.0, 1.0 - 2.0 * reversed),
            false => Estimate::alone(estimate),
        };
        let reversed = couples.iter().zip(&quotients).filter(|(_, q)| q.is_below(1.0)).map(|(couple, _)| *couple);
        Self { tau, reversed: reversed.collect() }
    }
}

/// The taus of one scene are not independent: all workloads use the same trees, and a stand-in imitates the real mesh.
/// So the taus of each scene are averaged first. The interval predicts the mean over an equal number of other scenes.
/// It is corrected for the number of claims and cut to [-1, 1].
pub fn mean_of_scenes<'a>(taus: impl IntoIterator<Item = (&'a str, f64)>) -> Option<Estimate> {
    let mut scenes: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for (scene, tau) in taus {
        scenes.entry(scene).or_default().push(tau);
    }
    let means: Vec<f64> = scenes.values().map(|taus| taus.iter().sum::<f64>() / taus.len() as f64).collect();
    let mean = Rerun::of(&means, Variance::NONE)?.plain().among(CLAIMS);
    Some(mean.map(|tau| tau.clamp(-1.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tau_is_the_share_of_couples_in_order() {
        let all = |_: usize, _: usize| true;
        assert_eq!(kendall(&[(1.0, 10.0), (2.0, 20.0), (3.0, 30.0)], all), Some(1.0));
        assert_eq!(kendall(&[(1.0, 30.0), (2.0, 20.0), (3.0, 10.0)], all), Some(-1.0));
        let one_off = [(1.0, 1.0), (2.0, 3.0), (3.0, 2.0), (4.0, 4.0)];
        assert!((kendall(&one_off, all).unwrap() - 4.0 / 6.0).abs() < 1e-12);
        assert_eq!(kendall(&[(1.0, 1.0), (1.0, 2.0)], all), None);
        assert_eq!(kendall(&one_off, |i, j| (i, j) == (2, 1)), Some(-1.0));
    }

    #[test]
    fn a_mean_of_one_says_nothing_of_others() {
        let mean = |taus: &[f64]| mean_of_scenes(["a", "b", "c", "d"].into_iter().zip(taus.iter().copied()));
        assert_eq!(mean(&[0.5]), Some(Estimate::alone(0.5)));
        let four = mean(&[0.5, 0.6, 0.6, 0.7]).unwrap();
        assert!((four.estimate - 0.6).abs() < 1e-12 && four.holds(0.3) && !four.holds(0.0), "{four:?}");
        assert_eq!(mean(&[-1.0, 1.0]).unwrap().low(), Some(-1.0));
        assert_eq!(mean(&[]), None);
    }

    #[test]
    fn an_order_is_as_sure_as_its_couples() {
        let of = |estimates: [f64; 4]| {
            let ranked = estimates.map(|x| Estimate::between(x, x / 1.1, x * 1.1));
            Order::of(&[(ranked[0], 0), (ranked[1], 0), (ranked[2], 1), (ranked[3], 2)], 1)
        };
        // The first two estimates have equal rank, so five pairs are compared.
        let right = of([8.0, 9.0, 4.0, 2.0]);
        assert_eq!(right.tau, Estimate::exact(1.0));
        let one_off = of([8.0, 9.0, 2.0, 4.0]);
        assert_eq!(one_off.reversed, [[2, 3]]);
        assert!((one_off.tau.estimate - 0.6).abs() < 1e-12 && (one_off.tau.high().unwrap() - 0.6).abs() < 1e-12);
        let open = of([8.0, 9.0, 2.02, 2.0]);
        assert_eq!((open.tau.estimate, open.tau.high()), (1.0, Some(1.0)));
        assert!((open.tau.low().unwrap() - 0.6).abs() < 1e-12 && open.reversed.is_empty());
        let alone = Order::of(&[(Estimate::alone(2.0), 0), (Estimate::alone(1.0), 1)], 1);
        assert_eq!(alone.tau, Estimate::alone(1.0));
    }
}
