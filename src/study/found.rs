use serde_json::Value;

use super::epoch::{join, missing};
use super::journal::{CaseFile, Group, JournalError, newest};
use super::{Answers, AnyAnswer, AnyCase, AnyStudy};
use crate::report::number::plural;
use crate::report::words::{distinct, listed};

/// What is read of cases.
pub struct Found {
    pub answer: AnyAnswer,
    /// What is missing or left out, and the hosts where there are several, a sentence each.
    pub notes: Vec<String>,
}

impl dyn AnyStudy + '_ {
    /// The answer to cases of one build and machine, of each scene those of the last version of which there is an
    /// answer.
    ///
    /// # Errors
    /// If one of them is not of this study.
    pub fn read_cases(&self, group: &Group<Value>, others: &Answers) -> Result<Found, JournalError> {
        let read = |file: &&CaseFile<Value>| {
            let mut case = file.read_case(self.reader())?;
            Ok((case.epoch().map(|(epoch, _)| epoch.triangles), case))
        };
        let (files, older) = newest(&group.files, self.shows_both_meshes());
        let mut cases =
            files.iter().map(read).collect::<Result<Vec<(Option<usize>, Box<dyn AnyCase>)>, JournalError>>()?;
        // As they come from many machines in no order: small scenes first.
        cases.sort_by_key(|(triangles, _)| *triangles);
        let mut cases: Vec<Box<dyn AnyCase>> = cases.into_iter().map(|(_, case)| case).collect();
        let planned = |most, triangles| self.planned_epochs(most, triangles);
        let missing = missing(&mut cases, |case| case.epoch(), planned);
        let joined = join(cases, |case| case.epoch(), self.is_whole());
        let failures = joined.failures.iter().map(|failure| format!("{failure}; the scene is left out."));
        // Times of different cases may be of different hosts, which one processor does not make alike.
        let hosts = distinct(files.iter().map(|file| &file.header.provenance.host));
        let hosts = (hosts.len() > 1).then(|| format!("cases of {}: {}.", plural(hosts.len(), "host"), listed(&hosts)));
        let notes = failures.chain(joined.unchecked).chain(missing).chain(older).chain(hosts);
        let answer = self.answer(&joined.cases, &group.provenance, others, None);
        Ok(Found { notes: notes.collect(), answer })
    }
}
