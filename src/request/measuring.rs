//! The timing options.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;
use std::time::Duration;

use super::MEASURING;

/// The timing options. The const parameters are the default values of `--epochs`, `--runs` and `--budget`.
///
/// These options use `default_value`. Clap would store a `default_value_t` only once for all const parameters.
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = MEASURING)]
pub struct Measuring<const EPOCHS: u16 = 5, const RUNS: u16 = 3, const BUDGET: u32 = 8> {
    /// Number of epochs; each rebuilds all structures. With a journal, a later run with a larger N adds epochs
    #[arg(long, value_name = "N", default_value = EPOCHS.to_string(), value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub epochs: u16,
    /// Samples per structure, workload and epoch (fewer if the budget runs out)
    #[arg(long, value_name = "N", default_value = RUNS.to_string(), value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub runs: u16,
    /// Time budget in seconds for the samples of one scene in one epoch; to stay within it, slow structures are timed
    /// on fewer rays. `none` times every structure on all rays; `compare` then skips brute-force unless it is named
    #[arg(long, value_name = "SECONDS|none", default_value = BUDGET.to_string(), value_parser = Limit::parse,
        allow_negative_numbers = true)]
    pub budget: Limit,
    /// Threads for building and tracing
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Seed of the rays and of the sample order
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}

/// A time limit. `None` is unlimited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit(pub Option<Seconds>);

impl Limit {
    pub fn parse(text: &str) -> Result<Self, String> {
        if text == "none" { Ok(Self(None)) } else { text.parse().map(|seconds| Self(Some(seconds))) }
    }

    pub fn ns(self) -> Option<u64> {
        self.0.map(Seconds::ns)
    }
}

/// A duration. The parser accepts durations from a millisecond to a day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seconds(Duration);

impl Seconds {
    pub const fn whole(seconds: u32) -> Self {
        Self(Duration::from_secs(seconds as u64))
    }

    pub fn duration(self) -> Duration {
        self.0
    }

    pub fn seconds(self) -> f64 {
        self.0.as_secs_f64()
    }

    pub fn ns(self) -> u64 {
        self.0.as_nanos() as u64
    }
}

impl FromStr for Seconds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let seconds = text.parse().ok().filter(|seconds| (0.001..=86400.0).contains(seconds));
        let seconds = seconds.ok_or("give seconds from 0.001 to 86400, for example 1.5")?;
        Ok(Self(Duration::from_secs_f64(seconds)))
    }
}

impl Display for Seconds {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.as_secs_f64().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_may_have_decimals_and_are_some_time() {
        for (text, ms, shown) in
            [("8", 8000, "8"), (".25", 250, "0.25"), ("0.001", 1, "0.001"), ("86400", 86_400_000, "86400")]
        {
            let read: Seconds = text.parse().unwrap();
            assert_eq!((read.ns(), read.to_string()), (ms * 1_000_000, shown.into()));
        }
        for wrong in ["", "0", "-1", "-0.5", "nan", "inf", "-inf", "1e300", "86400.1", "1,5", "1s", "1e-9"] {
            let sentence = wrong.parse::<Seconds>().unwrap_err();
            assert!(sentence.starts_with("give seconds from 0.001 to 86400"), "{wrong}: {sentence}");
        }
    }
}
