//! Cases of many machines and builds, each set by itself.

use std::cmp::Reverse;
use std::path::PathBuf;

use super::header::differences;
use super::{CaseFile, JournalError};
use crate::measure::Provenance;
use crate::study::grouped::grouped;

/// Cases of one study that one build has measured on one machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Group<C> {
    /// Of the oldest of them.
    pub provenance: Provenance,
    /// By their keys.
    pub files: Vec<CaseFile<C>>,
    /// Files whose cases were measured again since.
    pub replaced: Vec<PathBuf>,
}

/// The cases of one study by build and machine, the set with the fewest cases first. A case that was measured twice counts once, as it
/// was measured last.
///
/// # Errors
/// If they are of different settings.
pub fn groups<C>(files: Vec<CaseFile<C>>) -> Result<Vec<Group<C>>, JournalError> {
    for file in &files {
        let (first, own) = (&files[0].header, &file.header);
        let differences = differences(&first.settings, &own.settings, |one, other| {
            format!("is {one} in the first and {other} in the second")
        });
        if !differences.is_empty() {
            let (paths, study) = (Box::new([files[0].path.clone(), file.path.clone()]), own.study.clone());
            return Err(JournalError::Conflict { paths, study, differences });
        }
    }
    let group = |mut files: Vec<CaseFile<C>>| {
        let date = |file: &CaseFile<C>| file.header.provenance.date.clone();
        // Of one case the newest comes first.
        files.sort_by_cached_key(|file| (file.key.clone(), Reverse(date(file)), file.path.clone()));
        let mut replaced = vec![];
        files.dedup_by(|file, newest| {
            let is_replaced = file.key == newest.key;
            replaced.extend(is_replaced.then(|| file.path.clone()));
            is_replaced
        });
        let oldest = files.iter().min_by_key(|file| date(file)).expect("a group has a case");
        Group { provenance: oldest.header.provenance.clone(), replaced, files }
    };
    let of_machines = grouped(files, |one, other| one.header.machine() == other.header.machine());
    let mut groups: Vec<Group<C>> = of_machines.into_iter().map(group).collect();
    groups.sort_by_cached_key(|group| (group.files.len(), group.provenance.date.clone()));
    Ok(groups)
}
