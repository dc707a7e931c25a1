//! Runs that cannot be compared.

use serde_json::Value;

use super::{case, counterpart, pairs};
use crate::report::Record;
use crate::study::reference_structures::{is_obvhs, is_reference};

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
const SAME_UNIT: &str = "on two machines nothing is compared but the ratio to a structure of obvhs over its own triangle test that both runs time, which these do not";
const SAME_INPUT: &str = "measure the old one again on the same scenes and rays";
const SAME_BUILD: &str = "build both alike";

/// On which machines two runs may have been measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Machines {
    /// On one.
    Same,
    /// On any two, if both have timed the same structure of obvhs.
    Any,
}

/// Refuses runs that differ in more than their code and moment, and their machine where that is allowed.
///
/// # Errors
/// The first difference: of machine, instructions, threads, profile, compiler flags, references, scene, rays, or configuration
/// of a structure; or that they have no case in common.
pub fn unlike(old: &[Record], new: &[Record], machines: Machines) -> Result<(), Unlike> {
    let is_unit =
        |(old, new): &(&Record, &Record)| is_reference(old) && old.trace_ns.is_some() && new.trace_ns.is_some();
    let has_unit = pairs(old, new).iter().any(is_unit);
    let advice = if machines == Machines::Any { SAME_UNIT } else { SAME_MACHINE };
    let differ = |what: &str, old: &str, new: &str, advice| {
        if old == new { Ok(()) } else { Err(Unlike { what: what.into(), old: old.into(), new: new.into(), advice }) }
    };
    let mut common = false;
    for before in old {
        let Some(after) = counterpart(before, new) else { continue };
        common = true;
        let (a, b) = (&before.provenance, &after.provenance);
        if machines == Machines::Same || !has_unit {
            differ("the processor", &a.cpu, &b.cpu, advice)?;
            differ("the instruction set of our lanes", &a.simd, &b.simd, advice)?;
            differ("the target", &a.target, &b.target, SAME_BUILD)?;
            differ("the set of instructions for the compiler", &a.target_features, &b.target_features, SAME_BUILD)?;
        }
        differ("the number of threads", &a.threads.to_string(), &b.threads.to_string(), SAME_MACHINE)?;
        let [old, new] = [a, b].map(|p| if p.process_per_epoch { "an epoch each" } else { "all epochs" });
        differ("what a process measures", old, new, SAME_MACHINE)?;
        differ("the clock", &a.clock, &b.clock, SAME_MACHINE)?;
        differ("the profile", &a.profile, &b.profile, SAME_BUILD)?;
        if is_obvhs(&before.structure) {
            differ("the version of obvhs, the reference,", &a.obvhs, &b.obvhs, SAME_BUILD)?;
        }
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
    }
    let whose = |records: &[Record]| records.first().map_or("nothing".into(), case);
    if common {
        Ok(())
    } else {
        Err(Unlike { what: "every case, as the first,".into(), old: whose(old), new: whose(new), advice: SAME_INPUT })
    }
}

fn other_key(old: &Value, new: &Value) -> Option<(String, String, String)> {
    let text = |value: Option<&Value>| value.map_or("absent".into(), Value::to_string);
    let keys = |value: &Value| value.as_object().map(|map| map.keys().cloned().collect::<Vec<_>>()).unwrap_or_default();
    let mut names = keys(old);
    names.extend(keys(new));
    let name = names.into_iter().find(|name| old.get(name) != new.get(name))?;
    let (old, new) = (text(old.get(&name)), text(new.get(&name)));
    Some((name, old, new))
}
