//! What a study is going to measure.

use std::path::PathBuf;

use serde::Serialize;
use serde_json::{Map, Value};

use super::{Stage, StudyError};
use crate::measure::{Clock, Threads};
use crate::report::Record;
use crate::report::words::scene_name;
use crate::scene::Scene;

/// How much `study all` measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    Full,
    /// A few minutes for trying out: few scenes, rays and epochs.
    Quick,
}

/// A scene, as cases and pages name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneId {
    pub name: String,
    /// SHA-256, where it is known.
    pub hash: Option<String>,
}

impl SceneId {
    /// That of a record.
    pub fn of(record: &Record) -> Self {
        Self { name: record.scene.clone(), hash: Some(record.scene_hash.clone()) }
    }
}

/// The cases of a run, in the order in which they are measured.
pub struct Plan<C> {
    /// Everything that a case depends on and its key does not tell, by the name of the option.
    pub settings: Map<String, Value>,
    pub threads: Threads,
    pub cases: Vec<Planned>,
    /// Of a scene no further epoch is begun that would take it beyond this.
    pub limit_ns: Option<u64>,
    /// What is said below the tables.
    pub notes: Vec<String>,
    /// Of the notes those that are said before anything is measured.
    pub warnings: Vec<String>,
    /// Files that are read, and so are not written.
    pub inputs: Vec<PathBuf>,
    /// What this machine decided and another one would decide otherwise, in words of the command line: jobs are told.
    pub decided: Vec<String>,
    pub measure: Measure<C>,
}

/// Measures a case of the plan, whatever others are measured.
pub type Measure<C> = Box<dyn Fn(&Planned, &dyn Clock, &mut dyn FnMut(Stage)) -> Result<C, StudyError>>;

/// One case of a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Planned {
    /// Its name in the journal.
    pub key: String,
    /// As the progress bar names it.
    pub title: String,
    /// Number of its scene.
    pub scene: usize,
    /// Counted from 0.
    pub epoch: usize,
    /// How long it takes, about, as a multiple of any unit.
    pub work: u64,
    /// Name of its scene: of those that are named, the process that measures the case loads no other.
    pub loads: String,
}

impl<C> Plan<C> {
    /// A plan of one case for each of `scenes`, by their names and keys.
    pub fn of_scenes(
        settings: &impl Serialize,
        threads: Threads,
        scenes: impl IntoIterator<Item = (String, String)>,
        measure: Measure<C>,
    ) -> Self {
        let planned = |(scene, (loads, key)): (usize, (String, String))| {
            let title = loads.clone();
            Planned { key, title, scene, epoch: 0, work: 1, loads }
        };
        Self {
            settings: settings_map(settings),
            threads,
            cases: scenes.into_iter().enumerate().map(planned).collect(),
            limit_ns: None,
            notes: vec![],
            warnings: vec![],
            inputs: vec![],
            decided: vec![],
            measure,
        }
    }

    /// The same plan of other cases: those that `of` makes of these.
    pub fn map<D: 'static>(self, of: fn(C) -> D) -> Plan<D>
    where
        C: 'static,
    {
        let Self { settings, threads, cases, limit_ns, notes, warnings, inputs, decided, measure } = self;
        let measure: Measure<D> = Box::new(move |case, clock, progress| measure(case, clock, progress).map(of));
        Plan { settings, threads, cases, limit_ns, notes, warnings, inputs, decided, measure }
    }

    /// All epochs of a scene one after the other: its tables are there before the next one begins.
    pub fn scene_by_scene(mut self) -> Self {
        self.cases.sort_by_key(|case| case.scene);
        self
    }

    /// How long all cases take, as a multiple of the same unit.
    pub fn work<'a>(cases: impl IntoIterator<Item = &'a Planned>) -> u64 {
        cases.into_iter().map(|case| case.work).sum()
    }
}

/// The key of a case that is a whole scene.
pub fn scene_key(scene: &Scene) -> String {
    format!("{} {}", scene_name(&scene.name, !scene.stand_ins.is_empty()), &scene.hash()[..HASH])
}

/// Digits of the hash of a scene in keys.
const HASH: usize = 16;

/// The name of the scene and the hash in a key that begins with them, as [`scene_key`] does. A name may hold what looks
/// like a hash: the last such word is the hash.
pub fn scene_of_key(key: &str) -> Option<(&str, &str)> {
    let is_hash = |word: &&str| word.len() == HASH && word.bytes().all(|byte| byte.is_ascii_hexdigit());
    let hash = |at: usize| key[at + 1..].split(' ').next().filter(is_hash);
    key.rmatch_indices(' ').find_map(|(at, _)| Some((&key[..at], hash(at)?)))
}

/// Notes `of` scenes, each with the name of its scene.
pub fn named_notes(scenes: &[Scene], of: fn(&Scene) -> &Vec<String>) -> Vec<String> {
    scenes.iter().flat_map(|scene| of(scene).iter().map(|note| format!("{}: {note}", scene.name))).collect()
}

/// Settings by name.
///
/// # Panics
/// If they are no struct with named fields.
pub fn settings_map(settings: &impl Serialize) -> Map<String, Value> {
    match serde_json::to_value(settings).expect("settings serialise") {
        Value::Object(settings) => settings,
        other => panic!("settings must be a struct with named fields, not {other}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Builtin;

    #[test]
    fn the_scene_of_a_key_is_found_again() {
        for name in ["my mesh", "scan 0123456789abcdef of it"] {
            let scene = Scene { name: name.into(), ..Builtin::find("cube").unwrap().scene(None).unwrap() };
            let (key, hash) = (scene_key(&scene), scene.hash());
            let expected = Some((name, &hash[..16]));
            assert_eq!((scene_of_key(&key), scene_of_key(&format!("{key} epoch 0"))), (expected, expected));
        }
        assert_eq!(scene_of_key("r=10 @1e5"), None);
    }
}
