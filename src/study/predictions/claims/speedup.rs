//! How much faster is the SAH tree on the hard scenes, and where most?

use super::{prediction, quotient};
use crate::report::number::figures;
use crate::report::words::{listed, scene_name};
use crate::study::attribution::{Attribution, CellResult};
use crate::study::predictions::{Finding, Inputs, Prediction};

const HARD: [&str; 3] = ["Dragon", "Lucy", "Sponza"];

/// The hard scenes, real or stood in for.
fn hard(inputs: &Inputs) -> impl Iterator<Item = &Attribution> {
    inputs.attribution.iter().filter(|r| HARD.iter().any(|name| r.scene == *name || r.scene == scene_name(name, true)))
}

pub(super) fn speedup(inputs: &Inputs) -> Prediction {
    let claim = "On Dragon, Lucy and Sponza the SAH tree is at least 20 times as fast as the report's; of that the plane alone, with the same leaves of at \
                 most 8 triangles, gives 1.2 to 5.";
    let mut findings = vec![];
    for r in hard(inputs) {
        findings.push(Finding::within(format!("{}: whole", r.scene), r.time.whole, 20.0, f64::INFINITY));
        findings.push(Finding::within(format!("{}: plane alone", r.scene), r.plane_alone, 1.2, 5.0));
    }
    let slow: Vec<String> = hard(inputs).filter(|r| r.time.whole.estimate < 20.0).map(whole_explained).collect();
    let large: Vec<String> =
        hard(inputs).filter(|r| r.plane_alone.estimate > 5.0).filter_map(plane_explained).collect();
    let mut why = vec![];
    if !slow.is_empty() {
        why.push(format!(
            "Fewer tests save less than in proportion, since eight triangles are tested at once: {}.",
            listed(&slow)
        ));
    }
    if !large.is_empty() {
        why.push(format!(
            "Small leaves do not help the median plane, which cuts triangles instead of parting them: with leaves of at most 8, {}.",
            listed(&large)
        ));
    }
    let complete = HARD.iter().all(|name| hard(inputs).any(|r| r.scene.starts_with(name)));
    prediction(5, claim, findings, complete, why.join(" "), "sahara study attribution dragon lucy sponza")
}

fn whole_explained(r: &Attribution) -> String {
    format!(
        "on {} the SAH tree does {} times fewer tests and {} times fewer steps",
        r.scene,
        figures(r.tests.whole.estimate),
        figures(r.steps.whole.estimate)
    )
}

fn plane_explained(r: &Attribution) -> Option<String> {
    let cell = |plane: &str| -> Option<&CellResult> {
        r.cells.iter().find(|c| c.plane == plane && c.stop == "leaf 8" && c.traversal == "plane intervals")
    };
    let (median, sah) = (cell("vertex median cyclic")?, cell("SAH exact")?);
    Some(format!(
        "{} has {} references for each triangle and does {} tests and {} steps a ray against {}, {} and {}",
        r.scene,
        figures(median.duplication),
        figures(median.tests_per_ray),
        figures(median.steps_per_ray),
        figures(sah.duplication),
        figures(sah.tests_per_ray),
        figures(sah.steps_per_ray)
    ))
}

pub(super) fn architecture(inputs: &Inputs) -> Prediction {
    let claim = "An architectural scene (Sponza) gains more from SAH than evenly tessellated scans (Dragon, Lucy).";
    let mut findings = vec![];
    let mut why = vec![];
    for stand_in in [false, true] {
        let of = |name: &str| hard(inputs).find(|r| r.stand_in == stand_in && r.scene.starts_with(name));
        let Some(sponza) = of("Sponza") else { continue };
        for scan in [of("Dragon"), of("Lucy")].into_iter().flatten() {
            let ratio = quotient(sponza.time.whole, scan.time.whole);
            let finding = Finding::within(
                format!("gain on {} over that on {}", sponza.scene, scan.scene),
                ratio,
                1.0,
                f64::INFINITY,
            );
            if !finding.holds {
                let report = |r: &Attribution| figures(r.cells[0].tests_per_ray);
                let sah = |r: &Attribution| r.cells.last().map_or(String::new(), |cell| figures(cell.tests_per_ray));
                why.push(format!(
                    "on {} the report's tree does {} tests a ray and the SAH tree {}, on {} {} and {}",
                    sponza.scene,
                    report(sponza),
                    sah(sponza),
                    scan.scene,
                    report(scan),
                    sah(scan)
                ));
            }
            findings.push(finding);
        }
    }
    let why = if why.is_empty() { String::new() } else { format!("Where the scan gains more: {}.", listed(&why)) };
    let complete = findings.len() >= 2;
    prediction(6, claim, findings, complete, why, "sahara study attribution dragon lucy sponza")
}
