//! Warnings about a run, with remedies. Pure functions: this module measures nothing.

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
}
