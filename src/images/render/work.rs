//! Counts the triangle tests and traversal steps of a structure for single rays.

use rayon::prelude::*;

use crate::accel::{Counts, DynAccel};
use crate::geometry::{Hit, Ray};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Work {
    pub counts: Counts,
    pub hit: Option<Hit>,
}

impl Work {
    /// Traces each of `rays` separately.
    pub fn of(accel: &dyn DynAccel, rays: &[Ray]) -> Vec<Self> {
        let work = |ray: &Ray| {
            let (mut hit, mut counts) = ([None], Counts::default());
            accel.closest_hits_counted(std::slice::from_ref(ray), &mut hit, &mut counts);
            Self { counts, hit: hit[0] }
        };
        rays.par_iter().map(work).collect()
    }

    /// The cost that the heat view shows.
    pub fn cost(&self) -> u64 {
        self.counts.tests + self.counts.steps()
    }
}
