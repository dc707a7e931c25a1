//! Baselines: a comparison that is to be repeated, and held against one that was kept.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::compare::{CompareStudy, Compared, compared};
use super::diff::{Comparison, Finding, Machines, Unlike, unlike};
use super::engine::measure_case;
use super::epoch::{Epoch, Joined, join};
use super::process::Processes;
use super::{Plan, Refused, Screen, Status, Study, StudyError};
use crate::escaped::Escaped as _;
use crate::measure::{Clock, Provenance};
use crate::report::Record;
use crate::report::number::plural;

/// Scenes whose structures are built in a moment, with few triangles, many, and walls.
pub const SCENES: [&str; 3] = ["teapot", "starters", "cornellbox"];

/// Epochs of some scenes, to which more can be added where those taken so far do not decide.
pub struct Run<'a> {
    plan: &'a Plan<Epoch>,
    processes: Option<&'a Processes>,
    clock: &'a dyn Clock,
    /// As many cases of the plan as have been measured.
    epochs: Vec<Epoch>,
}

impl<'a> Run<'a> {
    /// Of a plan of the most epochs that may be needed; nothing is measured yet.
    pub fn new(plan: &'a Plan<Epoch>, processes: Option<&'a Processes>, clock: &'a dyn Clock) -> Self {
        Self { plan, processes, clock, epochs: vec![] }
    }

    /// Epochs so far.
    pub fn epochs(&self) -> usize {
        self.epochs.last().map_or(0, |last| last.epoch + 1)
    }

    /// One more epoch of all scenes.
    ///
    /// # Errors
    /// As [`Processes::measure`].
    pub fn epoch(&mut self, screen: &mut dyn Screen) -> Result<(), StudyError> {
        let epoch = self.epochs();
        for case in self.plan.cases.iter().filter(|case| case.epoch == epoch) {
            // Of how many it is not known yet.
            let title = format!("epoch {}: {}", epoch + 1, case.loads);
            screen.case(&title, case.work);
            let measured = measure_case(
                CompareStudy::NAME,
                self.plan,
                case,
                |value| Epoch::deserialize(value),
                self.processes,
                self.clock,
                screen,
            )?;
            self.epochs.push(measured);
            screen.done();
        }
        let mut failures = self.joined().failures;
        // One of them ends the run, a wrong answer if there is any; the others are told.
        failures.sort_by_key(StudyError::is_wrong_answer);
        let last = failures.pop();
        failures.iter().for_each(crate::output::tell_error);
        last.map_or(Ok(()), Err)
    }

    fn joined(&self) -> Joined<Epoch> {
        join(self.epochs.clone(), CompareStudy::epoch, CompareStudy::WHOLE)
    }

    /// All epochs, joined.
    pub fn all(&self) -> Vec<Epoch> {
        self.joined().cases
    }

    /// Their records.
    pub fn compared(&self, provenance: &Provenance) -> Compared {
        compared(&self.all(), provenance)
    }
}

/// What a comparison with a baseline comes to: wrong answers weigh more than missing ones, those more than slow ones.
pub fn outcome(comparison: &Comparison) -> Status {
    match () {
        () if !comparison.wrong.is_empty() => Status::Wrong,
        () if !comparison.only_old.is_empty() => Status::Refused,
        () if comparison.has(Finding::Regression) => Status::Regression,
        () if comparison.has(Finding::Undecided) => Status::Undecided,
        () if comparison.threshold_percent.is_some() && comparison.has(Finding::Unknown) => Status::Undecided,
        () => Status::Right,
    }
}

/// Why a run cannot be held against a baseline.
#[derive(Debug, thiserror::Error)]
pub enum BaselineError {
    #[error("the name {0:?} of a baseline must be made of letters, digits, '-', '_' and '.', and not begin with '.'")]
    Name(String),
    #[error("there is no baseline {name:?} in {}: {known}", folder.escaped())]
    Missing { name: String, folder: PathBuf, known: String },
    #[error("the baseline {} cannot be read: {cause}: save it again with --save-baseline", path.escaped())]
    Read { path: PathBuf, cause: String },
    #[error("the folder {} for baselines cannot be made: {cause}: choose another with --dir", path.escaped())]
    Folder { path: PathBuf, cause: std::io::Error },
    #[error("the baseline {name} is of another machine ({machine}): choose another name, or remove {}", path.escaped())]
    OtherMachine { name: String, machine: String, path: PathBuf },
    #[error(transparent)]
    Unlike(#[from] Unlike),
    #[error("the baseline lacks {0}: save it again with --save-baseline, or compare what it holds")]
    New(String),
    #[error("the baseline holds {0}, which is not compared now: name the same scenes, workloads and structures")]
    Old(String),
}

/// The file of a baseline in the folder of runs.
///
/// # Errors
/// If the name cannot be one of a file on every system.
pub fn baseline_path(folder: &Path, name: &str) -> Result<PathBuf, BaselineError> {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if name.is_empty() || name.starts_with('.') || !name.chars().all(plain) {
        return Err(BaselineError::Name(name.into()));
    }
    Ok(folder.join("baselines").join(format!("{name}.json")))
}

/// The file for a new baseline, with its folder made.
///
/// # Errors
/// As [`baseline_path`], or if the folder cannot be made.
pub fn new_baseline_path(folder: &Path, name: &str) -> Result<PathBuf, BaselineError> {
    let path = baseline_path(folder, name)?;
    let folder = folder.join("baselines");
    fs::create_dir_all(&folder).map_err(|cause| BaselineError::Folder { path: folder, cause })?;
    Ok(path)
}

/// Whether a run of `provenance` may take the place of the baseline `name`: one of another machine, which nothing here
/// can measure again, is kept. What is no baseline may be replaced.
///
/// # Errors
/// If there is one of another machine.
pub fn may_replace(folder: &Path, name: &str, provenance: &Provenance) -> Result<(), BaselineError> {
    let machine = |of: &Provenance| format!("{}, {}, {}", of.cpu, of.simd, plural(of.threads, "thread"));
    let old = read_baseline(folder, name).unwrap_or_default().first().map(|record| machine(&record.provenance));
    match old.filter(|old| *old != machine(provenance)) {
        Some(machine) => {
            Err(BaselineError::OtherMachine { name: name.into(), machine, path: baseline_path(folder, name)? })
        }
        None => Ok(()),
    }
}

/// The records of a baseline.
///
/// # Errors
/// If there is none of that name, or the file does not hold records.
pub fn read_baseline(folder: &Path, name: &str) -> Result<Vec<Record>, BaselineError> {
    let path = baseline_path(folder, name)?;
    let text = match fs::read(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            let (folder, known) = (folder.join("baselines"), known(&folder.join("baselines")));
            return Err(BaselineError::Missing { name: name.into(), folder, known });
        }
        Err(cause) => return Err(BaselineError::Read { path, cause: cause.to_string() }),
    };
    serde_json::from_slice(&text).map_err(|cause| BaselineError::Read { path, cause: cause.to_string() })
}

fn known(folder: &Path) -> String {
    let files = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> =
        files.filter_map(|file| Some(file.file_name().to_str()?.strip_suffix(".json")?.to_owned())).collect();
    names.sort();
    if names.is_empty() { "save one with --save-baseline".into() } else { format!("there are: {}", names.join(", ")) }
}

/// Holds a run against a baseline of the same cases. `refused` are the structures that could not take part: that they
/// are missing is found, not refused. `looks` as in [`Comparison::new`].
///
/// # Errors
/// If the two are [unlike], or one has cases that the other has not.
pub fn against(
    baseline: &[Record],
    run: &Compared,
    threshold_percent: Option<f64>,
    looks: usize,
) -> Result<Comparison, BaselineError> {
    unlike(baseline, &run.records, Machines::Same)?;
    let comparison = Comparison::new(baseline, &run.records, threshold_percent, looks);
    if let Some(case) = comparison.only_new.first() {
        return Err(BaselineError::New(case.clone()));
    }
    let is_refused = |case: &str| {
        let of =
            |r: &Refused| case.starts_with(&format!("{} on ", r.label)) && case.ends_with(&format!(" of {}", r.scene));
        run.refused.iter().any(of)
    };
    if let Some(case) = comparison.only_old.iter().find(|case| !is_refused(case)) {
        return Err(BaselineError::Old(case.clone()));
    }
    Ok(comparison)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::timed_example;
    use crate::study::diff::Wrong;

    fn record(label: &str) -> Record {
        timed_example(label, "primary", &[1e6; 3], 3)
    }

    #[test]
    fn what_weighs_most_decides() {
        let (old, mut new) = ([record("a"), record("b")], [record("a"), record("b")]);
        new[0].samples_ns.iter_mut().for_each(|ns| *ns *= 2.0);
        let mut comparison = Comparison::new(&old, &new, Some(5.0), 1);
        assert_eq!(outcome(&comparison), Status::Regression);
        comparison.only_old = vec!["c".into()];
        assert_eq!(outcome(&comparison), Status::Refused);
        comparison.wrong = vec![Wrong { case: "a".into(), what: "lost".into() }];
        assert_eq!(outcome(&comparison), Status::Wrong);
        assert_eq!(outcome(&Comparison::new(&old, &new, None, 1)), Status::Right);
        assert_eq!(outcome(&Comparison::new(&old, &old, Some(5.0), 1)), Status::Right);
        new[0].samples_ns = vec![1e6, 2e6, 4e6];
        assert_eq!(outcome(&Comparison::new(&old, &new, Some(5.0), 1)), Status::Undecided);
    }

    #[test]
    fn a_structure_that_fell_out_is_found_and_one_that_was_not_asked_is_refused() {
        let old = [record("a"), record("b")];
        let mut run = Compared { records: vec![record("a")], ..Compared::default() };
        assert!(matches!(against(&old, &run, None, 1), Err(BaselineError::Old(case)) if case.starts_with("b on ")));
        let (scene, reason) = (record("b").scene, "it panicked".into());
        run.refused.push(Refused { label: "b".into(), scene, reason, wrong: false });
        assert_eq!(outcome(&against(&old, &run, None, 1).unwrap()), Status::Refused);
        assert!(matches!(
            against(&old[..1], &Compared { records: old.to_vec(), ..Compared::default() }, None, 1),
            Err(BaselineError::New(_))
        ));
    }

    #[test]
    fn names_stay_in_the_folder() {
        let folder = Path::new("runs");
        assert_eq!(baseline_path(folder, "v1.0_a-b").unwrap(), Path::new("runs/baselines/v1.0_a-b.json"));
        for name in ["", ".", "..", "a/b", "../a", ".hidden", "a b"] {
            assert!(matches!(baseline_path(folder, name), Err(BaselineError::Name(_))), "{name:?}");
        }
    }
}
