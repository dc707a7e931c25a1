//! Measures the cases of a study and makes the report.

use std::ffi::OsString;
use std::path::Path;

use clap::ArgMatches;

use super::journal::{CaseFile, Journal, JournalError, of_all};
use super::measure::{BuildWatch, Prepared, measure};
use super::process::measure_apart;
use super::{Case, Dataset, JoinedEpochs, Measured, Plan, Screen, Stage, Status, Study, StudyError, join};
use crate::measure::{Clock, Provenance, SystemClock, Threads};
use crate::registry::Registry;
use crate::report::{Report, Table, terminal};
use crate::scene::Scene;

pub struct Run<'a> {
    pub registry: &'a Registry,
    /// The folder of all journals.
    pub folder: &'a Path,
    /// If `Some(false)`, the journal is temporary. If `None`, the plan decides.
    pub keep_journal: Option<bool>,
    /// If `true`, cases in the journal are measured again.
    pub fresh: bool,
    /// If `Some`, each case is measured by a separate process with these options. If `None`, this process measures all
    /// cases.
    pub processes: Option<&'a [OsString]>,
    pub screen: &'a mut dyn Screen,
}

pub struct RunOutcome {
    /// `None` if the run was interrupted or no scene could be measured.
    pub dataset: Option<Dataset>,
    pub report: Report,
    /// Tables that were not printed during the run.
    pub tables: Vec<Table>,
    pub notes: Vec<String>,
    pub foot: Vec<String>,
    pub status: Status,
    pub failures: Vec<StudyError>,
}

/// An error of a single scene does not end the run.
pub fn run(study: &Study, matches: &ArgMatches, plan: &Plan, run: &mut Run) -> anyhow::Result<RunOutcome> {
    let threads = plan.cases.first().map_or(1, |case| case.settings.threads);
    let threads = Threads::unstarted(threads);
    let provenance = Provenance { process_per_epoch: run.processes.is_some(), ..Provenance::of(&threads) };
    let keep = run.keep_journal.unwrap_or(plan.keep_journal);
    let scratch = tempfile::Builder::new().prefix("sahara-").tempdir()?;
    let folder = if keep { run.folder.join(study.name) } else { scratch.path().to_owned() };
    let journal = Journal::open(&folder, provenance.clone(), run.fresh, &plan.cases)?;
    let missing: Vec<&Case> = plan.cases.iter().filter(|case| journal.get(case).is_none()).collect();
    if !missing.is_empty() {
        threads.check_available().map_err(StudyError::Threads)?;
    }
    run.screen.begin(missing.iter().map(|case| case.work()).sum());
    run.screen.warn(&plan.warnings);
    run.screen.warn(provenance.too_many_threads().as_slice());

    let mut engine =
        Engine { study, matches, plan, journal, provenance, threads, loaded: None, failures: vec![], ended: vec![] };
    let stopped = engine.measure(run)?;
    let all = plan.cases.len();
    let left = plan.cases.iter().filter(|case| engine.journal.get(case).is_none()).count();
    let stopped = stopped && left > 0;
    let mut outcome = engine.outcome(stopped, run.screen)?;
    if stopped {
        let kept = match keep {
            true if left < all => " and kept; the same command resumes",
            true => "",
            false => "; --dir DIR keeps them",
        };
        outcome.foot.push(format!("Interrupted: {} of {all} cases measured{kept}.", all - left));
        outcome.status = Status::Interrupted;
    }
    run.screen.end();
    Ok(outcome)
}

struct Engine<'a> {
    study: &'a Study,
    matches: &'a ArgMatches,
    plan: &'a Plan,
    journal: Journal,
    provenance: Provenance,
    threads: Threads,
    /// The latest measured scene, with the name of the scene on the command line.
    loaded: Option<(OsString, Scene)>,
    failures: Vec<StudyError>,
    /// The scenes of these cases get no further epochs.
    ended: Vec<Case>,
}

impl Engine<'_> {
    fn has_ended(&self, case: &Case) -> bool {
        self.ended.iter().any(|ended| ended.is_of_scene(case))
    }

    /// Returns `true` if the user interrupted the run.
    fn measure(&mut self, run: &mut Run) -> anyhow::Result<bool> {
        let clock = SystemClock::start();
        let mut began = 0;
        for (number, case) in self.plan.cases.iter().enumerate() {
            if self.has_ended(case) {
                continue;
            }
            if run.screen.is_interrupted() {
                return Ok(true);
            }
            let start = clock.now_ns();
            if case.epoch == 0 {
                began = start;
            }
            if self.journal.get(case).is_none() {
                run.screen.case(&case.title(), case.work());
                let out = self.journal.place(case);
                match self.measure_case(&self.with_skipped(case), &out, run, &clock) {
                    Ok(()) => self.journal.add(&out)?,
                    Err(_) if run.screen.is_interrupted() => {}
                    Err(error) if error.is_of_one_scene() => {
                        self.failures.push(error);
                        self.ended.push(case.clone());
                    }
                    Err(error) => return Err(error.into()),
                }
                run.screen.done();
            }
            // The next epoch is assumed to take as long as this epoch.
            let now = clock.now_ns();
            let limit = self.plan.limit.map_or(u64::MAX, |limit| limit.as_nanos() as u64);
            let is_late = (now - began) + (now - start) > limit;
            let next = self.plan.cases[number + 1..].iter().any(|other| other.is_of_scene(case));
            let is_whole = self.journal.get(case).is_some() && (!next || is_late);
            if is_late {
                self.ended.push(case.clone());
            }
            let stopped = run.screen.is_interrupted();
            if is_whole || stopped || self.has_ended(case) {
                self.print_scene(case, is_whole, run.screen)?;
            }
            if stopped {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Skips the structures that epoch 0 skipped.
    fn with_skipped(&self, case: &Case) -> Case {
        let first = self.journal.get(&Case { epoch: 0, ..case.clone() }).filter(|_| case.epoch > 0);
        let structures = first.map_or(&case.structures, |file| &file.case.structures).clone();
        Case { structures, ..case.clone() }
    }

    fn measure_case(&mut self, case: &Case, out: &Path, run: &mut Run, clock: &dyn Clock) -> Result<(), StudyError> {
        let mut progress = |stage: Stage| run.screen.stage(&stage);
        if let Some(options) = run.processes {
            return measure_apart(options, case, out, self.threads.cores(), &mut progress);
        }
        let cause = |error: anyhow::Error| match error.downcast::<StudyError>() {
            Ok(known) => known,
            Err(other) => StudyError::Case { key: case.key(), cause: format!("{other:#}") },
        };
        let loaded = self.loaded.take().filter(|(word, _)| *word == case.scene.word).map(|(_, scene)| scene);
        let prepared = Prepared::new(case, run.registry, loaded).map_err(cause)?;
        let epoch = measure(case, &prepared, clock, &BuildWatch::default(), &mut progress)?;
        self.loaded = Some((case.scene.word.clone(), prepared.scene));
        CaseFile::write(&CaseFile::place(out)?, &self.provenance, case, &epoch)?;
        Ok(())
    }

    fn joined(&self, is: impl Fn(&Case) -> bool) -> JoinedEpochs {
        let files = self.plan.cases.iter().filter(|case| is(case)).filter_map(|case| self.journal.get(case));
        join(files.map(|file| Measured { case: file.case.clone(), epoch: file.epoch.clone() }).collect())
    }

    fn dataset(&self, measured: Vec<Measured>) -> Dataset {
        let files = self.plan.cases.iter().filter_map(|case| self.journal.get(case));
        let all: Vec<&Provenance> = files.map(|file| &file.provenance).chain([&self.provenance]).collect();
        Dataset::new(of_all(&all), measured)
    }

    fn print_scene(&self, case: &Case, is_whole: bool, screen: &mut dyn Screen) -> anyhow::Result<()> {
        let measured = self.joined(|other| other.is_of_scene(case)).measured;
        if measured.is_empty() {
            return Ok(());
        }
        let of = if is_whole { String::new() } else { format!(" ({} of {} epochs)", measured.len(), case.epochs) };
        let report = (self.study.report)(&self.dataset(measured), self.matches);
        for table in report.tables().filter(|table| table.of_scene) {
            screen.table(&Table { title: format!("{}{of}", table.title), ..table.clone() });
        }
        Ok(())
    }

    fn outcome(&mut self, stopped: bool, screen: &mut dyn Screen) -> Result<RunOutcome, JournalError> {
        let JoinedEpochs { mut measured, unchecked, failures, .. } = self.joined(|_| true);
        self.failures.extend(failures);
        if !stopped && !measured.is_empty() && measured.iter().all(|own| own.epoch.has_no_rays()) {
            self.failures.push(StudyError::Nothing);
            measured.clear();
        }
        let is_reported = !stopped && (self.failures.is_empty() || !measured.is_empty());
        let dataset = self.dataset(measured);
        let report = (self.study.report)(&dataset, self.matches);
        screen.warn(&report.warnings);
        let (mut tables, mut notes, mut foot) = (vec![], vec![], vec![]);
        if is_reported || !dataset.measured.is_empty() {
            // Means use only the epochs that all scenes have.
            // If the run was interrupted, the summary leaves out every scene that lacks epochs. Without a time limit,
            // the summary also leaves out each failed scene that lacks epochs. If no scene would remain, the summary
            // includes all measured scenes.
            let lacks = |case: &Case| {
                self.plan.cases.iter().any(|other| other.is_of_scene(case) && self.journal.get(other).is_none())
            };
            let is_cut = |case: &Case| lacks(case) && (stopped || self.has_ended(case) && self.plan.limit.is_none());
            let whole = self.joined(|case| !is_cut(case)).measured;
            let of_whole = match whole.is_empty() {
                true => report.clone(),
                false => (self.study.report)(&self.dataset(whole), self.matches),
            };
            tables = terminal::summary_tables(&of_whole);
            foot.extend(report.failures.iter().map(|own| own.sentence.clone()).filter(|own| !own.is_empty()));
            foot.extend(unchecked);
            foot.extend(of_whole.headlines().map(String::from));
            foot.push(dataset.provenance.line());
            foot.extend(dataset.verdicts());
            notes.extend(report.blocks.iter().filter_map(terminal::note));
            notes.extend(self.plan.notes.iter().cloned());
            notes.extend(of_whole.sentences().map(String::from));
            notes.retain(|note| !foot.contains(note));
        }
        let failed = |error: &StudyError| if error.is_wrong_hit() { Status::Wrong } else { Status::Failed };
        let status = self.failures.iter().map(failed).fold(Status::of(&report.failures), Status::and);
        let failures = std::mem::take(&mut self.failures);
        Ok(RunOutcome { dataset: is_reported.then_some(dataset), report, tables, notes, foot, status, failures })
    }
}
