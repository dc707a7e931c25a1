use serde_json::Value;

use super::epoch::join;
use super::journal::{CaseFile, Group, JournalError};
use super::{Answers, AnyAnswer, AnyCase, AnyStudy};

/// What is read of cases.
pub struct Found {
    pub answer: AnyAnswer,
    /// What is missing or left out, a sentence each.
    pub notes: Vec<String>,
}

impl dyn AnyStudy + '_ {
    /// The answer to cases of one build and machine.
    ///
    /// # Errors
    /// If one of them is not of this study.
    pub fn read_cases(&self, group: &Group<Value>, others: &Answers) -> Result<Found, JournalError> {
        let read = |file: &CaseFile<Value>| {
            let mut case = file.read_case(self.reader())?;
            Ok((case.epoch().map(|(epoch, _)| epoch.triangles), case))
        };
        let mut cases =
            group.files.iter().map(read).collect::<Result<Vec<(Option<usize>, Box<dyn AnyCase>)>, JournalError>>()?;
        // As they come from many machines in no order: small scenes first.
        cases.sort_by_key(|(triangles, _)| *triangles);
        let cases = cases.into_iter().map(|(_, case)| case).collect();
        let joined = join(cases, |case| case.epoch(), self.is_whole());
        let failures = joined.failures.iter().map(|failure| format!("{failure}; the scene is left out."));
        let notes = failures.chain(joined.unchecked).chain(joined.missing);
        let answer = self.answer(&joined.cases, &group.provenance, others, None);
        Ok(Found { notes: notes.collect(), answer })
    }
}
