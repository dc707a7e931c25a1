use std::any::Any;
use std::collections::BTreeMap;

/// An answer whose type is not known.
pub type AnyAnswer = Box<dyn Any + Send + Sync>;

/// Answers by the names of their studies.
#[derive(Default)]
pub struct Answers {
    by_name: BTreeMap<&'static str, AnyAnswer>,
}

impl Answers {
    /// That of the study `name`.
    pub fn get(&self, name: &str) -> Option<&dyn Any> {
        self.by_name.get(name).map(|answer| &**answer as &dyn Any)
    }

    /// Likewise, to be changed.
    pub(super) fn get_mut(&mut self, name: &str) -> Option<&mut AnyAnswer> {
        self.by_name.get_mut(name)
    }

    /// Adds that of the study `name`, or puts it in the place of another.
    pub(super) fn insert(&mut self, name: &'static str, answer: AnyAnswer) {
        self.by_name.insert(name, answer);
    }
}
