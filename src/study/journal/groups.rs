//! Cases of many machines and builds, each set by itself.

use std::cmp::Reverse;
use std::path::PathBuf;

use super::header::differences;
use super::{CaseFile, JournalError};
use crate::measure::Provenance;
use crate::report::words::each_once;
use crate::study::grouped::grouped;

/// Cases of one study that one build has measured on one machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Group<C> {
    /// Of the oldest of them, with the hosts of all and the highest load that one of them met.
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
        let all: Vec<&Provenance> = files.iter().map(|file| &file.header.provenance).collect();
        Group { provenance: of_all(&all), replaced, files }
    };
    let of_machines = grouped(files, |one, other| one.header.machine() == other.header.machine());
    let mut groups: Vec<Group<C>> = of_machines.into_iter().map(group).collect();
    groups.sort_by_cached_key(|group| (group.files.len(), group.provenance.date.clone()));
    Ok(groups)
}

/// That of the oldest, with the hosts of all, and the load of the one that met the highest for its cores.
///
/// # Panics
/// If there are none.
pub(super) fn of_all(all: &[&Provenance]) -> Provenance {
    let oldest = all.iter().min_by_key(|one| &one.date).expect("a group has a case");
    // A job that follows another one meets the load that that has made.
    let is_on = |one: &Provenance, host: &str| one.host.split(", ").any(|own| own == host);
    let follows = |one: &Provenance| all.iter().any(|other| is_on(other, &one.host) && other.date < one.date);
    let made = |one: &Provenance| if follows(one) { one.threads as f64 } else { 0.0 };
    let load = |one: &&Provenance| Some(((one.load? - made(one)).max(0.0), one.cores));
    let highest = all.iter().filter_map(load).max_by(|a, b| (a.0 / a.1 as f64).total_cmp(&(b.0 / b.1 as f64)));
    let cores = highest.map_or(oldest.cores, |(_, cores)| cores);
    let host = each_once(all.iter().flat_map(|one| one.host.split(", "))).join(", ");
    Provenance { host, cores, load: highest.map(|(load, _)| load), ..(*oldest).clone() }
}
