//! Do two measures put things in the same order?

use crate::measure::{Interval, LEVEL, factor, standard_error};

/// Kendall's tau-b of pairs `(x, y)` (Kendall, "The treatment of ties in ranking problems", 1945): 1 for the same order, -1 for the
/// opposite one. Only couples for which `compared` says so take part. Nothing where none differs in both.
pub fn kendall(pairs: &[(f64, f64)], compared: impl Fn(usize, usize) -> bool) -> Option<f64> {
    let (mut same, mut x_differ, mut y_differ) = (0.0, 0.0, 0.0);
    for i in 0..pairs.len() {
        for j in (0..i).filter(|&j| compared(i, j)) {
            let sign = |d: f64| {
                if d > 0.0 {
                    1.0
                } else if d < 0.0 {
                    -1.0
                } else {
                    0.0
                }
            };
            let (x, y): (f64, f64) = (sign(pairs[i].0 - pairs[j].0), sign(pairs[i].1 - pairs[j].1));
            same += x * y;
            x_differ += x * x;
            y_differ += y * y;
        }
    }
    (x_differ > 0.0 && y_differ > 0.0).then(|| same / libm::sqrt(x_differ * y_differ))
}

/// The mean of several taus, with Student's 95 % interval of their mean, cut to what a tau can be.
pub(super) fn mean(taus: &[f64]) -> Option<Interval> {
    if taus.is_empty() {
        return None;
    }
    let mean = taus.iter().sum::<f64>() / taus.len() as f64;
    let half = standard_error(taus).map_or(2.0, |error| factor(taus.len() as f64 - 1.0, LEVEL) * error);
    Some(Interval { estimate: mean, low: (mean - half).max(-1.0), high: (mean + half).min(1.0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tau_is_the_share_of_couples_in_order() {
        let all = |_: usize, _: usize| true;
        assert_eq!(kendall(&[(1.0, 10.0), (2.0, 20.0), (3.0, 30.0)], all), Some(1.0));
        assert_eq!(kendall(&[(1.0, 30.0), (2.0, 20.0), (3.0, 10.0)], all), Some(-1.0));
        // Five couples of six in order.
        let one_off = [(1.0, 1.0), (2.0, 3.0), (3.0, 2.0), (4.0, 4.0)];
        assert!((kendall(&one_off, all).unwrap() - 4.0 / 6.0).abs() < 1e-12);
        assert_eq!(kendall(&[(1.0, 1.0), (1.0, 2.0)], all), None);
        assert_eq!(kendall(&one_off, |i, j| (i, j) == (2, 1)), Some(-1.0));
    }

    #[test]
    fn a_mean_of_one_says_nothing_of_others() {
        assert_eq!(mean(&[0.5]), Some(Interval { estimate: 0.5, low: -1.0, high: 1.0 }));
        let three = mean(&[0.5, 0.6, 0.7]).unwrap();
        assert!((three.estimate - 0.6).abs() < 1e-12 && three.low > 0.3 && three.high < 0.9, "{three:?}");
        assert_eq!(mean(&[]), None);
    }
}
