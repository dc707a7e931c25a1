//! Runs that cannot be compared.

use serde_json::{Map, Value};

use super::{Side, case, counterpart, pairs};
use crate::report::number::count;
use crate::request::is_obvhs;
use crate::study::Case;
use crate::study::compare::is_reference;

/// Why two runs cannot be compared: what differs, in the old run and in the new.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the runs are unlike: {what} is {old} in the old and {new} in the new: {advice}")]
pub struct Unlike {
    pub what: String,
    pub old: String,
    pub new: String,
    advice: &'static str,
}

const SAME_MACHINE: &str = "measure both on the same machine, with the same options";
const SAME_UNIT: &str = "on two machines only ratios to a structure of obvhs over its own triangle test are compared, and these \
                         runs have no such structure in common";
const SAME_INPUT: &str = "measure the old one again on the same scenes and rays";
const SAME_BUILD: &str = "build both alike";
const SAME_RAYS: &str = "measure both with --budget none, which times all rays";

/// Refuses runs that differ in more than their code and moment, their settings, and their machine where no `gate` is
/// asked for and both time the same structure of obvhs.
///
/// # Errors
/// The first difference: of machine, instructions, profile, compiler flags, references, scene, rays, or configuration of a
/// structure; or that they have no case in common.
pub fn unlike(old: &Side, new: &Side, gate: bool) -> Result<(), Unlike> {
    let pairs = pairs(&old.all, &new.all);
    let has_unit = pairs.iter().any(|(old, new)| is_reference(old) && old.trace_ns.is_some() && new.trace_ns.is_some());
    let advice = if gate { SAME_MACHINE } else { SAME_UNIT };
    let differ = |what: &str, old: &str, new: &str, advice| {
        if old == new { Ok(()) } else { Err(Unlike { what: what.into(), old: old.into(), new: new.into(), advice }) }
    };
    if pairs.is_empty() {
        let whose = |side: &Side| side.all.first().map_or("nothing".into(), case);
        let (old, new) = (whose(old), whose(new));
        return Err(Unlike { what: "every case, as the first,".into(), old, new, advice: SAME_INPUT });
    }
    let (a, b) = (&old.provenance, &new.provenance);
    if gate || !has_unit {
        differ("the processor", &a.cpu, &b.cpu, advice)?;
        differ("the instruction set of our lanes", &a.simd, &b.simd, advice)?;
        differ("the target", &a.target, &b.target, SAME_BUILD)?;
        differ("the set of instructions for the compiler", &a.target_features, &b.target_features, SAME_BUILD)?;
    }
    let words = [a, b].map(|p| if p.process_per_epoch { "an epoch each" } else { "all epochs" });
    differ("what a process measures", words[0], words[1], SAME_MACHINE)?;
    differ("the clock", &a.clock, &b.clock, SAME_MACHINE)?;
    differ("the profile", &a.profile, &b.profile, SAME_BUILD)?;
    if pairs.iter().any(|(old, _)| is_obvhs(&old.structure)) {
        differ("the version of obvhs, the reference,", &a.obvhs, &b.obvhs, SAME_BUILD)?;
    }
    for before in &old.all {
        let Some(after) = counterpart(before, &new.all) else { continue };
        let name = |what: &str| format!("{what} of {}", case(before));
        let scene = format!("the hash of the scene {}", before.scene);
        differ(&scene, &before.scene_hash, &after.scene_hash, SAME_INPUT)?;
        let rays = format!("the hash of the {} rays of {}", before.workload, before.scene);
        differ(&rays, &before.workload_hash, &after.workload_hash, SAME_INPUT)?;
        differ(&name("the query"), before.query.name(), after.query.name(), SAME_INPUT)?;
        differ(&name("the triangle test"), &before.triangle_test, &after.triangle_test, SAME_MACHINE)?;
        if let Some((key, a, b)) = other_key(&before.config, &after.config) {
            differ(&format!("the key {key} of {}", before.label), &a, &b, SAME_MACHINE)?;
        }
        if gate && before.trace_ns.is_some() && after.trace_ns.is_some() {
            let rays = |n: usize| count(n as u64);
            differ(&name("the number of timed rays"), &rays(before.rays), &rays(after.rays), SAME_RAYS)?;
        }
    }
    Ok(())
}

fn other_key(old: &Value, new: &Value) -> Option<(String, String, String)> {
    let none = Map::new();
    // What tells one build of a program from another is what a comparison is about.
    let keys = |value: &'_ Value| -> Map<String, Value> {
        let mut map = value.as_object().unwrap_or(&none).clone();
        map.remove("build");
        map.remove("command");
        map
    };
    differences(&keys(old), &keys(new)).into_iter().next()
}

/// What differs: name, old and new.
fn differences(old: &Map<String, Value>, new: &Map<String, Value>) -> Vec<(String, String, String)> {
    let text = |value: Option<&Value>| match value {
        None => "absent".to_owned(),
        Some(Value::String(text)) => text.clone(),
        Some(other) => other.to_string(),
    };
    let names = old.keys().chain(new.keys().filter(|name| !old.contains_key(*name)));
    let different = names.filter(|name| old.get(*name) != new.get(*name));
    different.map(|name| (name.clone(), text(old.get(name)), text(new.get(name)))).collect()
}

/// Settings that differ, such as threads, as `threads 1 and 2`.
pub fn settings(old: &Case, new: &Case) -> Vec<String> {
    let all = differences(&old.group(), &new.group());
    all.into_iter().map(|(name, old, new)| format!("{name} {old} and {new}")).collect()
}
