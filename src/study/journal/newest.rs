//! Groups comparable cases of a journal and keeps the newest file of each case.

use super::CaseFile;
use crate::escaped::Escaped as _;
use crate::measure::Provenance;
use crate::report::number::plural;
use crate::report::words::{each_once, listed};
use crate::study::{Dataset, JoinedEpochs, Measured, join};

/// Returns one dataset per combination of study, settings, build and machine. Datasets with more cases come first.
pub fn datasets(files: Vec<CaseFile>) -> Vec<Dataset> {
    let mut datasets: Vec<Dataset> = groups(files).iter().map(|group| dataset(group)).collect();
    datasets.retain(|dataset| !dataset.measured.is_empty());
    datasets.sort_by_key(|dataset| std::cmp::Reverse((dataset.measured.len(), dataset.provenance.date.clone())));
    datasets
}

/// Returns the dataset of the group with the newest file.
pub fn newest(files: Vec<CaseFile>) -> Option<Dataset> {
    let groups = groups(files);
    let date = |group: &&Vec<CaseFile>| group.iter().map(|file| file.provenance.date.clone()).max();
    let mut dataset = dataset(groups.iter().max_by_key(date)?);
    if groups.len() > 1 {
        let (others, are) = (plural(groups.len() - 1, "group"), if groups.len() == 2 { "is" } else { "are" });
        dataset.notes.push(format!(
            "{others} of cases with other settings, builds or machines {are} left out; only the newest group is used."
        ));
    }
    Some(dataset)
}

fn groups(files: Vec<CaseFile>) -> Vec<Vec<CaseFile>> {
    let key = |file: &CaseFile| (file.case.study.clone(), file.case.group(), file.provenance.machine());
    let mut groups: Vec<(_, Vec<CaseFile>)> = vec![];
    for file in files {
        let key = key(&file);
        match groups.iter_mut().find(|(other, _)| *other == key) {
            Some((_, files)) => files.push(file),
            None => groups.push((key, vec![file])),
        }
    }
    groups.into_iter().map(|(_, files)| files).collect()
}

fn dataset(files: &[CaseFile]) -> Dataset {
    let mut newest: Vec<&CaseFile> = vec![];
    let mut replaced: Vec<&CaseFile> = vec![];
    for file in files {
        match newest.iter_mut().find(|own| own.case.is_of_scene(&file.case) && own.case.epoch == file.case.epoch) {
            Some(own) if file.provenance.date > own.provenance.date => replaced.push(std::mem::replace(own, file)),
            Some(_) => replaced.push(file),
            None => newest.push(file),
        }
    }
    // Drop epochs whose structures or build limit differ from the newest file of the scene.
    let last = |file: &CaseFile| {
        let own = newest.iter().filter(|other| other.case.is_of_scene(&file.case));
        own.max_by(|a, b| a.provenance.date.cmp(&b.provenance.date))
            .is_some_and(|last| last.case.is_same_measurement(&file.case))
    };
    let mut kept: Vec<&CaseFile> = newest.iter().copied().filter(|file| last(file)).collect();
    kept.sort_by_key(|file| (file.epoch.triangles, file.case.scene_title(), file.case.epoch));
    let measured = kept.iter().map(|file| Measured { case: file.case.clone(), epoch: file.epoch.clone() });
    let JoinedEpochs { measured, failures, unchecked, missing } = join(measured.collect());
    let provenances: Vec<&Provenance> = files.iter().map(|file| &file.provenance).collect();
    let mut dataset = Dataset::new(of_all(&provenances), measured);
    dataset.notes.extend(failures.iter().map(|failure| format!("{failure}; the scene is left out.")));
    dataset.notes.extend(unchecked);
    dataset.notes.extend(missing);
    if let Some(first) = replaced.first() {
        let (cases, were) = (plural(replaced.len(), "case"), if replaced.len() == 1 { "was" } else { "were" });
        let path = first.path.escaped();
        dataset.notes.push(format!("{cases} {were} measured again; the older files are ignored, e.g. {path}."));
    }
    // Times of two hosts may differ even with the same processor.
    let hosts = each_once(files.iter().map(|file| file.provenance.host.as_str()));
    if hosts.len() > 1 {
        let (number, names) = (plural(hosts.len(), "host"), listed(&hosts));
        dataset.notes.push(format!("the cases were measured on {number}: {names}."));
    }
    dataset
}

/// The provenance of the oldest file, with all hosts and the highest load per core.
pub fn of_all(all: &[&Provenance]) -> Provenance {
    let Some(oldest) = all.iter().min_by_key(|one| &one.date) else { return Provenance::capture(1) };
    // The recorded load includes the threads of an earlier job on the same host. `made` estimates the number of
    // these threads.
    let is_on = |one: &Provenance, host: &str| one.host.split(", ").any(|own| own == host);
    let follows = |one: &Provenance| all.iter().any(|other| is_on(other, &one.host) && other.date < one.date);
    let made = |one: &Provenance| if follows(one) { one.threads as f64 } else { 0.0 };
    let load = |one: &&Provenance| Some(((one.load? - made(one)).max(0.0), one.cores));
    let highest = all.iter().filter_map(load).max_by(|a, b| (a.0 / a.1 as f64).total_cmp(&(b.0 / b.1 as f64)));
    let cores = highest.map_or(oldest.cores, |(_, cores)| cores);
    let host = each_once(all.iter().flat_map(|one| one.host.split(", "))).join(", ");
    Provenance { host, cores, load: highest.map(|(load, _)| load), ..(*oldest).clone() }
}
