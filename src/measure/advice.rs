//! Warnings about a run, with remedies. Pure functions: this module measures nothing.

use super::summary::{mean, median};
use crate::plural::plural;

/// The state of the machine before, during and after the timed part of a run. `None` if the system does not report it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conditions {
    /// Load average before the run.
    pub load: Option<f64>,
    pub cores: usize,
    pub governor: Option<String>,
    /// Clock rate of the measuring core at the beginning and at the end, kHz.
    pub clock_rates: Option<(f64, f64)>,
    /// How often the system took the core from the measuring thread.
    pub interruptions: Option<u64>,
    /// Duration of the timed part.
    pub seconds: f64,
    /// [`denormals`](super::machine::denormals).
    pub denormals: &'static str,
    /// Whether the program is built without optimisation.
    pub debug: bool,
}

/// With more interruptions per second than this, another program wants the core.
const INTERRUPTIONS: f64 = 20.0;

/// A core whose clock rate falls below this share of its first value is throttled.
const CLOCK_FALL: f64 = 0.9;

impl Conditions {
    /// One sentence for each condition that disturbs measurements.
    pub fn warnings(&self) -> Vec<String> {
        let &Self { cores, seconds, denormals, .. } = self;
        let slow = "sahara is built without optimisation: rebuild with --release for meaningful times";
        let debug = self.debug.then(|| slow.into());
        let load = self.load.filter(|&load| load > 0.5 * cores as f64).map(|load| {
            let cores = plural(cores, "core");
            format!(
                "the load average was {load:.1} on {cores} before the run: stop other programs, or trust ratios only"
            )
        });
        let governor = (self.governor.as_deref() == Some("powersave")).then(|| {
            "the CPU governor is powersave: `cpupower frequency-set -g performance` makes times steadier".into()
        });
        let clock = self.clock_rates.filter(|(before, after)| *after < CLOCK_FALL * before).map(|(before, after)| {
            let [before, after] = [before, after].map(|khz| khz * 1e-6);
            format!(
                "the clock rate fell from {before:.2} to {after:.2} GHz: the CPU throttles; let it cool, or use fewer \
                 threads"
            )
        });
        let is_often = |&n: &u64| n as f64 > INTERRUPTIONS * seconds.max(1.0);
        let interruptions = self.interruptions.filter(is_often).map(|n| {
            format!(
                "the measuring thread was interrupted {n} times in {seconds:.0} s: another program uses its core; \
                 stop it and rerun"
            )
        });
        let denormals = (!matches!(denormals, "kept" | "unknown")).then(|| {
            format!(
                "denormal numbers are treated as zero ({denormals}): a library changed the FPU control word; hits may \
                 differ"
            )
        });
        [debug, load, governor, clock, interruptions, denormals].into_iter().flatten().collect()
    }
}

/// The plausible range of the elapsed time, as a multiple of the time that a runner reports.
const OWN_CLOCK: std::ops::RangeInclusive<f64> = 0.95..=1.25;

/// A sentence about the clock of the runner `label` if it disagrees with the elapsed time; `outside` is the ratio of
/// the elapsed time to the reported one.
pub fn of_own_clock(label: &str, outside: f64) -> Option<String> {
    let why = if outside < 1.0 {
        "its times are not seconds, or are sums over threads: report the elapsed time"
    } else {
        "its timer omits some work, or another program uses its core: check the timer, or rerun"
    };
    let sentence = || format!("{label}: its passes take {outside:.2} times as long as it reports: {why}");
    (!OWN_CLOCK.contains(&outside)).then(sentence)
}

/// Modified z-scores beyond this are outliers (Iglewicz, Hoaglin, "How to detect and handle outliers", 1993).
const OUTLIER: f64 = 3.5;

/// With more outliers than this share of the samples, something interrupts the run.
const OUTLIERS: f64 = 0.1;

/// A run that becomes slower by more than this ratio is not steady.
const TREND: f64 = 1.05;

/// One sentence for each fault of the samples of a run. `cases` contains the samples of each case, in the order of the
/// rounds.
pub fn of_samples(cases: &[&[f64]]) -> Vec<String> {
    let all: usize = cases.iter().map(|case| case.len()).sum();
    let outliers: usize = cases.iter().map(|case| outliers(case)).sum();
    let many = (outliers as f64 > OUTLIERS * all as f64).then(|| {
        format!(
            "{outliers} of {all} samples are outliers: something interrupts the run; use a quieter machine, or raise \
             --runs"
        )
    });
    let trend = trend(cases).filter(|&ratio| ratio > TREND).map(|ratio| {
        let percent = (ratio - 1.0) * 100.0;
        format!(
            "all cases slowed by {percent:.0} % during the run: the CPU throttles or other programs load it; ratios \
             are paired within rounds and suffer less than times"
        )
    });
    [many, trend].into_iter().flatten().collect()
}

/// The logarithms of samples relative to their median.
fn relative(samples: &[f64]) -> Vec<f64> {
    let logs: Vec<f64> = samples.iter().map(|&ns| libm::log(ns)).collect();
    let middle = median(&logs).unwrap_or(0.0);
    logs.into_iter().map(|log| log - middle).collect()
}

/// Samples whose logarithm is farther from the median than [`OUTLIER`] modified standard deviations.
fn outliers(samples: &[f64]) -> usize {
    let distances: Vec<f64> = relative(samples).into_iter().map(libm::fabs).collect();
    let Some(spread) = median(&distances) else { return 0 };
    // The factor turns the median distance of normal noise into its standard deviation. Clocks have steps: half a
    // percent is not a distance.
    distances.iter().filter(|&&d| 0.6745 * d > OUTLIER * spread.max(0.005)).count()
}

/// The slowdown of all cases together from the first round to the last, as a ratio; `None` if it may be chance by the
/// test of Mann ("Nonparametric tests against trend", 1945) at three standard deviations. The slope is the estimate of
/// Theil and Sen (1968).
fn trend(cases: &[&[f64]]) -> Option<f64> {
    let rounds = cases.iter().map(|case| case.len()).min()?;
    if rounds < 3 {
        return None;
    }
    let cases: Vec<Vec<f64>> = cases.iter().map(|case| relative(case)).collect();
    let of_round = |round: usize| mean(&cases.iter().map(|case| case[round]).collect::<Vec<_>>());
    let paces: Vec<f64> = (0..rounds).map(of_round).collect();

    let (mut slopes, mut sum) = (vec![], 0.0);
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
    fn every_bad_condition_has_a_sentence_with_advice_and_a_quiet_machine_none() {
        let quiet = Conditions { load: Some(0.1), cores: 2, seconds: 10.0, denormals: "kept", ..Conditions::default() };
        assert_eq!(quiet.warnings(), [""; 0]);
        assert_eq!(Conditions { denormals: "unknown", ..quiet.clone() }.warnings(), [""; 0]);
        let bad = [
            ("--release", Conditions { debug: true, ..quiet.clone() }),
            ("1.9 on 2 cores", Conditions { load: Some(1.9), ..quiet.clone() }),
            ("powersave", Conditions { governor: Some("powersave".into()), ..quiet.clone() }),
            ("3.00 to 2.00 GHz", Conditions { clock_rates: Some((3e6, 2e6)), ..quiet.clone() }),
            ("5000 times in 10 s", Conditions { interruptions: Some(5000), ..quiet.clone() }),
            ("flushed to zero", Conditions { denormals: "results flushed to zero", ..quiet }),
        ];
        for (part, conditions) in bad {
            let warnings = conditions.warnings();
            assert!(warnings.len() == 1 && warnings[0].contains(part), "{warnings:?}");
        }
    }

    /// Twenty samples that grow by the share `by` in total.
    fn growing(by: f64) -> Vec<f64> {
        (0..20).map(|i| 1000.0 * (1.0 + by * f64::from(i) / 19.0)).collect()
    }

    #[test]
    fn many_outliers_and_a_steady_loss_of_speed_are_warned_of_and_nothing_else() {
        let steady: Vec<f64> = (0..20).map(|i| 1000.0 + f64::from(i % 5)).collect();
        let spoilt = |with: &[(usize, f64)]| {
            let mut samples = steady.clone();
            with.iter().for_each(|&(i, ns)| samples[i] = ns);
            samples
        };
        let wavering: Vec<f64> = (0..20).map(|i| 1000.0 + 100.0 * f64::from(i % 2)).collect();
        let short = growing(0.2)[..2].to_vec();
        let cases = [
            (vec![], None),
            (vec![steady.clone()], None),
            (vec![spoilt(&[(7, 1500.0)])], None),
            (vec![spoilt(&[(3, 2000.0), (7, 1500.0), (12, 1800.0)])], Some("3 of 20 samples are outliers")),
            (vec![growing(0.2), growing(0.22)], Some("all cases slowed by 21 %")),
            (vec![growing(0.03)], None),
            (vec![wavering], None),
            (vec![short], None),
        ];
        for (samples, expected) in cases {
            let warnings = of_samples(&samples.iter().map(Vec::as_slice).collect::<Vec<_>>());
            assert_eq!(warnings.len(), expected.iter().len(), "{samples:?}: {warnings:?}");
            assert!(warnings.iter().zip(expected).all(|(warning, part)| warning.starts_with(part)), "{warnings:?}");
        }
    }
}
