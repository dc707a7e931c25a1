//! Timed passes of a structure that runs in a separate process.

use std::borrow::Cow;
use std::cell::RefCell;
use std::rc::Rc;

use super::pass::LEAD_IN_SHARE;
use super::query_results::QueryResults;
use super::tiles::tiles;
use super::{Stopwatch, Timed};
use crate::accel::{DynAccel, Loaded, Query, Remote};
use crate::geometry::Ray;

/// `None` if the pass has not failed.
pub type Failure = Rc<RefCell<Option<String>>>;

/// Every request to the process takes time, so one request contains all rays of a level. The process measures the time
/// of the pass.
pub struct RemotePass<'a> {
    accel: &'a dyn DynAccel,
    remote: &'a dyn Remote,
    all: &'a [Ray],
    query: Query,
    /// One per level.
    batches: Vec<RayBatch<'a>>,
    lead_in: Option<RayBatch<'a>>,
    results: QueryResults,
    lead_in_results: QueryResults,
    /// Whether `lead_in_results` can be compared with `results`.
    has_led_in: bool,
    is_warm: bool,
    failure: Failure,
}

struct RayBatch<'a> {
    rays: Box<dyn Loaded + 'a>,
    count: usize,
}

impl RayBatch<'_> {
    fn query(&self, results: &mut QueryResults) {
        results.query(0..self.count, self.rays.as_ref());
    }
}

impl<'a> RemotePass<'a> {
    /// # Panics
    /// If there are no rays.
    pub fn new(accel: &'a dyn DynAccel, remote: &'a dyn Remote, rays: &'a [Ray], query: Query) -> (Self, Failure) {
        assert!(!rays.is_empty(), "a pass needs at least one ray");
        let failure = Failure::default();
        let mut pass = Self {
            accel,
            remote,
            all: rays,
            query,
            batches: vec![],
            lead_in: None,
            results: QueryResults::misses(query, 0),
            lead_in_results: QueryResults::misses(query, 0),
            has_led_in: false,
            is_warm: false,
            failure: Rc::clone(&failure),
        };
        pass.choose(&[0], 0);
        (pass, failure)
    }

    /// Stores the first failure of the structure.
    fn has_failed(&self) -> bool {
        let failure = &mut *self.failure.borrow_mut();
        *failure = failure.take().or_else(|| self.remote.failure());
        failure.is_some()
    }
}

impl Timed for RemotePass<'_> {
    fn rays(&self) -> usize {
        self.all.len()
    }

    fn choose(&mut self, levels: &[usize], epoch: usize) {
        let batch = |&level: &usize| {
            let rays: Vec<Ray> =
                tiles(self.all.len(), level, epoch).into_iter().flat_map(|tile| &self.all[tile]).copied().collect();
            RayBatch { count: rays.len(), rays: self.accel.load(Cow::Owned(rays)) }
        };
        let batches: Vec<RayBatch> = levels.iter().map(batch).collect();
        let count = batches[0].count / LEAD_IN_SHARE;
        let last = &self.all[self.all.len() - count..];
        self.lead_in = (count > 0).then(|| RayBatch { rays: self.accel.load(Cow::Borrowed(last)), count });
        let most = batches.iter().map(|batch| batch.count).max().unwrap_or(0);
        (self.results, self.lead_in_results) =
            (QueryResults::misses(self.query, most), QueryResults::misses(self.query, count));
        self.batches = batches;
        self.is_warm = false;
    }

    fn clear(&mut self) {
        self.has_led_in = false;
    }

    fn lead_in(&mut self) {
        // An untimed first pass over batch 0 warms the caches. The tiles of a subset may lie far from the lead-in rays.
        if !self.is_warm && !self.has_failed() {
            self.batches[0].query(&mut self.results);
            self.is_warm = true;
        }
        if let Some(batch) = self.lead_in.as_ref().filter(|_| !self.has_failed()) {
            batch.query(&mut self.lead_in_results);
            self.has_led_in = self.batches[0].count == self.all.len();
        }
    }

    fn run(&mut self, _: &Stopwatch) -> Vec<u64> {
        let mut ns = vec![0; self.batches.len()];
        // The loop ends with batch 0, because `checksum` must read the results of batch 0.
        for (batch, ns) in self.batches.iter().zip(&mut ns).rev() {
            if self.has_failed() {
                break;
            }
            batch.query(&mut self.results);
            *ns = batch.rays.own_ns().unwrap_or(0);
        }
        ns
    }

    fn checksum(&self) -> u64 {
        if self.has_failed() { 0 } else { self.results.checksum(0..self.batches[0].count) }
    }

    fn contradicts_itself(&self) -> bool {
        let (all, last) = (self.batches[0].count, self.lead_in_results.count());
        let contradicts = || self.lead_in_results.checksum(0..last) != self.results.checksum(all - last..all);
        self.has_led_in && !self.has_failed() && contradicts()
    }
}
