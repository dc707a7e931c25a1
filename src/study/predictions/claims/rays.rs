//! Are the rays the report's?

use super::prediction;
use crate::report::number::count;
use crate::report::words::listed;
use crate::study::predictions::{Case, Finding, Inputs, Prediction};
use crate::study::replicate::original::MAIN;

pub(super) fn rays(inputs: &Inputs) -> Prediction {
    // Scenes with creatures of our own have rays of their own.
    let of = inputs.counted.iter().filter(|case| case.scene != "Starters");
    let findings: Vec<Finding> = of
        .map(|case| {
            let difference = case.rays as f64 - case.report_rays as f64;
            Finding::exact(format!("{}: rays more than the report's", case.scene), difference, -2.0, 2.0)
        })
        .collect();
    let off: Vec<String> = findings
        .iter()
        .filter(|f| !f.holds)
        .map(|f| format!("{} is {} rays off", f.what.split(':').next().unwrap_or(""), f.value.estimate))
        .collect();
    let why: String = if off.is_empty() {
        "That is what the same scenes, meshes and rules for casting rays would give; equal counts do not prove them the same.".into()
    } else {
        let total: u64 =
            inputs.counted.iter().filter(|case| case.scene == "Cornellbox").map(|case| case.report_rays).sum();
        let cornell = if off.iter().any(|text| text.starts_with("Cornellbox")) {
            format!(
                " The report does not tell that the back wall of Cornellbox is a mirror; with a mirror there, so few of {} rays are \
                 unexplained.",
                count(total)
            )
        } else {
            String::new()
        };
        format!("{}.{cornell}", listed(&off))
    };
    let moved = |case: &&Case| case.default_rays != case.rays;
    let moved: Vec<String> = inputs
        .counted
        .iter()
        .filter(moved)
        .map(|case| format!("{} ({:+})", case.scene, case.default_rays as f64 - case.rays as f64))
        .collect();
    let exact = if moved.is_empty() {
        String::new()
    } else {
        format!(
            " Counted with a triangle test in single precision, as renderers like the report's have one; the default test, which decides \
             edges exactly, changes {}.",
            listed(&moved)
        )
    };
    let why: String = why + &exact;
    let complete = inputs.counted.len() == MAIN.len();
    prediction(
        1,
        "Ray counts are the report's, within 2 rays (Starters aside: its creatures are our own).",
        findings,
        complete,
        why,
        "sahara study predictions",
    )
}
