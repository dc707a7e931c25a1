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
        let typed = |file: &CaseFile<Value>| Ok(file.clone().typed(self.reader())?.case);
        let mut cases = group.files.iter().map(typed).collect::<Result<Vec<Box<dyn AnyCase>>, JournalError>>()?;
        // As they come from many machines in no order: small scenes first.
        cases.sort_by_cached_key(|case| case.clone().epoch().map(|(epoch, _)| epoch.triangles));
        let joined = join(cases, |case| case.epoch(), self.is_whole());
        let failures = joined.failures.iter().map(|failure| format!("{failure}; the scene is left out."));
        let notes = failures.chain(joined.unchecked).chain(joined.missing);
        let answer = self.answer(&joined.cases, &group.provenance, others, None);
        Ok(Found { notes: notes.collect(), answer })
    }
}
