//! A structure in a process of its own answering one workload.

use std::borrow::Cow;
use std::cell::RefCell;
use std::rc::Rc;

use super::answers::Answers;
use super::tiles::tiles;
use super::{Stopwatch, Timed};
use crate::accel::{DynAccel, Loaded, Query, Remote};
use crate::geometry::Ray;

/// Why a pass means nothing, once it has failed.
pub type Failure = Rc<RefCell<Option<String>>>;

/// As [`Pass`](super::Pass), for a structure that is [`Remote`]: it has all rays of a level at once, since each question takes
/// time, and its time is what it says itself. A failure is kept and told, and ends nothing.
pub struct RemotePass<'a> {
    accel: &'a dyn DynAccel,
    remote: &'a dyn Remote,
    all: &'a [Ray],
    /// Of each level.
    batches: Vec<Batch<'a>>,
    /// The last rays of the workload, an eighth of those that are timed.
    lead_in: Option<Batch<'a>>,
    answers: Answers,
    aside: Answers,
    /// Whether the lead-in's answers are answers of the pass as well.
    led_in: bool,
    /// Whether the rays that are timed have been asked for once.
    is_warm: bool,
    failure: Failure,
}

struct Batch<'a> {
    rays: Box<dyn Loaded + 'a>,
    count: usize,
}

/// Of what is timed, the share that a lead-in has.
const LEAD_IN_SHARE: usize = 8;

impl<'a> RemotePass<'a> {
    /// A pass over all rays, and why it failed, once it has.
    ///
    /// # Panics
    /// If there are no rays.
    pub fn new(accel: &'a dyn DynAccel, remote: &'a dyn Remote, rays: &'a [Ray], query: Query) -> (Self, Failure) {
        assert!(!rays.is_empty(), "a pass has rays");
        let failure = Failure::default();
        let mut pass = Self {
            accel,
            remote,
            all: rays,
            batches: vec![],
            lead_in: None,
            answers: Answers::none(query),
            aside: Answers::none(query),
            led_in: false,
            is_warm: false,
            failure: Rc::clone(&failure),
        };
        pass.choose(&[0], 0);
        (pass, failure)
    }

    /// Whether it has failed, now or before.
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
            Batch { count: rays.len(), rays: self.accel.load(Cow::Owned(rays)) }
        };
        let batches: Vec<Batch> = levels.iter().map(batch).collect();
        let count = batches[0].count / LEAD_IN_SHARE;
        let last = &self.all[self.all.len() - count..];
        self.lead_in = (count > 0).then(|| Batch { rays: self.accel.load(Cow::Borrowed(last)), count });
        self.answers.resize(batches.iter().map(|batch| batch.count).max().unwrap_or(0));
        self.aside.resize(count);
        self.batches = batches;
        self.is_warm = false;
    }

    fn clear(&mut self) {
        self.led_in = false;
    }

    fn lead_in(&mut self) {
        // The tiles of a part of the rays lie far apart, and the lead-in is near none of them.
        if !self.is_warm && !self.has_failed() {
            let batch = &self.batches[0];
            self.answers.first(batch.count).ask(batch.rays.as_ref());
            self.is_warm = true;
        }
        if let Some(batch) = self.lead_in.as_ref().filter(|_| !self.has_failed()) {
            self.aside.first(batch.count).ask(batch.rays.as_ref());
            self.led_in = self.batches[0].count == self.all.len();
        }
    }

    fn run(&mut self, _: &Stopwatch) -> Vec<u64> {
        let mut ns = vec![0; self.batches.len()];
        // The first level comes last, and its answers stay.
        for (batch, ns) in self.batches.iter().zip(&mut ns).rev() {
            if self.has_failed() {
                break;
            }
            self.answers.first(batch.count).ask(batch.rays.as_ref());
            *ns = batch.rays.own_ns().unwrap_or(0);
        }
        ns
    }

    fn checksum(&self) -> u64 {
        if self.has_failed() { 0 } else { self.answers.checksum(0..self.batches[0].count) }
    }

    fn contradicts_itself(&self) -> bool {
        let (all, led_in) = (self.batches[0].count, self.aside.len());
        let contradicts = || self.aside.checksum(0..led_in) != self.answers.checksum(all - led_in..all);
        self.led_in && !self.has_failed() && contradicts()
    }
}
