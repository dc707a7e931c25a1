//! Cases of many machines and builds, each set by itself.

use std::cmp::Reverse;
use std::path::PathBuf;

use serde_json::{Map, Value};

use super::header::differences;
use super::{CaseFile, JournalError};
use crate::measure::Provenance;

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
    let mut machines: Vec<Map<String, Value>> = vec![];
    let mut of_machines: Vec<Vec<CaseFile<C>>> = vec![];
    let mut first: Option<(PathBuf, Map<String, Value>)> = None;
    for file in files {
        let settings = &file.header.settings;
        let (path, known) = first.get_or_insert_with(|| (file.path.clone(), settings.clone()));
        let differences =
            differences(known, settings, |one, other| format!("is {one} in the first and {other} in the second"));
        if !differences.is_empty() {
            let (paths, study) = (Box::new([path.clone(), file.path]), file.header.study);
            return Err(JournalError::Conflict { paths, study, differences });
        }
        let machine = file.header.machine();
        match machines.iter().position(|known| *known == machine) {
            Some(place) => of_machines[place].push(file),
            None => {
                machines.push(machine);
                of_machines.push(vec![file]);
            }
        }
    }
    let group = |mut files: Vec<CaseFile<C>>| {
        let date = |file: &CaseFile<C>| file.header.provenance.date.clone();
        // Of one case the newest comes first.
        files.sort_by_cached_key(|file| (file.key.clone(), Reverse(date(file)), file.path.clone()));
        let is_replaced = |i: usize, files: &[CaseFile<C>]| i > 0 && files[i].key == files[i - 1].key;
        let replaced: Vec<usize> = (0..files.len()).filter(|&i| is_replaced(i, &files)).collect();
        let paths = replaced.iter().map(|&i| files[i].path.clone()).collect();
        let mut place = 0..;
        files.retain(|_| place.next().is_some_and(|place| !replaced.contains(&place)));
        let oldest = files.iter().min_by_key(|file| date(file)).expect("a group has a case");
        Group { provenance: oldest.header.provenance.clone(), replaced: paths, files }
    };
    let mut groups: Vec<Group<C>> = of_machines.into_iter().map(group).collect();
    groups.sort_by_cached_key(|group| (group.files.len(), group.provenance.date.clone()));
    Ok(groups)
}
