//! The configuration keys of structures.

use serde_json::Value;

use super::Entry;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    pub name: String,
    /// Empty for structures that another crate registers.
    pub meaning: &'static str,
    /// The accepted values, as text for the user.
    pub values: String,
    pub default: String,
}

/// A key has the same meaning in all built-in structures.
const MEANINGS: [(&str, &str); 24] = [
    ("plane", "split plane of a node"),
    ("axis", "split axis of a median"),
    ("stop", "stop rule: when a node becomes a leaf"),
    ("traversal", "traversal algorithm"),
    ("leaf", "L: nodes with fewer triangles become leaves (stop=report, stop=leaf)"),
    ("limit", "leaves have fewer than L triangles (below) or at most L triangles (at-most)"),
    (
        "threshold",
        "T: a split is discarded if at least this share of the triangles would lie on both sides (stop=report); in \
         (0, 1]",
    ),
    (
        "count",
        "the triangles that T is a share of: those in the node (parent: a split that reaches T is discarded), or in \
         each child (child: a child that reaches T is not split further)",
    ),
    (
        "median",
        "the middle of an even number of coordinates: the lower of the two middle values (lower), their mean (mean), \
         or the lower one over distinct vertices, with a shared corner counted once (welded)",
    ),
    ("equal", "the side of a triangle with a vertex in the plane"),
    (
        "exit",
        "when a ray stops: when no nearer hit can follow (nearest), or at the first leaf with any hit (first-leaf: the \
         literal reading of the report, which gives wrong hits)",
    ),
    ("mailbox", "a small hashed mailbox: a ray tests a triangle only once while it is in the mailbox"),
    (
        "traversal_cost",
        "SAH cost of an inner node for the builder; larger values give larger leaves. The reported SAH cost always \
         uses 1.2",
    ),
    ("intersection_cost", "SAH cost of a block of eight triangles; larger values give smaller leaves"),
    ("block_cost", "SAH cost of a block of eight triangles relative to a node; larger values give smaller leaves"),
    ("empty_bonus", "SAH cost reduction for cutting off empty space; in [0, 1)"),
    ("duplication", "maximum number of references, as a multiple of the triangles; at least 1"),
    ("partition", "how triangles are partitioned"),
    ("quality", "build quality: slower builds give better trees"),
    (
        "batch",
        "how a batch of rays is traced: one by one (single), or in packets of rays with the same direction octant \
         (packets)",
    ),
    ("preset", "the builder's preset, from fastest build to best tree"),
    ("rays", "Embree: coherence hint for the rays of a packet"),
    ("packet", "Embree: rays per query: 1, 8 or 16"),
    ("isa", "Embree: the instructions that it may use"),
];

impl Entry {
    pub fn keys(&self) -> Vec<Key> {
        // Another crate may give a key of `MEANINGS` a different meaning.
        let meanings = if self.is_builtin { &MEANINGS[..] } else { &[] };
        let known = |name: &str| meanings.iter().find(|(key, _)| *key == name).map_or("", |(_, meaning)| meaning);
        let key = |(name, value): (&String, &Value)| Key {
            name: name.clone(),
            meaning: known(name),
            values: self.values(name),
            default: shown(value),
        };
        self.config.as_object().into_iter().flatten().map(key).collect()
    }

    pub(super) fn values(&self, key: &str) -> String {
        match &self.config[key] {
            Value::Bool(_) => "true, false".into(),
            Value::Number(n) if n.is_f64() => "number".into(),
            Value::Number(_) if self.takes(key, &Value::from(-1)).is_err() => "integer of at least 0".into(),
            Value::Number(_) => "integer".into(),
            _ => {
                // The error for the unknown word `?` lists the accepted words in backticks.
                let refused = self.takes(key, &Value::from("?")).err().unwrap_or_default();
                let words: Vec<&str> = refused.rsplit("expected").next().unwrap_or("").split('`').collect();
                words.chunks(2).filter_map(|pair| pair.get(1).copied()).collect::<Vec<_>>().join(", ")
            }
        }
    }
}

/// `serde_json` stores an `f32` as an `f64`. Formatting as `f32` avoids extra digits.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(n) => match n.as_f64() {
            Some(x) if n.is_f64() && f64::from(x as f32) == x => (x as f32).to_string(),
            _ => n.to_string(),
        },
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    #[test]
    fn keys_of_our_own_structures_have_meanings_values_and_defaults_as_typed_and_those_of_others_no_meanings() {
        let registry = Registry::builtin();
        for name in ["median-kd", "sah-kd", "sah-hybrid", "sah-bvh", "obvhs-bvh2"] {
            let entry = registry.entries().iter().find(|entry| entry.name == name).unwrap();
            for key in entry.keys() {
                let known = !key.meaning.is_empty();
                assert!(known && !key.values.is_empty() && key.default.len() < 20, "{name}: {key:?}");
            }
            let theirs = Entry { is_builtin: false, ..entry.clone() };
            assert!(theirs.keys().iter().all(|key| key.meaning.is_empty()), "{name}");
        }
    }
}
