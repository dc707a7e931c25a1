//! What was measured: cases and exports of studies, found out by their content.

use std::any::Any;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde_json::Value;

use super::content::{Content, content, folder, modified};
use super::machines::{Machine, OfMachine};
use super::planned::without_result;
use super::run_error::RunError;
use crate::escaped::Escaped as _;
use crate::measure::Provenance;
use crate::report::Record;
use crate::report::number::plural;
use crate::report::words::{command_line, distinct};
use crate::study::compare::{CompareStudy, Compared};
use crate::study::history::{self, Entry};
use crate::study::journal::{CaseFile, Group, groups};
use crate::study::{Answers, AnyAnswer, AnyStudy, Found, SceneId, Studies, Study};

/// Everything that a report is made of.
#[derive(Default)]
pub struct Runs {
    /// What was read, oldest first.
    pub sources: Vec<Source>,
    /// What studies say; of `compare` what it says of the first machine.
    pub answers: Answers,
    /// What was compared, machine by machine, on each by one build: the one with the most times first, or the newest of these, then
    /// those measured last at the end.
    pub machines: Vec<OfMachine>,
    /// The machines that the other answers are of, where files tell.
    measured_on: BTreeMap<&'static str, Machine>,
    /// What is missing of it, or left out, a sentence each.
    pub notes: Vec<String>,
    /// The commands that measured what a study says.
    commands: BTreeMap<&'static str, Vec<String>>,
    /// Where the numbers come from, one for each command.
    pub provenances: Vec<Provenance>,
    /// Runs that were kept as baselines, the oldest first.
    pub history: Vec<Entry>,
}

/// A file that was read, or a folder of cases.
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

/// The kind of a file of a folder that is passed over.
const NO_RUN: &str = "no run";

/// What is said of a file whose measurements were made again.
const REPLACED: &str = "what a newer file of this kind holds as well";

/// A file of a folder, or one that was named itself.
struct File {
    path: PathBuf,
    is_named: bool,
}

/// What is said of cases of which another build or machine has measured more.
const LESS: &str = "all of it: another build or machine has measured as many cases or more";

/// What is said of a comparison where another build has measured more on the same machine.
const OTHER_BUILD: &str = "times of one build: another one has as many or more on the same machine";

/// What one answer is made of, and when it was last written: the newest counts where two measured the same.
struct Part<'a> {
    modified: SystemTime,
    path: PathBuf,
    study: &'a dyn AnyStudy,
    holds: Holds,
}

enum Holds {
    Export(Box<AnyAnswer>),
    /// Cases of one build and machine.
    Cases(Box<Group<Value>>),
    /// Likewise, where another set of them counts in its place.
    FewerCases(Box<Group<Value>>),
}

impl Runs {
    /// Reads files, and of folders all `.json` files and those of journals in them.
    ///
    /// # Errors
    /// If there is nothing, a file is torn, foreign or of another version, or cases of a study are of different settings.
    pub fn read(paths: &[PathBuf], studies: &Studies) -> Result<Self, RunError> {
        let mut files: Vec<File> = vec![];
        let (mut histories, mut left) = (vec![], vec![]);
        for path in paths {
            // A file that was named itself, or that of a folder.
            if path.file_name().is_some_and(|name| name == history::FILE) {
                histories.push(history::read(path)?);
                continue;
            }
            if path.is_dir() {
                histories.push(history::read(&path.join("baselines").join(history::FILE))?);
                left.extend(without_result(path));
            }
            let is_folder = path.is_dir();
            let found = if is_folder { folder(path, studies)? } else { vec![path.clone()] };
            if found.is_empty() && histories.iter().all(Vec::is_empty) {
                return Err(RunError::Empty { path: path.clone() });
            }
            files.extend(found.into_iter().map(|path| File { path, is_named: !is_folder }));
        }
        left.dedup();
        files.sort_by(|a, b| a.path.cmp(&b.path));
        files.dedup_by(|a, b| a.path == b.path);

        let mut runs = Self { history: history::merged(histories), notes: left, ..Self::default() };
        let mut parts = vec![];
        let mut cases: BTreeMap<&'static str, Vec<CaseFile<Value>>> = BTreeMap::new();
        for file in files {
            match content(&file.path, studies) {
                Ok(Content::Export(study, answer)) => {
                    let (modified, holds) = (modified(&file.path)?, Holds::Export(Box::new(answer)));
                    parts.push(Part { modified, path: file.path, study, holds });
                }
                Ok(Content::Case(study, case)) => cases.entry(study.name()).or_default().push(*case),
                // A folder may hold what studies export besides.
                Err(RunError::Foreign { path } | RunError::Unknown { path, .. }) if !file.is_named => {
                    runs.note(&path, NO_RUN, "", "all of it");
                }
                Err(error) => return Err(error),
            }
        }
        for (study, cases) in cases {
            let study = studies.find(study).expect("it was found before");
            let groups = groups(cases)?;
            let machines: Vec<Machine> = groups.iter().map(|group| Machine::of(&group.provenance)).collect();
            for (place, group) in groups.into_iter().enumerate() {
                let of = |file: &CaseFile<Value>| modified(&file.path);
                let times = group.files.iter().map(of).collect::<Result<Vec<SystemTime>, RunError>>()?;
                let modified = times.into_iter().max().expect("a group has a case");
                let path = group.files[0].path.parent().unwrap_or(Path::new(".")).into();
                // The set with the most cases comes last. Of comparisons all machines are shown and of other studies one, of a machine
                // one build.
                let replaces = |more: &Machine| study.name() != CompareStudy::NAME || *more == machines[place];
                let is_replaced = machines[place + 1..].iter().any(replaces);
                let holds = if is_replaced { Holds::FewerCases } else { Holds::Cases };
                parts.push(Part { modified, path, study, holds: holds(Box::new(group)) });
            }
        }
        parts.sort_by(|a, b| (a.modified, &a.path).cmp(&(b.modified, &b.path)));
        if let (true, Some(path)) = (parts.is_empty() && runs.history.is_empty(), paths.first()) {
            return Err(RunError::Empty { path: path.clone() });
        }
        // What is made from the others comes after them.
        let (last, first): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(|part| part.study.is_last());
        first.into_iter().try_for_each(|part| runs.add(part))?;
        runs.leave_one_build();
        runs.lead(studies);
        let made = studies.iter().filter(|study| study.is_last()).map(|study| {
            let answer = study.answer(&[], &Provenance::capture(1), &runs.answers, None);
            (study, answer)
        });
        let made: Vec<(&dyn AnyStudy, AnyAnswer)> = made.collect();
        last.into_iter().try_for_each(|part| runs.add(part))?;
        for (study, answer) in made {
            if runs.answers.get(study.name()).is_none() {
                study.add(&mut runs.answers, answer);
            }
        }
        Ok(runs)
    }

    /// Adds an answer.
    fn add(&mut self, part: Part) -> Result<(), RunError> {
        let Part { path, study, holds, .. } = part;
        match holds {
            Holds::Export(answer) => self.take(&path, study, *answer, None),
            Holds::FewerCases(group) => self.note(&path, study.name(), &group.provenance.command, LESS),
            Holds::Cases(group) => {
                let Found { answer, notes } = study.read_cases(&group, &self.answers)?;
                self.take(&path, study, answer, Some(&group.provenance));
                let again = group.replaced.first().map(|path| {
                    let count = plural(group.replaced.len(), "case");
                    format!("{count} measured again since, as in {}.", path.escaped())
                });
                let notes = notes.into_iter().chain(again);
                self.notes.extend(notes.map(|note| format!("{}: {note}", study.name())));
            }
        }
        Ok(())
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
            if study.add(&mut self.answers, answer) {
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
        self.note(path, study.name(), &command, "");
    }

    /// Adds a comparison to those of its machine and build. Where the file does not tell `provenances` the records do.
    fn compare(&mut self, compared: Compared, provenances: &mut Vec<Provenance>) {
        let parts = OfMachine::parts(compared, provenances.first(), self.sources.len());
        if provenances.is_empty() {
            let first = |part: &OfMachine| Some(part.compared.records.first()?.provenance.clone());
            provenances.extend(parts.iter().filter_map(first));
        }
        for part in parts {
            let known = self.machines.iter().position(|older| older.is_like(&part));
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

    /// Leaves of each machine the build with the most times, the newest of these.
    fn leave_one_build(&mut self) {
        let counts = |own: &OfMachine| {
            let of_machine = self.machines.iter().filter(|one| one.machine == own.machine);
            of_machine.max_by_key(|one| one.timed()).is_some_and(|most| most.is_like(own))
        };
        let counts: Vec<bool> = self.machines.iter().map(counts).collect();
        for (own, counts) in std::mem::take(&mut self.machines).into_iter().zip(counts) {
            if counts {
                self.machines.push(own);
            } else {
                own.sources.iter().for_each(|&source| self.sources[source].replaced = OTHER_BUILD.into());
            }
        }
    }

    /// Makes the machine with the most times the one that the whole page speaks of, the newest of these.
    fn lead(&mut self, studies: &Studies) {
        let most = (0..self.machines.len()).max_by_key(|&place| self.machines[place].timed());
        let (Some(place), Some(study)) = (most, studies.find(CompareStudy::NAME)) else { return };
        let leading = self.machines.remove(place);
        let commands = leading.sources.iter().map(|&source| &self.sources[source].command);
        self.commands.insert(study.name(), distinct(commands.filter(|command| !command.is_empty())));
        study.add(&mut self.answers, Box::new(leading.compared.clone()));
        self.machines.insert(0, leading);
    }

    /// The machine that a study was measured on and the one that was compared on, where these differ.
    pub fn elsewhere(&self, study: &str) -> Option<[&Machine; 2]> {
        let (own, leading) = (self.measured_on.get(study)?, &self.machines.first()?.machine);
        (own != leading).then_some([own, leading])
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

    fn note(&mut self, path: &Path, kind: &str, command: &str, replaced: &str) {
        self.sources.push(Source {
            path: path.into(),
            kind: kind.into(),
            command: command_line(command),
            replaced: replaced.into(),
        });
    }
}
