//! Warnings about a run, with remedies.

use super::{Provenance, machine};
use crate::plural::plural;

/// Interruptions per second above this value indicate another program on the core.
const INTERRUPTIONS: f64 = 20.0;

/// A clock rate below this fraction of the initial rate indicates throttling.
const CLOCK_FALL: f64 = 0.9;

/// `seconds` is the duration of the measurement. `interruptions` counts involuntary context switches of the measuring
/// thread. `clock_rates` contains the clock rates at the beginning and at the end, in kHz.
pub fn of_conditions(
    before: &Provenance,
    seconds: f64,
    interruptions: Option<u64>,
    clock_rates: Option<(f64, f64)>,
) -> Vec<String> {
    let slow = "sahara is built without optimisation: rebuild with --release for meaningful times";
    let debug = (before.profile == "debug").then(|| slow.into());
    let load = before.load.filter(|&load| load > 0.5 * before.cores as f64).map(|load| {
        let cores = plural(before.cores, "core");
        format!("the load average was {load:.1} on {cores} before the run: stop other programs, or trust ratios only")
    });
    let governor = (before.governor.as_deref() == Some("powersave"))
        .then(|| "the CPU governor is powersave: `cpupower frequency-set -g performance` makes times steadier".into());
    let clock = clock_rates.filter(|(before, after)| *after < CLOCK_FALL * before).map(|(before, after)| {
        let [before, after] = [before, after].map(|khz| khz * 1e-6);
        format!(
            "the clock rate fell from {before:.2} to {after:.2} GHz: the CPU throttles; let it cool, or use fewer \
             threads"
        )
    });
    let is_often = |&n: &u64| n as f64 > INTERRUPTIONS * seconds.max(1.0);
    let interruptions = interruptions.filter(is_often).map(|n| {
        format!(
            "the measuring thread was interrupted {n} times in {seconds:.0} s: another program uses its core; \
             stop it and rerun"
        )
    });
    let denormals = machine::denormals(before.mxcsr);
    let denormals = (!matches!(denormals, "kept" | "unknown")).then(|| {
        format!(
            "denormal numbers are treated as zero ({denormals}): a library changed the FPU control word; hits may \
             differ"
        )
    });
    [debug, load, governor, clock, interruptions, denormals].into_iter().flatten().collect()
}

/// Plausible ratios of the elapsed time to the time that a runner reports.
const OWN_CLOCK: std::ops::RangeInclusive<f64> = 0.95..=1.25;

/// `outside` is the ratio of the elapsed time to the time that the runner `label` reports.
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
        let quiet = Provenance {
            profile: "release".into(),
            cores: 2,
            governor: None,
            load: Some(0.1),
            mxcsr: None,
            ..Provenance::capture(1)
        };
        let of =
            |before: &Provenance, interruptions, clock_rates| of_conditions(before, 10.0, interruptions, clock_rates);
        assert_eq!(of(&quiet, Some(10), Some((3e6, 2.9e6))), [""; 0]);
        let with = |edit: fn(&mut Provenance)| {
            let mut before = quiet.clone();
            edit(&mut before);
            of(&before, None, None)
        };
        let bad = [
            ("--release", with(|before| before.profile = "debug".into())),
            ("1.9 on 2 cores", with(|before| before.load = Some(1.9))),
            ("powersave", with(|before| before.governor = Some("powersave".into()))),
            ("flushed to zero", with(|before| before.mxcsr = Some(0x9f80))),
            ("3.00 to 2.00 GHz", of(&quiet, None, Some((3e6, 2e6)))),
            ("5000 times in 10 s", of(&quiet, Some(5000), None)),
        ];
        for (part, warnings) in bad {
            assert!(warnings.len() == 1 && warnings[0].contains(part), "{warnings:?}");
        }
    }
}
