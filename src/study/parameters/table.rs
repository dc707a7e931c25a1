//! The sweep as tables for people.

use super::result::{Difference, Parameters, Setting};
use crate::measure::LEVEL;
use crate::report::number::figures;
use crate::report::words::{explained, interval};
use crate::report::{Cell, Table, Tone};

/// All settings, then the answer in words.
pub fn tables(result: &Parameters) -> Vec<Table> {
    let row = |s: &Setting| {
        let tone = if s.verdict == Difference::Faster { Tone::Best } else { Tone::Plain };
        vec![
            format!("{} {} / {}", s.scene, s.leaf, s.threshold).into(),
            figures(s.seconds).into(),
            figures(s.report_s).into(),
            s.times.map(interval).into(),
            if s.verdict == Difference::Default { Cell::blank() } else { figures(s.report_times).into() },
            figures(s.tests_per_ray).into(),
            Cell::from(s.verdict.name()).with(tone),
        ]
    };
    let title = format!("The report's sweep, against its default {}", Parameters::default_name());
    let columns = ["scene, L / T", "seconds", "report", "time [95%]", "report", "tests/ray", "verdict"];
    vec![explained(Table::new(title, columns, result.settings.iter().map(row)).noted(notes(result)))]
}

fn notes(result: &Parameters) -> Vec<String> {
    let settings = || result.settings.iter();
    let count = |verdict: Difference| settings().filter(|s| s.verdict == verdict).count();
    let mut notes = vec![format!(
        "time: as a multiple of the default's, over {} epochs [another run of the same plan]. {} settings are compared with the default; a \
         difference is real when its interval excludes 1 at a level that leaves all of them together {:.0} % (Holm's correction). A/A noise, in \
         all intervals: a factor of {:.3}.",
        result.epochs,
        result.comparisons,
        LEVEL * 100.0,
        result.aa_noise
    )];
    if result.epochs < 2 {
        notes.push("One epoch tells nothing of how settings vary from build to build: measure two or more.".into());
    }
    notes.push(format!(
        "Real: {} faster, {} slower than the default; {} not shown to differ; {} the same tree as the default.",
        count(Difference::Faster),
        count(Difference::Slower),
        count(Difference::NotShown),
        count(Difference::SameTree),
    ));
    notes.extend(control(result));
    notes.extend(agreement(result));
    notes
}

/// What the control shows: all settings of Cube are one tree.
fn control(result: &Parameters) -> Option<String> {
    let cube: Vec<&Setting> =
        result.settings.iter().filter(|s| s.scene == "Cube" && s.verdict == Difference::SameTree).collect();
    let farthest =
        |times: &dyn Fn(&Setting) -> f64| cube.iter().map(|&s| libm::fabs(libm::log(times(s)))).fold(0.0, f64::max);
    let ours = farthest(&|s| s.times.map_or(1.0, |times| times.estimate));
    let theirs = farthest(&|s| s.report_times);
    let percent = |log: f64| figures(100.0 * (libm::exp(log) - 1.0));
    (!cube.is_empty()).then(|| {
        format!(
            "Control: on Cube all settings are one leaf, so every difference is noise: up to {} % here, up to {} % in the report.",
            percent(ours),
            percent(theirs)
        )
    })
}

/// How often the report's single runs show what is real.
fn agreement(result: &Parameters) -> Option<String> {
    let real: Vec<&Setting> =
        result.settings.iter().filter(|s| matches!(s.verdict, Difference::Faster | Difference::Slower)).collect();
    let agree = real.iter().filter(|s| (s.report_times < 1.0) == (s.verdict == Difference::Faster)).count();
    let words = |s: &&&Setting| format!("{} {} / {}", s.scene, s.leaf, s.threshold);
    let others: Vec<String> = real
        .iter()
        .filter(|s| (s.report_times < 1.0) != (s.verdict == Difference::Faster))
        .map(|s| words(&s))
        .collect();
    (!real.is_empty()).then(|| {
        let tail = if others.is_empty() { String::new() } else { format!("; not of {}", others.join(", ")) };
        format!("The report's own seconds have the sign of {agree} of the {} real differences{tail}.", real.len())
    })
}
