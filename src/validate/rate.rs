//! How often something happens, and how often it may.

/// `events` among `of` independent trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    pub events: u64,
    pub of: u64,
}

/// The 95 % quantile of the normal distribution.
const Z: f64 = 1.644_853_626_951_472_2;

impl Rate {
    /// The share of trials with the event; nothing of no trials.
    pub fn share(self) -> Option<f64> {
        (self.of > 0).then(|| self.events as f64 / self.of as f64)
    }

    /// What the true rate is below with 95 % confidence, at most 1; nothing of no trials.
    ///
    /// Without an event 3 / n, since (1 - 3/n)^n < 5 %; otherwise the upper end of the one-sided score interval, which
    /// without an event would give 2.7 / n.
    ///
    /// # References
    /// Wilson: Probable inference, the law of succession, and statistical inference. J. Am. Stat. Assoc. 22, 1927.
    /// Hanley, Lippman-Hand: If nothing goes wrong, is everything all right? J. Am. Med. Assoc. 249, 1983.
    pub fn bound(self) -> Option<f64> {
        let (n, share) = (self.of as f64, self.share()?);
        if self.events == 0 {
            return Some((3.0 / n).min(1.0));
        }
        let middle = share + Z * Z / (2.0 * n);
        let half = Z * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
        Some(((middle + half) / (1.0 + Z * Z / n)).min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_an_event_the_bound_is_three_in_n() {
        assert_eq!(Rate { events: 0, of: 0 }.bound(), None);
        assert_eq!(Rate { events: 0, of: 2 }.bound(), Some(1.0));
        assert_eq!(Rate { events: 0, of: 10_000 }.bound(), Some(3e-4));
        // What it promises: were the rate as high, no event would be seen in fewer than 5 % of the runs.
        assert!(libm::pow(1.0 - 3e-4, 10_000.0) < 0.05);
    }

    #[test]
    fn with_events_the_bound_is_that_of_wilson() {
        // Solutions of (share - p)^2 = z^2 p (1 - p) / n, above the share.
        for (events, of) in [(1, 100), (5, 50), (9999, 10_000), (10, 10)] {
            let (rate, n) = (Rate { events, of }, of as f64);
            let (share, p) = (rate.share().unwrap(), rate.bound().unwrap());
            assert!(p > share || p == 1.0);
            let defect = (share - p) * (share - p) - Z * Z * p * (1.0 - p) / n;
            assert!(defect.abs() < 1e-15, "{rate:?}: {defect}");
        }
        assert!(Rate { events: 1, of: 1000 }.bound() > Rate { events: 0, of: 1000 }.bound());
    }
}
