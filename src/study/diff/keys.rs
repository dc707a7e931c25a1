//! Finds configuration keys and settings that differ between runs.

use serde_json::{Map, Value};

pub fn other_keys(old: &Value, new: &Value) -> Vec<(String, String, String)> {
    // Two builds of an external program are comparable, so the keys `build` and `command` are ignored.
    let keys = |value: &Value| {
        let mut map = value.as_object().cloned().unwrap_or_default();
        map.retain(|key, _| key != "build" && key != "command");
        map
    };
    differences(&keys(old), &keys(new))
}

/// Returns the name, the old value and the new value of each difference.
pub fn differences(old: &Map<String, Value>, new: &Map<String, Value>) -> Vec<(String, String, String)> {
    let text = |value: Option<&Value>| match value {
        None => "absent".to_owned(),
        Some(Value::String(text)) => text.clone(),
        Some(other) => other.to_string(),
    };
    let names = old.keys().chain(new.keys().filter(|name| !old.contains_key(*name)));
    let different = names.filter(|name| old.get(*name) != new.get(*name));
    different.map(|name| (name.clone(), text(old.get(name)), text(new.get(name)))).collect()
}
