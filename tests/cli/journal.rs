//! Reads the journals and exports of studies.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sahara::study::journal::files;
use serde_json::Value;

use super::command::json;

/// The files in the journal of a study. Empty if the study has no journal.
pub fn cases(runs: &Path, study: &str) -> Vec<PathBuf> {
    files(&runs.join(study)).unwrap_or_default()
}

/// The cases of a study, by scene and epoch. Times, peak memory and environment are removed.
pub fn answers(runs: &Path, study: &str) -> BTreeMap<String, Value> {
    let mut answers = BTreeMap::new();
    for path in cases(runs, study) {
        let mut file = json(path);
        let mut epoch = file["epoch"].take();
        let key = format!("{} {}", epoch["scene"], epoch["epoch"]);
        epoch["environment"] = Value::Null;
        for structure in epoch["structures"].as_array_mut().unwrap() {
            structure["build_ns"] = Value::Null;
            structure["build_peak_bytes"] = Value::Null;
            for rays in structure["rays"].as_array_mut().unwrap() {
                rays["ns"] = rays["ns"].as_array().unwrap().len().into();
                rays["parts"].as_array_mut().unwrap().iter_mut().for_each(|part| part["ns"] = Value::Null);
            }
        }
        assert!(answers.insert(key.clone(), epoch).is_none(), "{key} occurs twice");
    }
    answers
}

/// One row per scene, structure and workload of epoch 0. Structures with the role `twin` have no row.
pub fn rows(export: impl AsRef<Path>) -> Vec<Value> {
    let mut rows = vec![];
    let export = json(export);
    for measured in export["measured"].as_array().unwrap() {
        let epoch = &measured["epoch"];
        for structure in epoch["structures"].as_array().unwrap() {
            let is_twin = structure["role"] == "twin";
            for rays in structure["rays"].as_array().unwrap().iter().filter(|_| !is_twin && epoch["epoch"] == 0) {
                let mut row = structure.as_object().unwrap().clone();
                row.remove("rays");
                row.extend(rays.as_object().unwrap().clone());
                for field in ["scene", "scene_hash", "triangles"] {
                    row.insert(field.into(), epoch[field].clone());
                }
                rows.push(row.into());
            }
        }
    }
    rows
}
