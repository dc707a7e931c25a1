//! The options of the timing.

use super::{MEASURING, Seconds};

/// The extent of the timing. The parameters are the defaults of a study, rendered as texts: for other types clap keeps
/// one default for all instances.
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

/// A time limit; `None` is unlimited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit(pub Option<Seconds>);

impl Limit {
    /// Reads seconds, or `none`.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text == "none" { Ok(Self(None)) } else { text.parse().map(|seconds| Self(Some(seconds))) }
    }

    pub fn ns(self) -> Option<u64> {
        self.0.map(Seconds::ns)
    }
}
