//! The measured cases that a report reads. All cases have the same study and [group](Case::group), and were measured by
//! one build on one machine.
#![doc = include_str!("SCHEMA.md")]

use serde::{Deserialize, Serialize};

use super::epoch::{Checked, Structure};
use super::journal::JournalError;
use super::{Case, Epoch, Verdict};
use crate::measure::Provenance;
use crate::registry::plain_name;
use crate::report::Failure;
use crate::report::words::{distinct, each_once};
use crate::request::is_external;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    pub case: Case,
    pub epoch: Epoch,
}

/// `--export-json` writes a dataset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dataset {
    pub schema: u32,
    pub provenance: Provenance,
    pub measured: Vec<Measured>,
    /// Sentences, for example about missing measurements.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}

#[derive(Clone, Debug)]
pub struct SceneEpochs<'a> {
    /// The first case of the scene in the dataset.
    pub case: &'a Case,
    /// Not empty. Sorted by epoch number.
    pub epochs: Vec<&'a Epoch>,
}

impl Dataset {
    /// Version of the format of datasets and case files.
    pub const SCHEMA: u32 = 4;

    pub fn new(provenance: Provenance, measured: Vec<Measured>) -> Self {
        Self { schema: Self::SCHEMA, provenance, measured, notes: vec![] }
    }

    pub fn study(&self) -> Option<&str> {
        Some(self.measured.first()?.case.study.as_str())
    }

    pub fn scenes(&self) -> Vec<SceneEpochs<'_>> {
        let mut scenes: Vec<SceneEpochs> = vec![];
        for Measured { case, epoch } in &self.measured {
            match scenes.iter_mut().find(|scene| scene.case.is_of_scene(case)) {
                Some(scene) => scene.epochs.push(epoch),
                None => scenes.push(SceneEpochs { case, epochs: vec![epoch] }),
            }
        }
        scenes.iter_mut().for_each(|scene| scene.epochs.sort_by_key(|epoch| epoch.epoch));
        scenes
    }

    pub fn failures(&self) -> Vec<Failure> {
        each_once(self.measured.iter().flat_map(|measured| measured.epoch.failures()))
    }

    pub fn verdicts(&self) -> Vec<String> {
        let is_own = |own: &&Structure| !own.is_twin() && is_external(&own.name, &own.triangle_test);
        let all = || self.measured.iter().flat_map(|own| &own.epoch.structures).filter(is_own);
        let sentence = |label: String| {
            let own = all().filter(|own| own.label == label).flat_map(|own| &own.rays);
            let checked = own.filter_map(|rays| rays.checked.as_ref()).map(Checked::verdict);
            checked.fold(Verdict::default(), Verdict::and).sentence(plain_name(&label))
        };
        distinct(all().map(|own| &own.label)).into_iter().map(sentence).collect()
    }

    pub fn commands(&self) -> Vec<&str> {
        each_once(self.measured.iter().map(|measured| measured.case.command.as_str()))
    }

    pub fn to_json(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec(self).expect("a dataset has text keys");
        bytes.push(b'\n');
        bytes
    }

    /// Ignores the schema version.
    pub fn is_dataset(value: &serde_json::Value) -> bool {
        ["schema", "provenance", "measured"].iter().all(|field| value.get(field).is_some())
    }

    pub fn read(path: &std::path::Path, value: serde_json::Value) -> Result<Self, JournalError> {
        Self::check_schema(path, &value)?;
        serde_json::from_value(value).map_err(|cause| JournalError::damaged(path, &cause))
    }

    pub(super) fn check_schema(path: &std::path::Path, value: &serde_json::Value) -> Result<(), JournalError> {
        let (there, here) = (value.get("schema").and_then(serde_json::Value::as_u64).unwrap_or(0) as u32, Self::SCHEMA);
        if there == here { Ok(()) } else { Err(JournalError::Schema { path: path.into(), there, here }) }
    }
}

#[cfg(test)]
pub(super) mod tests;
