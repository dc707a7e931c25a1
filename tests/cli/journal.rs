//! The journals that studies leave.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sahara::study::journal::files;
use serde_json::Value;

use super::command::json;

/// The cases that a study has measured; none where there is no journal.
pub fn cases(runs: &Path, study: &str) -> Vec<PathBuf> {
    files(&runs.join(study)).unwrap_or_default()
}

/// What no clock decides, of every case: by its key. A case that is there twice is found out.
pub fn answers(runs: &Path, study: &str) -> BTreeMap<String, Value> {
    let mut answers = BTreeMap::new();
    for path in cases(runs, study) {
        let mut file = json(path);
        let mut case = file["case"].take();
        if !case["epoch"]["structures"].is_null() {
            case = case["epoch"].take();
        }
        case["circumstances"] = Value::Null;
        for structure in case["structures"].as_array_mut().unwrap() {
            structure["build_ns"] = Value::Null;
            structure["details"]["build_peak_bytes"] = Value::Null;
            for rays in structure["rays"].as_array_mut().unwrap() {
                rays["ns"] = rays["ns"].as_array().unwrap().len().into();
                rays["details"]["instructions_per_ray"] = Value::Null;
                rays["details"]["branch_misses_per_ray"] = Value::Null;
                rays["parts"].as_array_mut().unwrap().iter_mut().for_each(|part| part["ns"] = Value::Null);
            }
        }
        let key = file["key"].as_str().unwrap().to_owned();
        assert!(answers.insert(key.clone(), case).is_none(), "{key} is there twice");
    }
    answers
}
