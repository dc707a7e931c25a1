//! A measured number with its interval.

use serde::{Deserialize, Serialize};

use super::quantiles::{LEVEL, factor};
use super::summary::Variance;

/// An estimate with its 95 % [interval](mod@super::interval).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Flat", into = "Flat")]
pub struct Estimate {
    pub estimate: f64,
    pub interval: Option<Interval>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
    /// Degrees of freedom of Student's t, possibly infinite.
    pub freedom: f64,
}

/// In JSON files, `null` represents a missing interval or infinite degrees of freedom.
#[derive(Serialize, Deserialize)]
struct Flat {
    estimate: f64,
    low: Option<f64>,
    high: Option<f64>,
    #[serde(default)]
    freedom: Option<f64>,
}

impl From<Flat> for Estimate {
    fn from(flat: Flat) -> Self {
        let Flat { estimate, low, high, freedom } = flat;
        let freedom = freedom.unwrap_or(f64::INFINITY);
        Self { estimate, interval: low.zip(high).map(|(low, high)| Interval { low, high, freedom }) }
    }
}

impl From<Estimate> for Flat {
    fn from(of: Estimate) -> Self {
        let freedom = of.interval.map(|interval| interval.freedom).filter(|freedom| freedom.is_finite());
        Self { estimate: of.estimate, low: of.low(), high: of.high(), freedom }
    }
}

impl Estimate {
    pub fn alone(estimate: f64) -> Self {
        Self { estimate, interval: None }
    }

    /// A number that does not vary, such as a count.
    pub fn exact(estimate: f64) -> Self {
        Self::between(estimate, estimate, estimate)
    }

    pub fn between(estimate: f64, low: f64, high: f64) -> Self {
        Self { estimate, interval: Some(Interval { low, high, freedom: f64::INFINITY }) }
    }

    pub fn low(&self) -> Option<f64> {
        self.interval.map(|interval| interval.low)
    }

    pub fn high(&self) -> Option<f64> {
        self.interval.map(|interval| interval.high)
    }

    pub fn is_above(&self, bound: f64) -> bool {
        self.low().is_some_and(|low| low > bound)
    }

    pub fn is_below(&self, bound: f64) -> bool {
        self.high().is_some_and(|high| high < bound)
    }

    pub fn holds(&self, value: f64) -> bool {
        self.interval.is_some_and(|interval| (interval.low..=interval.high).contains(&value))
    }

    /// `of` must be an increasing function.
    pub fn map(self, of: impl Fn(f64) -> f64) -> Self {
        let ends = |Interval { low, high, freedom }: Interval| Interval { low: of(low), high: of(high), freedom };
        Self { estimate: of(self.estimate), interval: self.interval.map(ends) }
    }

    /// Widens the interval for a joint confidence of 95 % over `looks` estimates (Bonferroni).
    pub fn among(self, looks: usize) -> Self {
        if looks < 2 {
            return self;
        }
        let grown = |Interval { low, high, freedom }: Interval| {
            let by = factor(freedom, LEVEL / looks as f64) / factor(freedom, LEVEL);
            let from = |end: f64| self.estimate + (end - self.estimate) * by;
            Interval { low: from(low), high: from(high), freedom }
        };
        Self { interval: self.interval.map(grown), ..self }
    }

    /// Applies [`Self::among`] on a logarithmic scale.
    pub fn ratio_among(self, looks: usize) -> Self {
        self.map(libm::log).among(looks).map(libm::exp)
    }

    /// The quotient of two positive estimates with independent errors.
    pub fn over(self, other: Self) -> Self {
        let log = libm::log(self.estimate / other.estimate);
        let part = |x: Self| {
            let Interval { low, high, freedom } = x.interval?;
            let error = libm::log(high / low) / 2.0 / factor(freedom, LEVEL);
            Some(Variance { square: error * error, freedom })
        };
        let interval = part(self).zip(part(other)).map(|(own, other)| {
            let Variance { square, freedom } = Variance::sum(&[own, other]);
            let half = factor(freedom, LEVEL) * libm::sqrt(square);
            Interval { low: libm::exp(log - half), high: libm::exp(log + half), freedom }
        });
        Self { estimate: libm::exp(log), interval }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_hold_one_object_and_read_back() {
        let of = |estimate: Estimate| serde_json::to_string(&estimate).unwrap();
        let freedom = Estimate { estimate: 2.0, interval: Some(Interval { low: 1.5, high: 3.0, freedom: 4.5 }) };
        assert_eq!(of(freedom), r#"{"estimate":2.0,"low":1.5,"high":3.0,"freedom":4.5}"#);
        assert_eq!(of(Estimate::alone(2.0)), r#"{"estimate":2.0,"low":null,"high":null,"freedom":null}"#);
        for estimate in [freedom, Estimate::alone(2.0), Estimate::exact(3.0)] {
            assert_eq!(serde_json::from_str::<Estimate>(&of(estimate)).unwrap(), estimate);
        }
        let old: Estimate = serde_json::from_str(r#"{"estimate":2.0,"low":1.5,"high":3.0}"#).unwrap();
        assert_eq!(old, Estimate::between(2.0, 1.5, 3.0));
    }

    #[test]
    fn without_an_interval_nothing_is_sure() {
        let alone = Estimate::alone(9.0);
        assert!(!alone.is_above(1.0) && !alone.is_below(10.0) && !alone.holds(9.0));
        assert_eq!((alone.low(), alone.among(5)), (None, alone));
        let exact = Estimate::exact(9.0);
        assert!(exact.is_above(1.0) && exact.holds(9.0));
    }

    #[test]
    fn errors_of_a_quotient_add_in_squares() {
        let tenth = |estimate: f64| {
            let interval = Interval { low: estimate / 1.1, high: estimate * 1.1, freedom: 8.0 };
            Estimate { estimate, interval: Some(interval) }
        };
        let quotient = tenth(15.0).over(tenth(10.0));
        let Interval { high, freedom, .. } = quotient.interval.unwrap();
        assert!((quotient.estimate - 1.5).abs() < 1e-12 && (freedom - 16.0).abs() < 1e-9);
        // Student's t at 5 % is 2.306 with 8 degrees of freedom and 2.120 with 16.
        let expected = libm::log(1.1) * libm::sqrt(2.0) * 2.120 / 2.306;
        assert!((libm::log(high / 1.5) / expected - 1.0).abs() < 1e-3);
        assert_eq!(Estimate::exact(3.0).over(Estimate::exact(2.0)).high(), Some(1.5));
        assert_eq!(tenth(1.0).over(Estimate::alone(2.0)).interval, None);
    }

    #[test]
    fn among_many_an_interval_is_wider() {
        // Student's t with four degrees of freedom is 2.776 at 5 % and 4.604 at 1 %.
        let one = Estimate { estimate: 1.2, interval: Some(Interval { low: 1.1, high: 1.3, freedom: 4.0 }) };
        let five = one.among(5);
        assert!((five.high().unwrap() - (1.2 + 0.1 * 4.604 / 2.776)).abs() < 1e-4, "{five:?}");
        assert_eq!(one.among(1), one);
        let ratio = one.ratio_among(5);
        let down = libm::log(1.2 / ratio.low().unwrap()) / libm::log(1.2 / 1.1);
        assert!((down - 4.604 / 2.776).abs() < 1e-3, "{ratio:?}");
    }
}
