//! What two builds of the same structure differ by.

use super::replication::replication;
use super::summary::Interval;

/// The A/A ratios of a run: the same structure built twice and timed as two. They are 1 but for noise, so a ratio that is no
/// farther from 1 than they are says nothing (Georges, Buytaert, Eeckhout, "Statistically rigorous Java performance
/// evaluation", 2007, on comparing alternatives; the twin is a control).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NoiseFloor {
    /// One for each cell, with its interval, in which no floor is joined.
    pub ratios: Vec<Interval>,
}

impl NoiseFloor {
    /// Of the cells of a run, each the [log ratios](super::log_ratios) of one twin to the other.
    pub fn new(cells: &[Vec<Vec<f64>>], seed: u64) -> Self {
        Self { ratios: cells.iter().filter_map(|cell| replication(std::slice::from_ref(cell), 0.0, seed)).collect() }
    }

    /// The largest |ln ratio|; nothing where there is no ratio. It stands for all that differs between processes, of which twins of
    /// one process show but a part.
    pub fn log(&self) -> Option<f64> {
        self.ratios.iter().map(|ratio| libm::fabs(libm::log(ratio.estimate))).max_by(f64::total_cmp)
    }

    /// What the mean of as many cells of two builds may differ by, a logarithm: were the luck of each cell its own, that of their mean
    /// would be smaller by the root of their number; what they share, the mean of the A/A ratios shows.
    pub fn log_of_mean(&self) -> Option<f64> {
        let n = self.ratios.len() as f64;
        let mean = self.ratios.iter().map(|ratio| libm::log(ratio.estimate)).sum::<f64>() / n;
        Some(f64::max(self.log()? / libm::sqrt(n), libm::fabs(mean)))
    }

    /// How many of the ratios' intervals hold 1.
    pub fn holding_one(&self) -> usize {
        self.ratios.iter().filter(|ratio| ratio.low <= 1.0 && 1.0 <= ratio.high).count()
    }
}

/// What a ratio of speeds says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Difference {
    /// The whole interval is above 1, and reaches above the floor.
    Faster,
    /// The whole interval is below 1, and reaches below the floor.
    Slower,
    /// The interval holds 1, or lies within the floor.
    None,
}

impl Difference {
    /// Of a ratio of speeds, where `floor` is the [logarithm](NoiseFloor::log) of the A/A ratios.
    pub fn of(speed: Interval, floor: f64) -> Self {
        let within = |x: f64| libm::fabs(libm::log(x)) <= floor;
        if (speed.low <= 1.0 && speed.high >= 1.0) || (within(speed.low) && within(speed.high)) {
            Self::None
        } else if speed.low > 1.0 {
            Self::Faster
        } else {
            Self::Slower
        }
    }

    /// As tables print it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Faster => "faster",
            Self::Slower => "slower",
            Self::None => "no difference",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(estimate: f64, low: f64, high: f64) -> Interval {
        Interval { estimate, low, high }
    }

    #[test]
    fn the_floor_is_the_largest_of_the_ratios() {
        let sized = |sizes: &[f64]| NoiseFloor {
            ratios: sizes.iter().map(|&size| interval(libm::exp(size), 0.9, 1.1)).collect(),
        };
        assert_eq!(sized(&[]).log(), None);
        assert!((sized(&[0.01, -0.03, 0.02]).log().unwrap() - 0.03).abs() < 1e-12);
        assert_eq!(sized(&[0.01, -0.03, 0.02]).holding_one(), 3);
        // Of luck that cells share nothing cancels, of their own much does.
        assert!((sized(&[0.02; 4]).log_of_mean().unwrap() - 0.02).abs() < 1e-12);
        assert!((sized(&[0.02, -0.02, 0.02, -0.02]).log_of_mean().unwrap() - 0.01).abs() < 1e-12);
        assert_eq!(sized(&[]).log_of_mean(), None);
    }

    #[test]
    fn within_the_floor_there_is_no_difference() {
        let floor = libm::log(1.02);
        let cases = [
            (interval(1.10, 1.05, 1.15), Difference::Faster),
            (interval(0.90, 0.85, 0.95), Difference::Slower),
            (interval(1.10, 0.99, 1.20), Difference::None),
            (interval(1.01, 1.005, 1.015), Difference::None),
            (interval(1.02, 1.005, 1.035), Difference::Faster),
            (interval(0.99, 0.985, 0.995), Difference::None),
        ];
        for (speed, difference) in cases {
            assert_eq!(Difference::of(speed, floor), difference, "{speed:?}");
        }
    }

    #[test]
    fn twins_without_noise_have_no_floor() {
        let floor = NoiseFloor::new(&[vec![vec![0.0; 3]; 5], vec![vec![0.01; 3]; 5]], 1);
        assert!((floor.log().unwrap() - 0.01).abs() < 1e-12);
        assert_eq!(floor.holding_one(), 1);
    }
}
