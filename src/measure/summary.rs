//! What is printed of many samples. Pure functions.

use super::RandomOrder;

/// The middle of `values`, the mean of the middle two when their number is even; nothing of nothing.
///
/// # Panics
/// If a value is NaN.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(|a, b| a.partial_cmp(b).expect("a sample is a number"));
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => None,
        n if n % 2 == 1 => Some(sorted[middle]),
        _ => Some((sorted[middle - 1] + sorted[middle]) * 0.5),
    }
}

/// The geometric mean of positive `values`; nothing of nothing.
///
/// # Panics
/// If a value is not positive.
pub fn geometric_mean(values: &[f64]) -> Option<f64> {
    assert!(values.iter().all(|&v| v > 0.0), "a geometric mean is of positive numbers");
    let logs: f64 = values.iter().map(|&v| libm::log(v)).sum();
    (!values.is_empty()).then(|| libm::exp(logs / values.len() as f64))
}

/// An estimate with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Interval {
    pub estimate: f64,
    pub low: f64,
    pub high: f64,
}

/// Resamples of a bootstrap: the ends of a 95 % interval are then the 50th value from either end.
pub(super) const RESAMPLES: usize = 2000;

/// The median of `numerator[i] / denominator[i]` with a percentile bootstrap interval over the pairs (Efron 1979).
///
/// Samples of the same round are a pair: what slows the machine for a while slows both.
/// With n pairs the interval is at most the range of the ratios, and with fewer than 6 it is narrower than it claims.
///
/// Nothing when there are no pairs.
///
/// # Panics
/// If the numbers of samples differ, or one is not positive.
pub fn paired_ratio(numerator: &[f64], denominator: &[f64], seed: u64) -> Option<Interval> {
    assert_eq!(numerator.len(), denominator.len(), "samples come in pairs");
    assert!(numerator.iter().chain(denominator).all(|&t| t > 0.0), "a sample takes time");
    let ratios: Vec<f64> = numerator.iter().zip(denominator).map(|(a, b)| a / b).collect();
    bootstrap(&[&ratios], |resampled| median(resampled[0]).expect("a resample is as large as the sample"), seed)
}

/// The geometric mean over groups of the medians of each group's ratios, with a bootstrap interval that resamples within
/// each group. Nothing when there is no group or one is empty.
pub fn mean_ratio(groups: &[Vec<f64>], seed: u64) -> Option<Interval> {
    let groups: Vec<&[f64]> = groups.iter().map(Vec::as_slice).collect();
    let statistic = |groups: &[&[f64]]| {
        let medians: Vec<f64> = groups.iter().filter_map(|g| median(g)).collect();
        geometric_mean(&medians).expect("there is a group")
    };
    bootstrap(&groups, statistic, seed)
}

/// Percentile bootstrap of a statistic of groups of samples.
fn bootstrap(groups: &[&[f64]], statistic: impl Fn(&[&[f64]]) -> f64, seed: u64) -> Option<Interval> {
    if groups.is_empty() || groups.iter().any(|g| g.is_empty()) {
        return None;
    }
    let mut random = RandomOrder::new(seed);
    let mut values: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let resampled: Vec<Vec<f64>> =
                groups.iter().map(|g| g.iter().map(|_| g[random.below(g.len())]).collect()).collect();
            statistic(&resampled.iter().map(Vec::as_slice).collect::<Vec<_>>())
        })
        .collect();
    values.sort_unstable_by(f64::total_cmp);
    let tail = RESAMPLES / 40;
    Some(Interval { estimate: statistic(groups), low: values[tail], high: values[RESAMPLES - 1 - tail] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(&[]), None);
        assert_eq!(median(&[3.0]), Some(3.0));
        assert_eq!(median(&[9.0, 1.0, 5.0]), Some(5.0));
        assert_eq!(median(&[4.0, 1.0, 100.0, 2.0]), Some(3.0));
    }

    #[test]
    fn a_geometric_mean_of_a_number_and_its_inverse_is_one() {
        assert_eq!(geometric_mean(&[]), None);
        assert!((geometric_mean(&[8.0, 0.125]).unwrap() - 1.0).abs() < 1e-15);
        assert!((geometric_mean(&[2.0, 4.0, 8.0]).unwrap() - 4.0).abs() < 1e-14);
    }

    #[test]
    fn pairs_cancel_what_both_suffer() {
        // Both run twice as slow in the second half: the ratio is 3 throughout.
        let a = [3.0, 3.0, 6.0, 6.0];
        let b = [1.0, 1.0, 2.0, 2.0];
        assert_eq!(paired_ratio(&a, &b, 1), Some(Interval { estimate: 3.0, low: 3.0, high: 3.0 }));
        assert_eq!(paired_ratio(&[], &[], 1), None);
    }

    #[test]
    fn an_interval_holds_the_estimate_and_repeats() {
        let a: Vec<f64> = (0..30).map(|i| 10.0 + f64::from(i % 7)).collect();
        let b = vec![5.0; 30];
        let interval = paired_ratio(&a, &b, 5).unwrap();
        assert_eq!(interval.estimate, 2.6);
        assert!(interval.low < 2.6 && 2.6 < interval.high, "{interval:?}");
        assert!(2.0 <= interval.low && interval.high <= 3.2, "{interval:?}");
        assert_eq!(Some(interval), paired_ratio(&a, &b, 5));
    }

    #[test]
    fn a_mean_over_groups_is_the_mean_of_their_medians() {
        let ratio = mean_ratio(&[vec![2.0, 2.0, 2.0], vec![8.0, 8.0]], 1).unwrap();
        for value in [ratio.estimate, ratio.low, ratio.high] {
            assert!((value - 4.0).abs() < 1e-14);
        }
        assert_eq!(mean_ratio(&[vec![1.0], vec![]], 1), None);
        assert_eq!(mean_ratio(&[], 1), None);
    }

    #[test]
    fn the_interval_covers_as_often_as_it_says() {
        // 400 samples of 25 uniform ratios with the true median 1.5: about 95 % of the intervals hold it.
        let mut random = RandomOrder::new(11);
        let ones = vec![1.0; 25];
        let covered = (0..400)
            .filter(|&seed| {
                let sample: Vec<f64> = (0..25).map(|_| 1.0 + random.below(1_000_001) as f64 * 1e-6).collect();
                let interval = paired_ratio(&sample, &ones, seed).unwrap();
                (interval.low..=interval.high).contains(&1.5)
            })
            .count();
        assert!((360..=396).contains(&covered), "{covered} of 400");
    }
}
