//! What was measured: files found out by their content.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::measure::Provenance;
use crate::report::Record;
use crate::study::accuracy::AccuracyRecord;
use crate::study::attribution::Attribution;
use crate::study::break_even::Market;
use crate::study::costs::Family;
use crate::study::crossover::Race;
use crate::study::journal::{Header, Journal, JournalError, OF_ALL, Recorded};
use crate::study::parameters::Parameters;
use crate::study::replicate::Replication;
use crate::study::scaling::Growth;
use crate::study::{attribution, break_even, costs, crossover, parameters, predictions, scaling};

/// Everything that a report is made of.
#[derive(Clone, Debug, Default)]
pub struct Runs {
    /// What was read, oldest first.
    pub sources: Vec<Source>,
    /// Of `compare`; scenes that only `bench` has measured, of that.
    pub records: Vec<Record>,
    /// Of `bench`, as long as files are read.
    benched: Vec<Record>,
    /// Of `study partitions`.
    pub partitions: Vec<Record>,
    pub accuracy: Vec<AccuracyRecord>,
    pub replication: Option<Replication>,
    pub attribution: Option<Study<Vec<Attribution>>>,
    pub scaling: Option<Study<Vec<Growth>>>,
    pub break_even: Option<Study<Vec<Market>>>,
    pub crossover: Option<Study<Vec<Race>>>,
    pub costs: Option<Study<Vec<Family>>>,
    pub parameters: Option<Study<Parameters>>,
    /// What `study predictions` counts; the verdicts come from all runs.
    pub predictions: Option<Study<Vec<predictions::Case>>>,
}

/// A study that keeps a journal, and what came of it.
#[derive(Clone, Debug)]
pub struct Study<R> {
    pub header: Header,
    pub result: R,
}

impl<R> Study<R> {
    /// The command that began it.
    pub fn command(&self) -> String {
        shown(&self.header.provenance.command)
    }
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// As named on the command line, or found in a folder that was.
    pub path: PathBuf,
    /// What it holds.
    pub kind: String,
    /// The command that made it; empty where it does not say.
    pub command: String,
    /// What of it a newer file replaces; empty where all of it is used.
    pub replaced: String,
}

/// Why runs cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error("cannot read {}: {cause}: name files of `--export-json`, or a folder of them", path.display())]
    Read { path: PathBuf, cause: io::Error },
    #[error("{} is torn or no JSON ({cause}): make it again with its command", path.display())]
    Torn { path: PathBuf, cause: serde_json::Error },
    #[error("{} holds {kind} of another version of sahara ({cause}): make it again with its command", path.display())]
    Form { path: PathBuf, kind: &'static str, cause: serde_json::Error },
    #[error("{} is JSON but no run of sahara: name files of `--export-json`, or of a study", path.display())]
    Foreign { path: PathBuf },
    #[error("{} is the journal of the study {study:?}, which this sahara does not know: leave it out", path.display())]
    Unknown { path: PathBuf, study: String },
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error("there is no run in {}: `sahara study all` makes a whole one, `sahara compare --export-json {}/compare.json` a small one",
        path.display(), path.display())]
    Empty { path: PathBuf },
}

/// The kind of a file of verdicts.
const VERDICTS: &str = "verdicts";

/// The kind of a file of a folder that is passed over.
const NO_RUN: &str = "no run";

/// A file and when it was last written: the newest counts where two measured the same.
struct File {
    path: PathBuf,
    modified: SystemTime,
    /// Whether it was named itself, and not the folder it is in.
    is_named: bool,
}

impl Runs {
    /// Reads files, and all `.json` and `.jsonl` files of folders.
    ///
    /// # Errors
    /// If there is nothing, or a file is torn, foreign or of another version.
    pub fn read(paths: &[PathBuf]) -> Result<Self, RunError> {
        let mut files = vec![];
        for path in paths {
            let is_folder = path.is_dir();
            let found = if is_folder { folder(path)? } else { vec![path.clone()] };
            if found.is_empty() {
                return Err(RunError::Empty { path: path.clone() });
            }
            for path in found {
                let modified = fs::metadata(&path).and_then(|meta| meta.modified());
                let modified = modified.map_err(|cause| RunError::Read { path: path.clone(), cause })?;
                files.push(File { path, modified, is_named: !is_folder });
            }
        }
        files.sort_by(|a, b| (a.modified, &a.path).cmp(&(b.modified, &b.path)));
        files.dedup_by(|a, b| a.path == b.path);
        let mut runs = Self::default();
        for file in files {
            match runs.add(&file.path) {
                // A folder may hold what studies export besides.
                Err(RunError::Foreign { path }) if !file.is_named => {
                    runs.note(&path, NO_RUN, "");
                    runs.sources.last_mut().expect("it was noted").replaced = "all of it".into();
                }
                added => added?,
            }
        }
        if let (true, Some(path)) = (runs.sources.iter().all(|source| source.kind == NO_RUN), paths.first()) {
            return Err(RunError::Empty { path: path.clone() });
        }
        // Bench looks at few scenes, to find changes: whatever compare has measured is more.
        let mut benched = std::mem::take(&mut runs.benched);
        benched.retain(|bench| runs.records.iter().all(|record| record.scene != bench.scene));
        runs.records.append(&mut benched);
        Ok(runs)
    }

    fn add(&mut self, path: &Path) -> Result<(), RunError> {
        let text = fs::read_to_string(path).map_err(|cause| RunError::Read { path: path.into(), cause })?;
        if let Some(header) = text.lines().next().and_then(header) {
            return self.add_journal(path, &header);
        }
        let value: Value = serde_json::from_str(&text).map_err(|cause| RunError::Torn { path: path.into(), cause })?;
        let has = |value: &Value, field: &str| value.get(field).is_some();
        let first = value.get(0);
        if first.is_some_and(|first| has(first, "workload_hash")) {
            let records: Vec<Record> = typed(path, "records", value)?;
            return self.add_records(path, records, false);
        }
        if let Some(records) = value.get("partitions") {
            let records: Vec<Record> = typed(path, "the records of partitions", records.clone())?;
            return self.add_records(path, records, true);
        }
        if first.is_some_and(|first| has(first, "error_bound")) {
            let records: Vec<AccuracyRecord> = typed(path, "records of accuracy", value)?;
            let command = records.first().map_or(String::new(), |record| record.provenance.command.clone());
            let same = |old: &AccuracyRecord| records.iter().any(|r| r.scene == old.scene && r.rays == old.rays);
            self.replace("accuracy", |runs| runs.accuracy.iter().any(same));
            self.accuracy.retain(|old| !same(old));
            self.accuracy.extend(records);
            self.note(path, "accuracy", &command);
            return Ok(());
        }
        if has(&value, "conclusion") && has(&value, "parameters") {
            let replication: Replication = typed(path, "a replication", value)?;
            self.replace("replicate", |_| true);
            self.note(path, "replicate", &replication.provenance.command);
            self.replication = Some(replication);
            return Ok(());
        }
        if has(&value, "predictions") {
            self.note(path, VERDICTS, "");
            let source = self.sources.last_mut().expect("one has been noted");
            source.replaced = "all of it: they are made anew from what was measured".into();
            return Ok(());
        }
        Err(RunError::Foreign { path: path.into() })
    }

    /// Adds the journal of a study; of several the newest counts.
    fn add_journal(&mut self, path: &Path, header: &Header) -> Result<(), RunError> {
        let name = header.study.as_str();
        match name {
            attribution::NAME => self.attribution = Some(study(path, name, attribution::result)?),
            scaling::NAME => self.scaling = Some(study(path, name, scaling::result)?),
            break_even::NAME => self.break_even = Some(study(path, name, break_even::result)?),
            crossover::NAME => self.crossover = Some(study(path, name, crossover::result)?),
            costs::NAME => self.costs = Some(study(path, name, costs::result)?),
            parameters::NAME => self.parameters = Some(study(path, name, parameters::result)?),
            predictions::NAME => {
                self.predictions = Some(study(path, name, |cases: &[predictions::Case]| newest(cases))?)
            }
            // It holds no measurements.
            OF_ALL => return Ok(()),
            _ => return Err(RunError::Unknown { path: path.into(), study: name.into() }),
        }
        let kind = format!("study {name}");
        self.replace(&kind, |_| true);
        self.note(path, &kind, &header.provenance.command);
        Ok(())
    }

    /// Adds records; those of the same scene, structure and workload that are there already are older.
    fn add_records(&mut self, path: &Path, records: Vec<Record>, partitions: bool) -> Result<(), RunError> {
        let command = records.first().map_or(String::new(), |record| record.provenance.command.clone());
        let has = |name: &str| command.split_whitespace().any(|word| word == name);
        let (kind, old) = match () {
            () if partitions => ("study partitions", &mut self.partitions),
            () if has("bench") => ("bench", &mut self.benched),
            () => ("compare", &mut self.records),
        };
        // Times of different runs are no pairs: a scene is of one run.
        let before = old.len();
        old.retain(|old| records.iter().all(|new| new.scene != old.scene));
        let replaces = old.len() < before;
        old.extend(records);
        self.replace(kind, |_| replaces);
        self.note(path, kind, &command);
        Ok(())
    }

    /// Says of older files of `kind` that they are replaced, where they are.
    fn replace(&mut self, kind: &str, is_replaced: impl FnOnce(&Self) -> bool) {
        if is_replaced(self) {
            let older = self.sources.iter_mut().filter(|source| source.kind == kind);
            older.for_each(|source| source.replaced = "what a newer file of this kind holds as well".into());
        }
    }

    /// Where the numbers come from, one for each command.
    pub fn provenances(&self) -> Vec<&Provenance> {
        let records = self.records.iter().chain(&self.partitions).map(|record| &record.provenance);
        let accuracy = self.accuracy.iter().map(|record| &record.provenance);
        let replication = self.replication.iter().map(|replication| &replication.provenance);
        let studies = self.headers().into_iter().map(|header| &header.provenance);
        let mut found: Vec<&Provenance> = vec![];
        for provenance in records.chain(accuracy).chain(replication).chain(studies) {
            if !found.contains(&provenance) {
                found.push(provenance);
            }
        }
        found
    }

    /// The headers of all studies.
    fn headers(&self) -> Vec<&Header> {
        let of = [
            self.attribution.as_ref().map(|study| &study.header),
            self.scaling.as_ref().map(|study| &study.header),
            self.break_even.as_ref().map(|study| &study.header),
            self.crossover.as_ref().map(|study| &study.header),
            self.costs.as_ref().map(|study| &study.header),
            self.parameters.as_ref().map(|study| &study.header),
            self.predictions.as_ref().map(|study| &study.header),
        ];
        of.into_iter().flatten().collect()
    }

    /// The scenes: name, hash where it is known, and the command that named them.
    pub fn scenes(&self) -> Vec<(String, Option<String>, String)> {
        let records = self.records.iter().chain(&self.partitions);
        let of_records = records.map(|r| (&r.scene, Some(&r.scene_hash), &r.provenance.command));
        let of_accuracy = self.accuracy.iter().map(|r| (&r.scene, Some(&r.scene_hash), &r.provenance.command));
        let of_replication = self.replication.iter().flat_map(|replication| {
            replication.rays.iter().map(|rays| (&rays.scene, None, &replication.provenance.command))
        });
        let mut found: Vec<(String, Option<String>, String)> = vec![];
        for (name, hash, command) in of_records.chain(of_accuracy).chain(of_replication) {
            if found.iter().all(|(known, ..)| known != name) {
                found.push((name.clone(), hash.cloned(), command.clone()));
            }
        }
        found
    }

    fn note(&mut self, path: &Path, kind: &str, command: &str) {
        self.sources.push(Source {
            path: path.into(),
            kind: kind.into(),
            command: shown(command),
            replaced: String::new(),
        });
    }
}

/// The header of a journal, if this line is one.
fn header(line: &str) -> Option<Header> {
    serde_json::from_str(line).ok()
}

/// The last case of every scene: what is counted on a scene is counted again when the scene changes.
fn newest(cases: &[predictions::Case]) -> Vec<predictions::Case> {
    let last = |(i, case): &(usize, &predictions::Case)| !cases[i + 1..].iter().any(|later| later.scene == case.scene);
    cases.iter().enumerate().filter(last).map(|(_, case)| case.clone()).collect()
}

/// Reads a journal, and makes of its cases what the study makes of them.
fn study<C, R>(path: &Path, name: &str, result: impl FnOnce(&[C]) -> R) -> Result<Study<R>, RunError>
where
    C: Serialize + DeserializeOwned,
{
    let Recorded { header, cases, .. } = Journal::read(path, name)?;
    Ok(Study { header, result: result(&cases) })
}

/// The files of a folder that may be runs, by name.
fn folder(path: &Path) -> Result<Vec<PathBuf>, RunError> {
    let error = |cause| RunError::Read { path: path.into(), cause };
    let mut found = vec![];
    for entry in fs::read_dir(path).map_err(error)? {
        let path = entry.map_err(error)?.path();
        let is_json = path.extension().is_some_and(|ending| ending == "json" || ending == "jsonl");
        if is_json && path.is_file() {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

fn typed<T: DeserializeOwned>(path: &Path, kind: &'static str, value: Value) -> Result<T, RunError> {
    serde_json::from_value(value).map_err(|cause| RunError::Form { path: path.into(), kind, cause })
}

/// A command line as another machine would type it: without the folder of the program.
pub fn shown(command: &str) -> String {
    if command.is_empty() {
        return String::new();
    }
    let (program, rest) = command.split_once(' ').unwrap_or((command, ""));
    let program = program.trim_matches('\'').rsplit(['/', '\\']).next().unwrap_or(program);
    let name = if program.starts_with("sahara") { "sahara" } else { program };
    format!("{name} {rest}").trim_end().into()
}
