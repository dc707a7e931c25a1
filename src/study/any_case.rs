//! A case whose type is not known.

use std::any::Any;

use serde::{Deserialize, Serialize, Serializer};
use serde_json::Value;

use super::Study;
use super::epoch::Epoch;

/// A case of a study, without its type.
pub trait AnyCase {
    /// As its file has it.
    fn value(&self) -> Value;
    /// [`Study::epoch`].
    fn epoch(&mut self) -> Option<(&mut Epoch, usize)>;
    fn cloned(&self) -> Box<dyn AnyCase>;
    fn as_any(&self) -> &dyn Any;
}

impl Clone for Box<dyn AnyCase> {
    fn clone(&self) -> Self {
        (**self).cloned()
    }
}

impl Serialize for dyn AnyCase {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.value().serialize(serializer)
    }
}

struct CaseOf<S: Study>(S::Case);

impl<S: Study> AnyCase for CaseOf<S> {
    fn value(&self) -> Value {
        serde_json::to_value(&self.0).expect("a case has text keys")
    }

    fn epoch(&mut self) -> Option<(&mut Epoch, usize)> {
        S::epoch(&mut self.0)
    }

    fn cloned(&self) -> Box<dyn AnyCase> {
        of::<S>(self.0.clone())
    }

    fn as_any(&self) -> &dyn Any {
        &self.0
    }
}

/// A case of the study `S`.
pub fn of<S: Study>(case: S::Case) -> Box<dyn AnyCase> {
    Box::new(CaseOf::<S>(case))
}

/// Reads a case of the study `S`.
///
/// # Errors
/// If the value is none.
pub fn read<S: Study>(value: &Value) -> serde_json::Result<Box<dyn AnyCase>> {
    Ok(of::<S>(S::Case::deserialize(value)?))
}

/// Cases of the study `S`.
///
/// # Panics
/// If one of them is of another.
pub fn typed<S: Study>(cases: &[Box<dyn AnyCase>]) -> Vec<S::Case> {
    let own = |case: &dyn AnyCase| case.as_any().downcast_ref::<S::Case>().expect("the case is of this study").clone();
    cases.iter().map(|case| own(&**case)).collect()
}
