//! Warnings about a run, with what to do. Pure functions: nothing is measured here.

use super::summary::median;
use super::variance::mean;

/// What was found of the machine before, during and after the timed part of a run. What the system does not tell is nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conditions {
    /// Load average before the run.
    pub load: Option<f64>,
    pub cores: usize,
    pub governor: Option<String>,
    /// Clock rate of the measuring core at the beginning and at the end.
    pub clock_rates: Option<(f64, f64)>,
    /// How often the measuring thread had to make way for another.
    pub interruptions: Option<u64>,
    /// Of the timed part.
    pub seconds: f64,
    /// [`denormals`](super::machine::denormals).
    pub denormals: &'static str,
    /// Whether the program is built without optimisation.
    pub debug: bool,
}

/// Makes way for others more often than this a second: somebody else wants the core.
const INTERRUPTIONS: f64 = 20.0;

/// What a clock rate may fall by.
const CLOCK_FALL: f64 = 0.9;

impl Conditions {
    /// One sentence for each condition that spoils measurements.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = vec![];
        if self.debug {
            warnings.push(
                "the program is built without optimisation: build it with --release before you trust a time".into(),
            );
        }
        if let Some(load) = self.load.filter(|&load| load > 0.5 * self.cores as f64) {
            let cores = self.cores;
            let noun = if cores == 1 { "core" } else { "cores" };
            warnings.push(format!(
                "the load average was {load:.1} on {cores} {noun} before the run: end other programs; until then trust ratios, not times"
            ));
        }
        if let Some(governor) = self.governor.as_deref().filter(|&governor| governor == "powersave") {
            warnings.push(format!(
                "the clock rate is governed by {governor}: `cpupower frequency-set -g performance` makes times steadier"
            ));
        }
        if let Some((before, after)) = self.clock_rates.filter(|(before, after)| *after < CLOCK_FALL * before) {
            warnings.push(format!(
                "the clock rate fell from {:.2} to {:.2} GHz: the processor throttles; let it cool, or run fewer threads",
                before * 1e-6,
                after * 1e-6
            ));
        }
        let often = |n: u64| n as f64 > INTERRUPTIONS * self.seconds.max(1.0);
        if let Some(n) = self.interruptions.filter(|&n| often(n)) {
            warnings.push(format!(
                "the measuring thread had to make way {n} times in {:.0} s: another program wants its core; end it, or repeat the run",
                self.seconds
            ));
        }
        if !matches!(self.denormals, "kept" | "unknown") {
            let what = self.denormals;
            warnings.push(format!(
                "small numbers are not exact ({what}): a library has changed the control word; answers may differ"
            ));
        }
        warnings
    }
}

/// What the time that passed outside may be, as a multiple of what a program says itself.
const OWN_CLOCK: std::ops::RangeInclusive<f64> = 0.95..=1.25;

/// A sentence about the own clock of the structure `label`, where it and ours disagree.
pub fn of_own_clock(label: &str, outside: f64) -> Option<String> {
    if OWN_CLOCK.contains(&outside) {
        return None;
    }
    let why = if outside < 1.0 {
        "its seconds are none, or are those of several threads together: say the time that elapses"
    } else {
        "it leaves work out of its passes, or another program wants its core: look at what it times, or repeat the run"
    };
    Some(format!("{label}: as seen from outside, its passes take {outside:.2} times as long as it says: {why}"))
}

/// Modified z-scores beyond this are outliers (Iglewicz, Hoaglin, "How to detect and handle outliers", 1993).
const OUTLIER: f64 = 3.5;

/// The share of samples that may be.
const OUTLIERS: f64 = 0.1;

/// How far apart in time the run's beginning and end may be, as a ratio.
const TREND: f64 = 1.05;

/// One sentence for each thing wrong with the samples of a run: those of each case, in the order of the rounds.
pub fn of_samples(cases: &[&[f64]]) -> Vec<String> {
    let mut warnings = vec![];
    let all: usize = cases.iter().map(|case| case.len()).sum();
    let outliers: usize = cases.iter().map(|case| outliers(case)).sum();
    if outliers as f64 > OUTLIERS * all as f64 {
        warnings.push(format!(
            "{outliers} of {all} samples are outliers: something interrupts the run; repeat it on a quieter machine, or with more --runs"
        ));
    }
    if let Some(slower) = trend(cases).filter(|&ratio| ratio > TREND) {
        warnings.push(format!(
            "all cases grew slower, by {:.0} % over the run: the processor throttles or others load it; ratios are paired within rounds \
             and suffer less than times",
            (slower - 1.0) * 100.0
        ));
    }
    warnings
}

/// Samples whose logarithm is farther from the median than [`OUTLIER`] modified standard deviations.
fn outliers(samples: &[f64]) -> usize {
    let logs: Vec<f64> = samples.iter().map(|&ns| libm::log(ns)).collect();
    let Some(middle) = median(&logs) else { return 0 };
    let distances: Vec<f64> = logs.iter().map(|log| libm::fabs(log - middle)).collect();
    let spread = median(&distances).expect("as many as samples");
    // The factor makes the median distance of normal noise its standard deviation. Clocks have steps: half a percent is none.
    distances.iter().filter(|&&d| 0.6745 * d > OUTLIER * spread.max(0.005)).count()
}

/// By how much the cases together grew slower from the first round to the last, as a ratio, where that is no accident: by the
/// test of Mann ("Nonparametric tests against trend", 1945) at three standard deviations, and the slope of Theil and Sen (1968).
fn trend(cases: &[&[f64]]) -> Option<f64> {
    let rounds = cases.iter().map(|case| case.len()).min()?;
    if rounds < 3 {
        return None;
    }
    let logs: Vec<(f64, Vec<f64>)> = cases
        .iter()
        .map(|case| {
            let logs: Vec<f64> = case.iter().map(|&ns| libm::log(ns)).collect();
            (median(&logs).expect("there are rounds"), logs)
        })
        .collect();
    let paces: Vec<f64> =
        (0..rounds).map(|r| mean(&logs.iter().map(|(middle, logs)| logs[r] - middle).collect::<Vec<_>>())).collect();

    let mut slopes = vec![];
    let mut sum = 0.0;
    for (i, a) in paces.iter().enumerate() {
        for (j, b) in paces.iter().enumerate().skip(i + 1) {
            sum += if b > a { 1.0 } else { -1.0 };
            slopes.push((b - a) / (j - i) as f64);
        }
    }
    let n = rounds as f64;
    let deviation = libm::sqrt(n * (n - 1.0) * (2.0 * n + 5.0) / 18.0);
    let slope = median(&slopes).expect("there are pairs");
    (libm::fabs(sum) > 3.0 * deviation).then(|| libm::exp(slope * (n - 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quiet_machine_is_not_warned_of() {
        let quiet = Conditions { load: Some(0.1), cores: 2, seconds: 10.0, denormals: "kept", ..Conditions::default() };
        assert!(quiet.warnings().is_empty());
        assert!(Conditions { denormals: "unknown", ..Conditions::default() }.warnings().is_empty());
    }

    #[test]
    fn every_bad_condition_has_a_sentence_with_advice() {
        let bad = Conditions {
            load: Some(1.9),
            cores: 2,
            governor: Some("powersave".into()),
            clock_rates: Some((3e6, 2e6)),
            interruptions: Some(5000),
            seconds: 10.0,
            denormals: "results flushed to zero",
            debug: true,
        };
        let warnings = bad.warnings();
        let parts =
            ["--release", "1.9 on 2 cores", "powersave", "3.00 to 2.00 GHz", "5000 times in 10 s", "flushed to zero"];
        assert_eq!(warnings.len(), parts.len());
        for (warning, part) in warnings.iter().zip(parts) {
            assert!(warning.contains(part), "{warning}");
        }
    }

    #[test]
    fn many_outliers_are_told_and_few_are_not() {
        let steady: Vec<f64> = (0..20).map(|i| 1000.0 + f64::from(i % 5)).collect();
        let mut spoilt = steady.clone();
        assert_eq!(outliers(&spoilt), 0);
        spoilt[7] = 1500.0;
        assert!(of_samples(&[&spoilt]).is_empty(), "one of twenty");
        (spoilt[3], spoilt[12]) = (2000.0, 1800.0);
        let warnings = of_samples(&[&spoilt]);
        assert!(warnings.len() == 1 && warnings[0].starts_with("3 of 20 samples"), "{warnings:?}");
    }

    #[test]
    fn a_machine_that_slows_down_is_told_and_one_that_wavers_is_not() {
        let slow = |by: f64| -> Vec<f64> { (0..20).map(|i| 1000.0 * (1.0 + by * f64::from(i) / 19.0)).collect() };
        let (fast, other) = (slow(0.2), slow(0.22));
        let warnings = of_samples(&[&fast, &other]);
        assert!(warnings.len() == 1 && warnings[0].contains("21 %"), "{warnings:?}");
        assert!(of_samples(&[&slow(0.03)]).is_empty(), "too little to matter");
        let wavering: Vec<f64> = (0..20).map(|i| 1000.0 + 100.0 * f64::from(i % 2)).collect();
        assert!(of_samples(&[&wavering]).is_empty());
        assert!(of_samples(&[&fast[..2]]).is_empty() && of_samples(&[]).is_empty());
    }
}
