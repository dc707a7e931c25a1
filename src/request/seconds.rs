//! Seconds as values of options.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;
use std::time::Duration;

/// A time of at least a millisecond and at most a day.
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
