use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::JournalError;
use crate::measure::{Provenance, checksum};
use crate::study::plan::settings_map;

/// The first line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Version of this form.
    pub schema: u32,
    /// Name of the study.
    pub study: String,
    /// Everything that a case's result depends on and its key does not tell, by the name of the option.
    pub settings: Map<String, Value>,
    /// Of the run that began the journal.
    pub provenance: Provenance,
}

impl Header {
    /// Version of the form of journals.
    pub const SCHEMA: u32 = 2;

    /// Of this process.
    ///
    /// # Panics
    /// If `settings` does not serialise to a map of names.
    pub fn new(study: &str, settings: &impl Serialize, provenance: Provenance) -> Self {
        let settings = settings_map(settings);
        Self { schema: Self::SCHEMA, study: study.into(), settings, provenance }
    }

    /// Whether a run with this header may go on with a journal that has the header `there`, or show its cases as its own: those of
    /// other settings, of another build or of another machine are not what this run would measure.
    pub(super) fn admits(&self, there: &Self, path: &Path) -> Result<(), JournalError> {
        there.is_of(&self.study, path)?;
        let settings = differences(&there.settings, &self.settings);
        if !settings.is_empty() {
            return Err(JournalError::Settings { path: path.into(), differences: settings });
        }
        let machine = differences(&there.machine(), &self.machine());
        if !machine.is_empty() {
            return Err(JournalError::Machine { path: path.into(), differences: machine });
        }
        Ok(())
    }

    /// Whether this is the header of a journal of `study` in the form of this version.
    pub(super) fn is_of(&self, study: &str, path: &Path) -> Result<(), JournalError> {
        if self.study != study {
            return Err(JournalError::Study { path: path.into(), there: self.study.clone(), here: study.into() });
        }
        if self.schema != Self::SCHEMA {
            return Err(JournalError::Schema { path: path.into(), there: self.schema, here: Self::SCHEMA });
        }
        Ok(())
    }

    /// Tells journals of other settings, builds, machines or cases apart; `keys` are those of all cases that are to be measured.
    pub fn id<'a>(&self, keys: impl IntoIterator<Item = &'a str>) -> String {
        let keys: Vec<&str> = keys.into_iter().collect();
        let text = serde_json::to_string(&(&self.settings, self.machine(), keys)).expect("settings have text keys");
        format!("{:016x}", checksum(text.bytes().map(u64::from)))
    }

    /// What makes a program faster or slower, of all that is known of it.
    fn machine(&self) -> Map<String, Value> {
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

    /// Whether `line` looks like a header, of whatever version.
    pub(super) fn is_one(line: &[u8]) -> bool {
        line.starts_with(br#"{"schema":"#)
    }

    /// Whether `torn`, which has no line end, can be the beginning of a header of this study, or nothing.
    pub(super) fn may_begin(&self, torn: &[u8]) -> bool {
        let whole = serde_json::to_string(self).expect("a header has text keys");
        let settings = whole.find(r#","settings""#).expect("a header has settings");
        let start = &whole.as_bytes()[..settings];
        start.starts_with(torn) || torn.starts_with(start)
    }
}

/// `runs was 5 and is 7, seed was 1 and is 2`: what differs.
fn differences(there: &Map<String, Value>, here: &Map<String, Value>) -> String {
    let names = there.keys().chain(here.keys().filter(|name| !there.contains_key(*name)));
    let text = |value: Option<&Value>| match value {
        None => "not there".to_owned(),
        Some(Value::String(text)) => text.clone(),
        Some(other) => other.to_string(),
    };
    let different = names.filter(|name| there.get(*name) != here.get(*name));
    let parts: Vec<String> =
        different.map(|name| format!("{name} was {} and is {}", text(there.get(name)), text(here.get(name)))).collect();
    parts.join(", ")
}
