//! How much faster is the SAH tree on the hard scenes, and where most?

use super::{Bounds, Claim, prediction};
use crate::report::number::figures;
use crate::report::words::{listed, scene_name};
use crate::scene::WorkloadKind;
use crate::study::attribution::{Attribution, CellResult, HARD};
use crate::study::predictions::{Inputs, Prediction, Verdict};

const COMMAND: &str = "sahara study attribution dragon lucy sponza";

/// The hard scene `name`, the real mesh or the stand-in, on primary rays.
fn form<'a>(inputs: &'a Inputs, name: &str, stand_in: bool) -> Option<&'a Attribution> {
    let mut primary = inputs.attribution.iter().filter(|r| r.workload == WorkloadKind::Primary.name());
    primary.find(|r| r.stand_in == stand_in && r.scene == scene_name(name, stand_in))
}

/// Said of scenes of which no real mesh was measured.
fn stood_in(hard: &[&Attribution]) -> Option<String> {
    let names: Vec<&str> = hard.iter().filter(|r| r.stand_in).map(|r| r.scene.as_str()).collect();
    (!names.is_empty()).then(|| format!("Of real meshes nothing is measured for {}.", listed(&names)))
}

pub(super) fn speedup(inputs: &Inputs) -> Prediction {
    let words = "SAH against the report's tree on Dragon, Lucy, Sponza: expected at least 20x; of which the plane choice alone (same stop \
                 rule, leaf <= 8): 1.2 to 5x.";
    let (mut claims, mut why) = (vec![], vec![]);
    let hard = HARD.map(|name| form(inputs, name, false).or_else(|| form(inputs, name, true)));
    why.extend(stood_in(&hard.into_iter().flatten().collect::<Vec<_>>()));
    for (name, measured) in HARD.into_iter().zip(hard) {
        let scene = measured.map_or(name, |r| &r.scene);
        let of = |figure: fn(&Attribution) -> crate::measure::Estimate| measured.map(figure);
        let whole = Claim::ratio(format!("{scene}: whole"), of(|r| r.time.whole), Bounds::at_least(20.0));
        let plane = Claim::ratio(format!("{scene}: plane alone"), of(|r| r.plane_alone), Bounds::within(1.2, 5.0));
        if let Some(r) = measured {
            why.extend((whole.verdict == Verdict::Refuted).then(|| whole_explained(r)));
            why.extend(plane_explained(r).filter(|_| plane.verdict == Verdict::Refuted));
        }
        claims.extend([whole, plane]);
    }
    prediction(5, words, claims, why.join(" "), COMMAND)
}

fn whole_explained(r: &Attribution) -> String {
    format!(
        "On {} the SAH tree does {} times fewer tests and {} times fewer steps, in {} times less time.",
        r.scene,
        figures(r.tests.whole.estimate),
        figures(r.steps.whole.estimate),
        figures(r.time.whole.estimate)
    )
}

fn plane_explained(r: &Attribution) -> Option<String> {
    let cell = |plane: &str| -> Option<&CellResult> {
        r.cells.iter().find(|c| c.plane == plane && c.stop == "leaf 8" && c.traversal == "plane intervals")
    };
    let (median, sah) = (cell("vertex median cyclic")?, cell("SAH exact")?);
    Some(format!(
        "With the stop rule `leaf 8` in both trees, {} has {} references for each triangle and does {} tests and {} steps a ray against {}, {} and {}.",
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
    let words = "Architectural scenes (Sponza) gain more from SAH than evenly tessellated scans (Dragon, Lucy). Published median/SAH pairs for \
                 BVHs: Sibenik 3.49x, Conference 1.11x.";
    const SCANS: [&str; 2] = ["Dragon", "Lucy"];
    // Real meshes are held against real ones, and stand-ins only where those are not there.
    let of = |stand_in: bool| {
        let scans = SCANS.map(|name| form(inputs, name, stand_in));
        form(inputs, "Sponza", stand_in).filter(|_| scans.iter().any(Option::is_some)).map(|sponza| (sponza, scans))
    };
    let found = of(false).or_else(|| of(true));
    let (mut claims, mut why) = (vec![], vec![]);
    if let Some((sponza, scans)) = found {
        let all: Vec<&Attribution> = std::iter::once(sponza).chain(scans.into_iter().flatten()).collect();
        why.extend(stood_in(&all));
    }
    for (i, name) in SCANS.into_iter().enumerate() {
        let pair = found.and_then(|(sponza, scans)| Some((sponza, scans[i]?)));
        let [architecture, scan] = pair.map_or(["Sponza", name], |(sponza, scan)| [&sponza.scene, &scan.scene]);
        let gain = pair.map(|(sponza, scan)| sponza.time.whole.over(scan.time.whole));
        let claim = Claim::ratio(format!("gain on {architecture} over that on {scan}"), gain, Bounds::at_least(1.0));
        if let (Some((sponza, scan)), Verdict::Refuted) = (pair, claim.verdict) {
            let report = |r: &Attribution| figures(r.cells[0].tests_per_ray);
            let sah = |r: &Attribution| r.cells.last().map_or(String::new(), |cell| figures(cell.tests_per_ray));
            why.push(format!(
                "On {} the report's tree does {} tests a ray and the SAH tree {}, on {} {} and {}.",
                sponza.scene,
                report(sponza),
                sah(sponza),
                scan.scene,
                report(scan),
                sah(scan)
            ));
        }
        claims.push(claim);
    }
    prediction(6, words, claims, why.join(" "), COMMAND)
}
