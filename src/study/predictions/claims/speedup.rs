//! How much faster is the SAH tree on the hard scenes, and where most?

use super::{prediction, quotient};
use crate::report::number::figures;
use crate::report::words::{listed, scene_name};
use crate::study::attribution::{Attribution, CellResult};
use crate::study::predictions::{Finding, Inputs, Prediction};

const HARD: [&str; 3] = ["Dragon", "Lucy", "Sponza"];

/// The hard scene `name`: the real mesh or the stand-in.
fn form<'a>(inputs: &'a Inputs, name: &str, stand_in: bool) -> Option<&'a Attribution> {
    inputs.attribution.iter().find(|r| r.stand_in == stand_in && r.scene == scene_name(name, stand_in))
}

/// Said of scenes of which no real mesh was measured.
fn stood_in(hard: &[&Attribution]) -> Option<String> {
    let names: Vec<&str> = hard.iter().filter(|r| r.stand_in).map(|r| r.scene.as_str()).collect();
    (!names.is_empty()).then(|| format!("Of real meshes nothing is measured for {}.", listed(&names)))
}

pub(super) fn speedup(inputs: &Inputs) -> Prediction {
    let claim = "On Dragon, Lucy and Sponza the SAH tree is at least 20 times as fast as the report's; of that the plane alone, with the same leaves of at \
                 most 8 triangles, gives 1.2 to 5.";
    let mut findings = vec![];
    let hard: Vec<&Attribution> =
        HARD.iter().filter_map(|name| form(inputs, name, false).or_else(|| form(inputs, name, true))).collect();
    for r in &hard {
        findings.push(Finding::within(format!("{}: whole", r.scene), r.time.whole, 20.0, f64::INFINITY));
        findings.push(Finding::within(format!("{}: plane alone", r.scene), r.plane_alone, 1.2, 5.0));
    }
    let fewer = |r: &Attribution| r.time.whole.estimate < 20.0 && r.tests.whole.estimate > r.time.whole.estimate;
    let slow: Vec<String> = hard.iter().copied().filter(|r| fewer(r)).map(whole_explained).collect();
    let large: Vec<String> =
        hard.iter().copied().filter(|r| r.plane_alone.estimate > 5.0).filter_map(plane_explained).collect();
    let mut why: Vec<String> = stood_in(&hard).into_iter().collect();
    if !slow.is_empty() {
        why.push(format!(
            "Tests fall by more than time does, steps by less (eight triangles are tested at once): {}.",
            listed(&slow)
        ));
    }
    if !large.is_empty() {
        why.push(format!("With leaves of at most 8 in both trees, {}.", listed(&large)));
    }
    let complete = hard.len() == HARD.len();
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
    // Real meshes are held against real ones, and stand-ins only where those are not there.
    let of = |stand_in: bool| {
        let scans: Vec<&Attribution> =
            ["Dragon", "Lucy"].iter().filter_map(|name| form(inputs, name, stand_in)).collect();
        form(inputs, "Sponza", stand_in).filter(|_| !scans.is_empty()).map(|sponza| (sponza, scans))
    };
    let mut findings = vec![];
    let mut why = vec![];
    let mut stand_ins = None;
    if let Some((sponza, scans)) = of(false).or_else(|| of(true)) {
        stand_ins = stood_in(&[&[sponza], &scans[..]].concat());
        for scan in scans {
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
    let gains = (!why.is_empty()).then(|| format!("Where the scan gains more: {}.", listed(&why)));
    let why = stand_ins.into_iter().chain(gains).collect::<Vec<_>>().join(" ");
    let complete = findings.len() == 2;
    prediction(6, claim, findings, complete, why, "sahara study attribution dragon lucy sponza")
}
