//! Rejects runs that cannot be compared.

use super::keys::{differences, other_keys};
use super::{Side, cell_title, has_reference_role, pairs};
use crate::measure::Provenance;
use crate::report::number::{count, duration};
use crate::report::words::each_once;
use crate::request::is_obvhs;
use crate::study::measurement::Measurement;
use crate::study::{Case, Dataset};

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the runs are not comparable: {what} differs ({old} in the old run, {new} in the new): {advice}")]
pub struct Unlike {
    pub what: String,
    pub old: String,
    pub new: String,
    advice: &'static str,
}

const SAME_MACHINE: &str = "measure both on the same machine, with the same options";
const SAME_PROCESSES: &str = "measure both with --in-process, or both without";
const SAME_UNIT: &str = "two machines are compared by ratios to an obvhs structure with its own triangle test: measure \
                         such a structure in both runs";
const SAME_INPUT: &str = "measure the old run again on the same scenes and rays";
const SAME_SCENE: &str = "the hash covers the mesh, camera, lights and picture size: measure the old run again with the same scene \
                          and --size";
const SAME_BUILD: &str = "build both in the same way";
const SAME_RAYS: &str = "measure both with --budget none, which times all rays";
const GATE_REFERENCE: &str = "a gate needs a reference that both runs time in the same rounds: name such a structure with --reference, or \
                         measure both with --budget none, which includes obvhs-bvh2";

fn differ(what: &str, old: &str, new: &str, advice: &'static str) -> Result<(), Unlike> {
    if old == new { Ok(()) } else { Err(Unlike { what: what.into(), old: old.into(), new: new.into(), advice }) }
}

/// Returns an error if the runs are not comparable. With `gate`, both runs must be from one machine. Without `gate`,
/// runs from different machines need a reference with times in both runs. Code, date and settings may differ, and so
/// may keys and triangle tests of structures that are not references.
pub fn unlike(old: &Side, new: &Side, gate: bool) -> Result<(), Unlike> {
    let pairs = pairs(&old.all, &new.all);
    let are_timed = |old: &Measurement, new: &Measurement| old.trace_ns.is_some() && new.trace_ns.is_some();
    let has_unit = pairs.iter().any(|(old, new)| has_reference_role(old) && are_timed(old, new));
    if pairs.is_empty() {
        let [old, new] = [old, new].map(|side| side.all.first().map_or("none".into(), cell_title));
        let what = "no structure is in both runs on the same scene and workload; the first cell".into();
        return Err(Unlike { what, old, new, advice: SAME_INPUT });
    }
    let (a, b) = (&old.provenance, &new.provenance);
    if gate || !has_unit {
        other_machine(a, b, if gate { SAME_MACHINE } else { SAME_UNIT })?;
    }
    let words = [a, b].map(|p| if p.process_per_epoch { "one per epoch" } else { "one for all epochs" });
    differ("the number of processes", words[0], words[1], SAME_PROCESSES)?;
    differ("the clock", &a.clock, &b.clock, SAME_MACHINE)?;
    differ("the profile", &a.profile, &b.profile, SAME_BUILD)?;
    if pairs.iter().any(|(old, _)| is_obvhs(&old.structure)) {
        differ("the version of obvhs, the reference,", &a.obvhs, &b.obvhs, SAME_BUILD)?;
    }
    for (before, after) in &pairs {
        let name = |what: &str| format!("{what} of {}", cell_title(before));
        let scene = format!("the hash of the scene {}", before.scene);
        differ(&scene, &before.scene_hash, &after.scene_hash, SAME_SCENE)?;
        let rays = format!("the hash of the {} rays of {}", before.workload, before.scene);
        differ(&rays, &before.workload_hash, &after.workload_hash, SAME_INPUT)?;
        differ(&name("the query"), before.query.name(), after.query.name(), SAME_INPUT)?;
        for (key, a, b) in other_keys(&before.config, &after.config).iter().filter(|_| has_reference_role(before)) {
            differ(&format!("the key {key} of {}", before.label), a, b, SAME_MACHINE)?;
        }
        if gate && are_timed(before, after) {
            let [a, b] = [before, after].map(|own| count(own.rays as u64));
            differ(&name("the number of timed rays"), &a, &b, SAME_RAYS)?;
        }
    }
    if gate && !has_unit {
        let [old, new] = [old, new].map(|side| {
            let timed = side.all.iter().filter(|own| has_reference_role(own) && own.trace_ns.is_some());
            let labels = each_once(timed.map(|own| own.label.as_str()));
            if labels.is_empty() { "missing".to_owned() } else { labels.join(" and ") }
        });
        return Err(Unlike { what: "the reference".into(), old, new, advice: GATE_REFERENCE });
    }
    Ok(())
}

fn other_machine(old: &Provenance, new: &Provenance, advice: &'static str) -> Result<(), Unlike> {
    differ("the processor", &old.cpu, &new.cpu, advice)?;
    differ("the SIMD instruction set", &old.simd, &new.simd, advice)?;
    differ("the target", &old.target, &new.target, SAME_BUILD)?;
    differ("the set of target features", &old.target_features, &new.target_features, SAME_BUILD)
}

/// Rejects planned cases that a gate could not compare with the run `old`.
pub fn unlike_plan(old: &Dataset, cases: &[Case], here: &Provenance) -> Result<(), Unlike> {
    other_machine(&old.provenance, here, SAME_MACHINE)?;
    differ("the version of obvhs, the reference,", &old.provenance.obvhs, &here.obvhs, SAME_BUILD)?;
    for new in cases.iter().filter(|case| case.epoch == 0) {
        let title = new.scene_title();
        let Some(old) = old.measured.iter().map(|own| &own.case).find(|old| old.scene_title() == title) else {
            return differ(&format!("the scene {title}"), "missing", "measured", SAME_INPUT);
        };
        differ(&format!("the hash of the scene {title}"), &old.scene.hash, &new.scene.hash, SAME_SCENE)?;
        let rays = |case: &Case| serde_json::to_string(&case.workloads).expect("workloads are text");
        differ(&format!("the ray selection of {title}"), &rays(old), &rays(new), SAME_INPUT)?;
        let (a, b) = (&old.settings, &new.settings);
        differ("the seed", &a.seed.to_string(), &b.seed.to_string(), SAME_INPUT)?;
        differ(
            "the structure that finds the origins of secondary rays",
            &a.secondary_ray_structure,
            &b.secondary_ray_structure,
            SAME_INPUT,
        )?;
        let [a, b] = [a, b].map(|own| own.budget_ns.map_or("none".to_owned(), |ns| duration(ns as f64)));
        differ("the budget", &a, &b, SAME_RAYS)?;
    }
    Ok(())
}

pub fn settings(old: &Case, new: &Case) -> Vec<String> {
    let all = differences(&old.group(), &new.group());
    all.into_iter().map(|(name, old, new)| format!("{name} {old} and {new}")).collect()
}
