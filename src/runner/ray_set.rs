//! Sets of rays that a runner loads and traces.

use std::borrow::Cow;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::session::{Session, nanoseconds, unexpected};
use crate::accel::{Loaded, Query};
use crate::geometry::{Hit, Ray};
use crate::output::OutputFile;
use crate::scene::Workload;
use crate::scene::files::{HitFile, RayFile, RaysId};

/// The running program, and the data that its ray sets share.
pub(super) struct State {
    pub session: Session,
    /// The reason why the runner failed. A failed runner receives no more requests.
    pub failure: Option<String>,
    /// Element `i` states whether a ray set has the number `i`.
    pub taken: Vec<bool>,
    /// For each pass longer than [`LONG_NS`], the elapsed time divided by the reported time.
    pub outside: Vec<f64>,
}

/// Minimum elapsed time of a pass for [`State::outside`]. Request and reply take a notable part of a shorter pass.
const LONG_NS: u64 = 1_000_000;

pub(super) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

pub(super) struct RaySet<'a> {
    state: &'a Mutex<State>,
    folder: &'a Path,
    number: usize,
    rays: Cow<'a, [Ray]>,
    /// The ID of the rays that the runner has loaded.
    loaded: Mutex<Option<RaysId>>,
    own_ns: AtomicU64,
}

impl<'a> RaySet<'a> {
    pub fn new(state: &'a Mutex<State>, folder: &'a Path, rays: Cow<'a, [Ray]>) -> Self {
        let taken = &mut locked(state).taken;
        let number = taken.iter().position(|taken| !taken).unwrap_or(taken.len());
        taken.resize(taken.len().max(number + 1), false);
        taken[number] = true;
        Self { state, folder, number, rays, loaded: Mutex::new(None), own_ns: AtomicU64::new(0) }
    }

    /// `None` if the runner has failed or there are no rays.
    fn hits(&self, query: Query) -> Option<Vec<Option<Hit>>> {
        let state = &mut *locked(self.state);
        if state.failure.is_some() || self.rays.is_empty() {
            return None;
        }
        self.pass(state, query).map_err(|sentence| state.failure = Some(sentence)).ok()
    }

    fn pass(&self, state: &mut State, query: Query) -> Result<Vec<Option<Hit>>, String> {
        let loaded = &mut *locked(&self.loaded);
        let id = match loaded.filter(|rays| rays.query == query) {
            Some(id) => id,
            None => *loaded.insert(self.send(state, query)?),
        };

        let request = format!("pass {}", self.number);
        let reply = state.session.request(&request)?;
        let ns = reply.text.strip_prefix("passed ").and_then(nanoseconds);
        let ns = ns.ok_or_else(|| {
            format!("{}; SECONDS must be finite and not negative", unexpected(&request, &reply.text, "passed SECONDS"))
        })?;
        self.own_ns.store(ns, Ordering::Relaxed);
        if reply.ns > LONG_NS {
            state.outside.push(reply.ns as f64 / ns.max(1) as f64);
        }

        let path = self.folder.join(format!("{}.hits", self.number));
        let request = format!("hits {} {}", self.number, path.display());
        let (reply, form) = (state.session.request(&request)?.text, format!("written {}", self.rays.len()));
        if reply != form {
            return Err(unexpected(&request, &reply, &form));
        }
        let file = HitFile::read(&path).map_err(|error| format!("its hits cannot be read: {error}"))?;
        let _ = std::fs::remove_file(&path);
        let hits = file.hits_of(&id).map_err(|problem| format!("its hits do not fit the rays: {problem}"))?;
        Ok(hits.to_vec())
    }

    fn send(&self, state: &mut State, query: Query) -> Result<RaysId, String> {
        let workload = Workload { name: query.name().into(), query, rays: self.rays.to_vec() };
        let id = RaysId::of(&workload);
        let path = self.folder.join(format!("{}.rays", self.number));
        let file = RayFile { scene: String::new(), scene_hash: None, workload };
        let written = OutputFile::check(&path).map_err(Into::into).and_then(|output| file.write(&output));
        written.map_err(|error| error.to_string())?;
        let request = format!("rays {} {}", self.number, path.display());
        let (reply, form) = (state.session.request(&request)?.text, format!("loaded {}", self.rays.len()));
        let _ = std::fs::remove_file(path);
        if reply == form { Ok(id) } else { Err(unexpected(&request, &reply, &form)) }
    }
}

impl Drop for RaySet<'_> {
    fn drop(&mut self) {
        locked(self.state).taken[self.number] = false;
    }
}

impl Loaded for RaySet<'_> {
    fn closest_hits(&self, hits: &mut [Option<Hit>]) {
        let found = self.hits(Query::Closest).unwrap_or_else(|| vec![None; hits.len()]);
        hits.copy_from_slice(&found);
    }

    fn any_hits(&self, hits: &mut [bool]) {
        let found = self.hits(Query::Any).unwrap_or_else(|| vec![None; hits.len()]);
        hits.iter_mut().zip(found).for_each(|(hit, found)| *hit = found.is_some());
    }

    fn own_ns(&self) -> Option<u64> {
        Some(self.own_ns.load(Ordering::Relaxed))
    }
}
