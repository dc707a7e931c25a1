//! Rays that a runner has been handed.

use std::borrow::Cow;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::conversation::{Conversation, misfit, nanoseconds};
use crate::accel::{Loaded, Query};
use crate::geometry::{Hit, Ray};
use crate::output::OutputFile;
use crate::scene::Workload;
use crate::scene::files::{HitFile, RayFile, RaysId};

/// What changes from answer to answer.
pub(super) struct State {
    conversation: Conversation,
    /// Why nothing more is asked.
    pub failure: Option<String>,
    /// Which numbers of sets of rays are taken.
    taken: Vec<bool>,
    /// Of each pass, how long it took as seen from outside, as a multiple of what it said.
    pub outside: Vec<f64>,
}

/// A pass that took less tells nothing of clocks: the question and the answer take time as well.
const TELLING_NS: u64 = 1_000_000;

impl State {
    pub fn new(conversation: Conversation) -> Self {
        Self { conversation, failure: None, taken: vec![], outside: vec![] }
    }
}

pub(super) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A set of rays, by its number.
pub(super) struct RaySet<'a> {
    state: &'a Mutex<State>,
    /// Of the files that both read and write.
    folder: &'a Path,
    number: usize,
    rays: Cow<'a, [Ray]>,
    /// What the runner was told; nothing before the first question.
    told: Mutex<Option<RaysId>>,
    own_ns: AtomicU64,
}

impl<'a> RaySet<'a> {
    pub fn new(state: &'a Mutex<State>, folder: &'a Path, rays: Cow<'a, [Ray]>) -> Self {
        let taken = &mut locked(state).taken;
        let number = taken.iter().position(|taken| !taken).unwrap_or(taken.len());
        taken.resize(taken.len().max(number + 1), false);
        taken[number] = true;
        Self { state, folder, number, rays, told: Mutex::new(None), own_ns: AtomicU64::new(0) }
    }

    /// The answers to all rays; nothing once the runner has failed.
    fn answers(&self, query: Query) -> Option<Vec<Option<Hit>>> {
        let state = &mut *locked(self.state);
        if state.failure.is_some() || self.rays.is_empty() {
            return None;
        }
        let answers = self.ask(state, query);
        answers.map_err(|sentence| state.failure = Some(sentence)).ok()
    }

    fn ask(&self, state: &mut State, query: Query) -> Result<Vec<Option<Hit>>, String> {
        let told = &mut *locked(&self.told);
        let id = match told.filter(|told| told.query == query) {
            Some(id) => id,
            None => *told.insert(self.hand_over(state, query)?),
        };

        let request = format!("pass {}", self.number);
        let answer = state.conversation.ask(&request)?;
        let ns = answer.text.strip_prefix("passed ").and_then(nanoseconds);
        let ns = ns.ok_or_else(|| {
            format!("{}; SECONDS are finite and not negative", misfit(&request, &answer.text, "passed SECONDS"))
        })?;
        self.own_ns.store(ns, Ordering::Relaxed);
        if answer.ns > TELLING_NS {
            state.outside.push(answer.ns as f64 / ns.max(1) as f64);
        }

        let path = self.folder.join(format!("{}.hits", self.number));
        let request = format!("hits {} {}", self.number, path.display());
        let (answer, form) = (state.conversation.ask(&request)?.text, format!("written {}", self.rays.len()));
        if answer != form {
            return Err(misfit(&request, &answer, &form));
        }
        let file = HitFile::read(&path).map_err(|error| format!("its hits are not to be had: {error}"))?;
        let _ = std::fs::remove_file(&path);
        let hits = file.answers_to(&id).map_err(|problem| format!("its hits are no answer: {problem}"))?;
        Ok(hits.to_vec())
    }

    /// Tells the runner which rays, and what is asked of them.
    fn hand_over(&self, state: &mut State, query: Query) -> Result<RaysId, String> {
        let workload = Workload { name: query.name().into(), query, rays: self.rays.to_vec() };
        let id = RaysId::of(&workload);
        let path = self.folder.join(format!("{}.rays", self.number));
        let file = RayFile { scene: String::new(), scene_hash: None, workload };
        let written = OutputFile::check(&path).map_err(Into::into).and_then(|output| file.write(&output));
        written.map_err(|error| error.to_string())?;
        let request = format!("rays {} {}", self.number, path.display());
        let (answer, form) = (state.conversation.ask(&request)?.text, format!("loaded {}", self.rays.len()));
        let _ = std::fs::remove_file(path);
        if answer == form { Ok(id) } else { Err(misfit(&request, &answer, &form)) }
    }
}

impl Drop for RaySet<'_> {
    fn drop(&mut self) {
        locked(self.state).taken[self.number] = false;
    }
}

impl Loaded for RaySet<'_> {
    fn closest_hits(&self, hits: &mut [Option<Hit>]) {
        match self.answers(Query::Closest) {
            Some(answers) => hits.copy_from_slice(&answers),
            None => hits.fill(None),
        }
    }

    fn any_hits(&self, hits: &mut [bool]) {
        match self.answers(Query::Any) {
            Some(answers) => hits.iter_mut().zip(answers).for_each(|(hit, answer)| *hit = answer.is_some()),
            None => hits.fill(false),
        }
    }

    fn own_ns(&self) -> Option<u64> {
        Some(self.own_ns.load(Ordering::Relaxed))
    }
}
