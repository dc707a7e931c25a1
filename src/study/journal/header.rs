use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use super::JournalError;
use crate::measure::{Provenance, checksum};
use crate::study::plan::settings_map;

/// What a case is of, and where it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    pub study: String,
    /// Everything that a case's result depends on and its key does not tell, by the name of the option.
    pub settings: Map<String, Value>,
    pub provenance: Provenance,
}

impl Header {
    /// Of this process.
    ///
    /// # Panics
    /// If `settings` does not serialise to a map of names.
    pub fn new(study: &str, settings: &impl Serialize, provenance: Provenance) -> Self {
        Self { study: study.into(), settings: settings_map(settings), provenance }
    }

    /// Whether a run with this header may take a case with the header `there` for its own: those of other settings, of another build
    /// or of another machine are not what this run would measure.
    pub(super) fn admits(&self, there: &Self, path: &Path) -> Result<(), JournalError> {
        if there.study != self.study {
            let (there, here) = (there.study.clone(), self.study.clone());
            return Err(JournalError::Study { path: path.into(), there, here });
        }
        let settings = changes(&there.settings, &self.settings);
        if !settings.is_empty() {
            return Err(JournalError::Settings { path: path.into(), differences: settings });
        }
        let machine = changes(&there.machine(), &self.machine());
        if !machine.is_empty() {
            return Err(JournalError::Machine { path: path.into(), differences: machine });
        }
        Ok(())
    }

    /// Tells journals of other settings, builds, machines or cases apart; `keys` are those of all cases that are to be measured.
    pub fn id<'a>(&self, keys: impl IntoIterator<Item = &'a str>) -> String {
        let keys: Vec<&str> = keys.into_iter().collect();
        let text = serde_json::to_string(&(&self.settings, self.machine(), keys)).expect("settings have text keys");
        format!("{:016x}", checksum(text.bytes().map(u64::from)))
    }

    /// What makes a program faster or slower, of all that is known of it. Hosts of one processor are one machine: their cases are
    /// epochs of one measurement, and samples are paired within one case only.
    pub(super) fn machine(&self) -> Map<String, Value> {
        let Self { provenance: p, .. } = self;
        let parts: [(&str, Value); 10] = [
            ("version", p.version.as_str().into()),
            ("commit", p.commit.as_str().into()),
            ("build", p.build.as_str().into()),
            ("rustc", p.rustc.as_str().into()),
            ("profile", p.profile.as_str().into()),
            ("target_features", p.target_features.as_str().into()),
            ("simd", p.simd.as_str().into()),
            ("cpu", p.cpu.as_str().into()),
            ("threads", p.threads.into()),
            ("process_per_epoch", p.process_per_epoch.into()),
        ];
        parts.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }
}

/// `runs was 5 and is 7, seed was 1 and is 2`: what was there and is not so here.
fn changes(there: &Map<String, Value>, here: &Map<String, Value>) -> String {
    differences(there, here, |there, here| format!("was {there} and is {here}"))
}

/// What differs, each name with what `both` says of the two.
pub(super) fn differences(
    one: &Map<String, Value>,
    other: &Map<String, Value>,
    both: impl Fn(String, String) -> String,
) -> String {
    let names = one.keys().chain(other.keys().filter(|name| !one.contains_key(*name)));
    let text = |value: Option<&Value>| match value {
        None => "not there".to_owned(),
        Some(Value::String(text)) => text.clone(),
        // As it is typed: all rays that there are.
        Some(number) if number.as_u64() == Some(u64::MAX) => "all".to_owned(),
        Some(other) => other.to_string(),
    };
    let different = names.filter(|name| one.get(*name) != other.get(*name));
    let parts: Vec<String> =
        different.map(|name| format!("{name} {}", both(text(one.get(name)), text(other.get(name))))).collect();
    parts.join(", ")
}
