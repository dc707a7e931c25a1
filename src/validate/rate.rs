//! The rate of an event, and its upper bound.

use crate::measure::beta_quantile;

/// `events` among `of` independent trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    pub events: u64,
    pub of: u64,
}

/// The probability that the true rate exceeds the bound.
const LEVEL: f64 = 0.05;

impl Rate {
    /// The share of trials with the event; `None` without trials.
    pub fn share(self) -> Option<f64> {
        (self.of > 0).then(|| self.events as f64 / self.of as f64)
    }

    /// The upper bound of the true rate with 95 % confidence, at most 1; `None` without trials.
    ///
    /// One-sided: at this rate so few events would occur in 5 % of the cases. Without an event it is 1 - 0.05^(1 / n),
    /// about 3 / n.
    ///
    /// # References
    /// Clopper, Pearson: The use of confidence or fiducial limits illustrated in the case of the binomial. Biometrika
    /// 26, 1934. Hanley, Lippman-Hand: If nothing goes wrong, is everything all right? J. Am. Med. Assoc. 249, 1983.
    pub fn bound(self) -> Option<f64> {
        let (events, others) = (self.events as f64, (self.of - self.events) as f64);
        match self {
            Self { of: 0, .. } => None,
            Self { events: 0, of } => Some(-libm::expm1(libm::log(LEVEL) / of as f64)),
            _ if others == 0.0 => Some(1.0),
            _ => Some(beta_quantile(1.0 - LEVEL, events + 1.0, others)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(events: u64, of: u64) -> Rate {
        Rate { events, of }
    }

    #[test]
    fn the_ends_are_those_of_printed_tables() {
        for (events, of, bound) in
            [(0, 10, 0.2589), (0, 100, 0.02951), (1, 10, 0.3942), (5, 10, 0.7776), (9, 10, 0.9949)]
        {
            let found = rate(events, of).bound().unwrap();
            assert!((found - bound).abs() < 5e-5, "{events} of {of}: {found}");
        }
    }

    #[test]
    fn without_an_event_the_bound_is_about_three_in_n() {
        assert_eq!(rate(0, 0).bound(), None);
        assert_eq!(rate(10, 10).bound(), Some(1.0));
        for n in [100_u64, 1_000_000, 1_000_000_000] {
            let bound = rate(0, n).bound().unwrap();
            // At this rate no event would occur in 5 % of the runs.
            assert!((libm::exp(n as f64 * libm::log1p(-bound)) - 0.05).abs() < 1e-9, "{n}: {bound}");
            assert!((bound * n as f64 - 2.9957).abs() < 0.05, "{n}: {bound}");
        }
    }
}
