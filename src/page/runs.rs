//! What was measured: journals and exports of studies, found out by their content.

use std::any::Any;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde_json::Value;

use super::machines::{Machine, OfMachine};
use crate::measure::Provenance;
use crate::report::Record;
use crate::report::words::{command_line, distinct};
use crate::study::compare::{CompareStudy, Compared};
use crate::study::history::{self, Entry, HistoryError};
use crate::study::journal::{Header, JournalError};
use crate::study::{Answers, AnyAnswer, AnyStudy, SceneId, Studies, Study};

/// Everything that a report is made of.
#[derive(Default)]
pub struct Runs {
    /// What was read, oldest first.
    pub sources: Vec<Source>,
    /// What studies say; of `compare` what it says of the first machine.
    pub answers: Answers,
    /// What was compared, machine by machine: the one with the most times first, or the newest of these, then those
    /// measured last at the end.
    pub machines: Vec<OfMachine>,
    /// The machines that the other answers are of, where files tell.
    measured_on: BTreeMap<&'static str, Machine>,
    /// The commands that measured what a study says.
    commands: BTreeMap<&'static str, Vec<String>>,
    provenances: Vec<Provenance>,
    /// Runs that were kept as baselines, the oldest first.
    pub history: Vec<Entry>,
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
    #[error("{} holds an export of {study} of another version of sahara ({cause}): make it again with its command", path.display())]
    Form { path: PathBuf, study: &'static str, cause: serde_json::Error },
    #[error("{} is JSON but no run of sahara: name files of `--export-json`, or of a study", path.display())]
    Foreign { path: PathBuf },
    #[error("{} is the journal of the study {study:?}, which this sahara does not know: leave it out", path.display())]
    Unknown { path: PathBuf, study: String },
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error(transparent)]
    History(#[from] HistoryError),
    #[error("there is no run in {}: `sahara study all` makes a whole one, `sahara compare --export-json {}/compare.json` a small one",
        path.display(), path.display())]
    Empty { path: PathBuf },
}

/// The kind of a file of a folder that is passed over.
const NO_RUN: &str = "no run";

/// What is said of a file whose measurements were made again.
const REPLACED: &str = "what a newer file of this kind holds as well";

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
    pub fn read(paths: &[PathBuf], studies: &Studies) -> Result<Self, RunError> {
        let mut files = vec![];
        let mut history = vec![];
        for path in paths {
            // A file that was named itself, or that of a folder.
            if path.file_name().is_some_and(|name| name == history::FILE) {
                history.extend(history::read(path)?);
                continue;
            }
            if path.is_dir() {
                history.extend(history::read(&path.join("baselines").join(history::FILE))?);
            }
            let is_folder = path.is_dir();
            let found = if is_folder { folder(path)? } else { vec![path.clone()] };
            if found.is_empty() && history.is_empty() {
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
        let mut runs = Self { history, ..Self::default() };
        let mut last = vec![];
        for file in files {
            match runs.add(&file.path, studies) {
                // Its answer is made from all others.
                Ok(Some(study)) => last.push((study, file.path)),
                // A folder may hold what studies export besides.
                Err(RunError::Foreign { path } | RunError::Unknown { path, .. }) if !file.is_named => {
                    runs.note(&path, NO_RUN, "");
                    runs.sources.last_mut().expect("it was noted").replaced = "all of it".into();
                }
                added => drop(added?),
            }
        }
        if let (true, true, Some(path)) =
            (runs.history.is_empty(), runs.sources.iter().all(|source| source.kind == NO_RUN), paths.first())
        {
            return Err(RunError::Empty { path: path.clone() });
        }
        runs.lead(studies);
        let made = studies.iter().filter(|study| study.is_last()).map(|study| {
            let answer = study.answer_alone(&Provenance::capture(1), &runs.answers);
            (study, answer)
        });
        let made: Vec<(&dyn AnyStudy, AnyAnswer)> = made.collect();
        for (study, path) in &last {
            let (header, answer) = study.read_journal(path, &runs.answers)?;
            runs.take(path, *study, answer, Some(&header.provenance));
        }
        for (study, answer) in made {
            if runs.answers.get(study.name()).is_none() {
                runs.answers.add(study, answer);
            }
        }
        Ok(runs)
    }

    /// Adds a file; one whose answer is made from the others is given back, for later.
    fn add<'a>(&mut self, path: &Path, studies: &'a Studies) -> Result<Option<&'a dyn AnyStudy>, RunError> {
        let text = fs::read_to_string(path).map_err(|cause| RunError::Read { path: path.into(), cause })?;
        let header: Option<Header> = text.lines().next().and_then(|line| serde_json::from_str(line).ok());
        if let Some(Header { study: name, .. }) = header {
            let study = studies.find(&name);
            let study = study.ok_or_else(|| RunError::Unknown { path: path.into(), study: name })?;
            if study.is_last() {
                return Ok(Some(study));
            }
            let (header, answer) = study.read_journal(path, &Answers::default())?;
            self.take(path, study, answer, Some(&header.provenance));
            return Ok(None);
        }
        let value: Value = serde_json::from_str(&text).map_err(|cause| RunError::Torn { path: path.into(), cause })?;
        for study in studies.iter() {
            if let Some(read) = study.read_export(&value) {
                let form = |cause| RunError::Form { path: path.into(), study: study.name(), cause };
                self.take(path, study, read.map_err(form)?, None);
                return Ok(None);
            }
        }
        Err(RunError::Foreign { path: path.into() })
    }

    /// Adds the answer of a file.
    fn take(&mut self, path: &Path, study: &dyn AnyStudy, answer: AnyAnswer, provenance: Option<&Provenance>) {
        let mut provenances: Vec<Provenance> = provenance.cloned().into_iter().collect();
        if study.name() == CompareStudy::NAME && (*answer).is::<Compared>() {
            let compared = (answer as Box<dyn Any>).downcast().expect("it is one");
            self.compare(*compared, &mut provenances);
        } else {
            self.measured_on.remove(study.name());
            self.measured_on.extend(provenance.map(|provenance| (study.name(), Machine::of(provenance))));
            if self.answers.add(study, answer) {
                let older = self.sources.iter_mut().filter(|source| source.kind == study.name());
                older.for_each(|source| source.replaced = REPLACED.into());
            }
        }
        let command = provenances.first().map_or("", |provenance| &provenance.command).to_owned();
        let commands = self.commands.entry(study.name()).or_default();
        if !commands.contains(&command_line(&command)) {
            commands.push(command_line(&command));
        }
        for provenance in provenances {
            if !self.provenances.contains(&provenance) {
                self.provenances.push(provenance);
            }
        }
        self.note(path, study.name(), &command);
    }

    /// Adds a comparison to those of its machine. Where the file does not tell `provenances` the records do.
    fn compare(&mut self, compared: Compared, provenances: &mut Vec<Provenance>) {
        let parts = OfMachine::parts(compared, provenances.first(), self.sources.len());
        if provenances.is_empty() {
            let first = |part: &OfMachine| Some(part.compared.records.first()?.provenance.clone());
            provenances.extend(parts.iter().filter_map(first));
        }
        for part in parts {
            let known = self.machines.iter().position(|older| older.machine == part.machine);
            let Some(mut older) = known.map(|place| self.machines.remove(place)) else {
                self.machines.push(part);
                continue;
            };
            let sources = older.sources.clone();
            if older.merge(part) {
                sources.into_iter().for_each(|source| self.sources[source].replaced = REPLACED.into());
            }
            self.machines.push(older);
        }
    }

    /// Makes the machine with the most times the one that the whole page speaks of, the newest of these.
    fn lead(&mut self, studies: &Studies) {
        let most = (0..self.machines.len()).max_by_key(|&place| self.machines[place].timed());
        let (Some(place), Some(study)) = (most, studies.find(CompareStudy::NAME)) else { return };
        let leading = self.machines.remove(place);
        let commands = leading.sources.iter().map(|&source| &self.sources[source].command);
        self.commands.insert(study.name(), distinct(commands.filter(|command| !command.is_empty())));
        self.answers.add(study, Box::new(leading.compared.clone()));
        self.machines.insert(0, leading);
    }

    /// The machine that a study was measured on and the one that was compared on, where these differ.
    pub fn elsewhere(&self, study: &str) -> Option<[&Machine; 2]> {
        let (own, leading) = (self.measured_on.get(study)?, &self.machines.first()?.machine);
        (own != leading).then_some([own, leading])
    }

    /// Where the numbers come from, one for each command.
    pub fn provenances(&self) -> Vec<&Provenance> {
        self.provenances.iter().collect()
    }

    /// The commands that measured a study; the one that would where none has.
    pub fn command(&self, study: &dyn AnyStudy) -> String {
        let commands = self.commands.get(study.name()).map(|commands| commands.join("\n"));
        commands.filter(|commands| !commands.is_empty()).unwrap_or_else(|| study.command())
    }

    /// Of `compare`.
    pub fn records(&self) -> &[Record] {
        self.answers.of::<CompareStudy>().map_or(&[], |compared| &compared.records)
    }

    /// The scenes, each with the command that named it.
    pub fn scenes(&self, studies: &Studies) -> Vec<(SceneId, String)> {
        let mut found: Vec<(SceneId, String)> = vec![];
        for study in studies.iter() {
            let Some(answer) = self.answers.get(study.name()) else { continue };
            for scene in study.scenes(answer) {
                if found.iter().all(|(known, _)| known.name != scene.name) {
                    found.push((scene, self.command(study)));
                }
            }
        }
        found
    }

    fn note(&mut self, path: &Path, kind: &str, command: &str) {
        self.sources.push(Source {
            path: path.into(),
            kind: kind.into(),
            command: command_line(command),
            replaced: String::new(),
        });
    }
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
