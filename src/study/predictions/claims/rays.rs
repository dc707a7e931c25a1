//! Are the rays the report's?

use super::{Bounds, Claim, prediction};
use crate::measure::Estimate;
use crate::report::number::count;
use crate::report::words::listed;
use crate::study::predictions::{Inputs, PictureCounts, Prediction, Verdict};
use crate::study::replicate::original::main_scenes;

/// Its creatures must not be copied: its rays are our own.
const OWN: &str = "Starters";

pub(super) fn rays(inputs: &Inputs) -> Prediction {
    let difference = |scene: &str| {
        let case = inputs.counted.iter().find(|case| case.scene == scene)?;
        Some(case.rays as f64 - case.report_rays as f64)
    };
    let scenes = || main_scenes().into_iter().filter(|&scene| scene != OWN);
    let claims: Vec<Claim> = scenes()
        .map(|scene| {
            let exact = inputs.counted.iter().find(|case| case.scene == scene && case.default_rays != case.rays);
            let exact = exact.map_or(String::new(), |case| {
                format!(" ({:+} with the exact test)", case.default_rays as f64 - case.report_rays as f64)
            });
            let what = format!("{scene}: rays more than the report's{exact}");
            Claim::number(what, difference(scene).map(Estimate::exact), Bounds::within(-2.0, 2.0))
        })
        .collect();
    let refuted = scenes().zip(&claims).filter(|(_, claim)| claim.verdict == Verdict::Refuted);
    let off: Vec<String> =
        refuted.map(|(scene, _)| format!("{scene} is {} rays off", difference(scene).unwrap_or_default())).collect();
    let why: String = if off.is_empty() {
        "Equal counts do not prove the scenes, meshes and rules the same.".into()
    } else {
        let total: u64 =
            inputs.counted.iter().filter(|case| case.scene == "Cornellbox").map(|case| case.report_rays).sum();
        let cornell = if off.iter().any(|text| text.starts_with("Cornellbox")) {
            format!(
                " The report does not tell that the back wall of Cornellbox is a mirror: that is our inference. With a mirror there, so few of {} \
                 rays are unexplained.",
                count(total)
            )
        } else {
            String::new()
        };
        format!("{}.{cornell}", listed(&off))
    };
    let moved = |case: &&PictureCounts| case.default_rays != case.rays;
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
    prediction(1, "Ray counts as in `report/rays.tsv`, within 2.", claims, why, "sahara study predictions")
}
