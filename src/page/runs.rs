//! Reads measured cases from journals and exports.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::escaped::Escaped as _;
use crate::measure::Provenance;
use crate::report::Report;
use crate::report::words::{command_line, each_once, each_once_by, listed};
use crate::request::SceneRequest;
use crate::study::journal::{self, CaseFile, JournalError};
use crate::study::{Dataset, Studies, Study};

pub const COMPARE: &str = "compare";

#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error(
        "{} is JSON, but not a run of sahara: name export files (`--export-json`) or files of a journal",
        path.escaped()
    )]
    Foreign { path: PathBuf },
    #[error("{} belongs to the study {study:?}, which this sahara does not have: omit it", path.escaped())]
    Unknown { path: PathBuf, study: String },
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error(
        "there is no run in {}: measure one with `sahara study all`, or a small one with `sahara compare \
         --export-json {}/compare.json`",
        path.escaped(),
        path.escaped()
    )]
    Empty { path: PathBuf },
}

#[derive(Default)]
pub struct Runs<'a> {
    /// The measured studies, in the order of [`Studies`].
    pub studies: Vec<StudyRun<'a>>,
    /// Notes in the report, such as a note about an ignored file.
    pub notes: Vec<String>,
}

pub struct StudyRun<'a> {
    pub study: &'a Study,
    /// The dataset with the most cases. `report` is made from this dataset.
    pub dataset: Dataset,
    pub others: Vec<Dataset>,
    pub report: Report,
}

impl<'a> Runs<'a> {
    /// From each folder, reads the `.json` files and the journals. If a case was measured several times, the newest
    /// measurement is used.
    pub fn read(paths: &[PathBuf], studies: &'a Studies) -> Result<Self, RunError> {
        let mut runs = Self::default();
        let mut cases = vec![];
        for path in paths {
            let is_folder = path.is_dir();
            let files = if is_folder { folder(path, studies)? } else { vec![path.clone()] };
            if files.is_empty() {
                return Err(RunError::Empty { path: path.clone() });
            }
            for file in files {
                match read(&file, studies, &mut runs.notes) {
                    Ok(own) => cases.extend(own),
                    // A folder may contain files of other programs.
                    Err(RunError::Foreign { .. } | RunError::Unknown { .. }) if is_folder => {
                        runs.notes.push(format!("{} is not a run: ignored.", file.escaped()));
                    }
                    Err(error) => return Err(error),
                }
            }
        }
        if let (true, Some(path)) = (cases.is_empty(), paths.first()) {
            return Err(RunError::Empty { path: path.clone() });
        }
        let mut datasets = journal::datasets(each_measured_once(cases));
        for study in studies.iter() {
            let mut own = datasets.extract_if(.., |own| own.study() == Some(study.name));
            let Some(dataset) = own.next() else { continue };
            let others: Vec<Dataset> = own.collect();
            let notes = std::iter::once(&dataset).chain(&others).flat_map(|dataset| &dataset.notes);
            runs.notes.extend(notes.map(|note| format!("{}: {note}", study.name)));
            let report = (study.report)(&dataset, &study.defaults());
            runs.studies.push(StudyRun { study, dataset, others, report });
        }
        runs.notes = each_once(runs.notes);
        Ok(runs)
    }

    pub fn of(&self, study: &str) -> Option<&StudyRun<'a>> {
        self.studies.iter().find(|run| run.study.name == study)
    }

    pub fn provenances(&self) -> Vec<&Provenance> {
        self.studies.iter().map(|run| &run.dataset.provenance).collect()
    }

    pub fn commands(&self) -> Vec<String> {
        each_once(self.studies.iter().flat_map(StudyRun::commands))
    }

    pub fn scenes(&self) -> Vec<SceneRequest> {
        let measured = self.studies.iter().flat_map(|run| &run.dataset.measured);
        each_once(measured.map(|measured| measured.case.scene.clone()))
    }
}

impl StudyRun<'_> {
    pub fn commands(&self) -> Vec<String> {
        each_once(self.dataset.commands().into_iter().map(command_line))
    }
}

pub fn scene_titles(dataset: &Dataset) -> Vec<String> {
    each_once(dataset.measured.iter().map(|measured| measured.case.scene_title()))
}

pub fn also_measured(dataset: &Dataset) -> String {
    let Provenance { cpu, commit, date, .. } = &dataset.provenance;
    let commands: Vec<String> =
        dataset.commands().into_iter().map(|line| format!("`{}`", command_line(line))).collect();
    let (scenes, day) = (listed(&scene_titles(dataset)), date.split('T').next().unwrap_or(date));
    format!("Measured but not shown: {scenes} on {cpu}, commit {commit}, {day} ({}).", listed(&commands))
}

fn read(path: &Path, studies: &Studies, notes: &mut Vec<String>) -> Result<Vec<CaseFile>, RunError> {
    let text = fs::read_to_string(path).map_err(|cause| JournalError::Read { path: path.into(), cause })?;
    let value: Value = serde_json::from_str(&text).map_err(|cause| JournalError::damaged(path, &cause))?;
    let known = |name: &str| match studies.find(name) {
        Some(study) => Ok(study.name),
        None => Err(RunError::Unknown { path: path.into(), study: name.into() }),
    };
    if CaseFile::is_case(&value) {
        let case = CaseFile::of(path, value)?;
        known(&case.case.study)?;
        return Ok(vec![case]);
    }
    if !Dataset::is_dataset(&value) {
        return Err(RunError::Foreign { path: path.into() });
    }
    let Dataset { provenance, measured, notes: own, .. } = Dataset::read(path, value)?;
    let study = measured.first().map(|own| own.case.study.clone());
    let study = known(&study.ok_or_else(|| RunError::Foreign { path: path.into() })?)?;
    let cases = measured.into_iter().map(|own| CaseFile {
        path: path.into(),
        provenance: provenance.clone(),
        case: own.case,
        epoch: own.epoch,
    });
    notes.extend(own.iter().map(|note| format!("{study}: {note}")));
    Ok(cases.collect())
}

/// Returns the files in the folder `path` and in its journals.
fn folder(path: &Path, studies: &Studies) -> Result<Vec<PathBuf>, RunError> {
    let journals = studies.iter().map(|study| path.join(study.name)).filter(|journal| journal.is_dir());
    let files = std::iter::once(path.to_path_buf()).chain(journals).map(|folder| journal::files(&folder));
    Ok(files.collect::<Result<Vec<_>, _>>()?.concat())
}

/// Removes repeated cases. An export may contain the same cases as a journal.
fn each_measured_once(cases: Vec<CaseFile>) -> Vec<CaseFile> {
    each_once_by(cases, |one, other| {
        one.epoch == other.epoch && one.case == other.case && one.provenance.machine() == other.provenance.machine()
    })
}
