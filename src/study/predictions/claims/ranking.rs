//! Does SAH cost put trees in the order of their times?

use std::collections::BTreeMap;

use super::{Bounds, Claim, prediction};
use crate::report::Record;
use crate::report::number::figures;
use crate::study::grouped::grouped;
use crate::study::predictions::rank::{WELL, kendall, mean};
use crate::study::predictions::{Inputs, Prediction, Verdict};
use crate::study::{BRUTE_FORCE, REPORT_TREE, SAH_TREE};

/// A family badly ranked begins here.
const BADLY: f64 = 0.5;

pub(super) fn ranking(inputs: &Inputs) -> Prediction {
    let words = "SAH cost ranks trees of one family well, and trees of different families badly.";
    // One family: the trees of the factorial that are walked alike.
    let mut within: Vec<(String, f64)> = vec![];
    for r in &inputs.attribution {
        for traversal in ["child boxes", "plane intervals"] {
            let trees = r.cells.iter().filter(|cell| cell.traversal == traversal);
            let pairs: Vec<(f64, f64)> = trees.filter_map(|cell| Some((cell.sah_cost?, cell.ns_per_ray))).collect();
            within.extend(kendall(&pairs, |_, _| true).map(|tau| (r.scene.clone(), tau)));
        }
    }
    let least = within.iter().min_by(|a, b| a.1.total_cmp(&b.1)).cloned();
    let [within, across] = [within, across_families(&inputs.compare)].map(by_scene);
    let claims = vec![
        Claim::judged("tau of cost and time within a family, mean of scenes", mean(&within), Bounds::at_least(WELL)),
        Claim::judged("tau across families, mean of scenes", mean(&across), Bounds::at_most(BADLY)),
    ];
    let mut why = vec![];
    if let (Some((scene, tau)), Verdict::Refuted) = (least, claims[0].verdict) {
        why.push(format!("Within the family it is least on {scene}, {}.", figures(tau)));
    }
    if claims[1].verdict == Verdict::Refuted {
        let rest = |r: &&Record| r.structure != REPORT_TREE;
        let others: Vec<Record> = inputs.compare.iter().filter(rest).cloned().collect();
        if let Some(tau) = mean(&by_scene(across_families(&others))) {
            why.push(format!("Across families without the report's tree it is {}.", figures(tau.estimate)));
        }
    }
    for (scenes, what) in [(within.len(), "within a family"), (across.len(), "across families")] {
        if scenes > 0 {
            why.push(format!("Scenes {what}: {scenes}; the interval is for as many others."));
        }
    }
    prediction(7, words, claims, why.join(" "), "sahara study all")
}

/// Kendall's tau over couples of different families, of every scene and kind of rays.
fn across_families(records: &[Record]) -> Vec<(String, f64)> {
    groups(records).iter().filter_map(|group| Some((group[0].scene.clone(), across(group)?))).collect()
}

/// The mean for each scene: its trees are the same whatever the rays, and a stand-in is built after the real mesh, so that taus of one
/// scene are not independent.
fn by_scene(taus: Vec<(String, f64)>) -> Vec<f64> {
    let mut scenes: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (scene, tau) in taus {
        let name = scene.split(" (").next().unwrap_or(&scene).to_owned();
        scenes.entry(name).or_default().push(tau);
    }
    scenes.values().map(|taus| taus.iter().sum::<f64>() / taus.len() as f64).collect()
}

fn groups(records: &[Record]) -> Vec<Vec<&Record>> {
    let timed = records.iter().filter(|r| r.structure != BRUTE_FORCE && r.trace_ns.is_some());
    grouped(timed, |a, b| a.scene_hash == b.scene_hash && a.workload == b.workload)
}

fn across(group: &[&Record]) -> Option<f64> {
    let known: Vec<(&str, (f64, f64))> = group
        .iter()
        .filter_map(|r| Some((kind(&r.structure), (r.counts.sah_cost?, r.trace_ns? / r.rays as f64))))
        .collect();
    let pairs: Vec<(f64, f64)> = known.iter().map(|(_, pair)| *pair).collect();
    kendall(&pairs, |i, j| known[i].0 != known[j].0)
}

/// What a structure has in common with those whose cells and nodes are of the same kind.
fn kind(structure: &str) -> &str {
    match structure {
        REPORT_TREE | SAH_TREE => "binary kd-tree",
        "sah-kd-wide" | "sah-kd-tight" => "wide kd-tree",
        other => other,
    }
}
