//! What was measured, kind of rays by kind of rays.

use super::front::dominators;
use crate::measure::median;
use crate::report::words::each_once;
use crate::request::RayKind;
use crate::study::epoch::{Rays, Structure};
use crate::study::{Case, Dataset, Epoch};
use crate::validate::ErrorCounts;

/// All structures with a time on the rays of one kind of one scene.
pub struct JudgedRays<'a> {
    pub case: &'a Case,
    pub epoch: &'a Epoch,
    /// The kind of the rays.
    pub kind: &'a str,
    pub structures: Vec<Judged<'a>>,
}

/// One structure over one triangle test on the rays of one kind: how wrong, and how fast.
pub struct Judged<'a> {
    pub structure: &'a Structure,
    pub rays: &'a Rays,
    pub errors: &'a ErrorCounts,
    /// Median of the samples, nanoseconds.
    pub ns_per_ray: f64,
    /// Share of the rays with a wrong answer: missed, false hit or wrong depth.
    pub error: f64,
    /// What the true share is below, with 95 % confidence.
    pub error_bound: f64,
    /// The label of a structure on the front that is at most as slow and at most as wrong; nothing for the front
    /// itself.
    pub dominated_by: Option<&'a str>,
}

/// Scene by scene and kind by kind.
pub fn judged(dataset: &Dataset) -> Vec<JudgedRays<'_>> {
    let mut all = vec![];
    for scene in dataset.scenes() {
        let (case, epoch) = (scene.case, scene.epochs[0]);
        let kinds = each_once(epoch.structures.iter().flat_map(|own| &own.rays).map(|rays| rays.workload.as_str()));
        for kind in kinds {
            let mut structures: Vec<Judged> = epoch.structures.iter().filter_map(|own| Judged::of(own, kind)).collect();
            // What is not proven is not credited: an error that was seen once may be less than one that was not seen in
            // fewer rays.
            let points: Vec<(f64, f64)> = structures.iter().map(|own| (own.ns_per_ray, own.error_bound)).collect();
            let labels: Vec<&str> = structures.iter().map(|own| own.structure.label.as_str()).collect();
            for (own, dominator) in structures.iter_mut().zip(dominators(&points)) {
                own.dominated_by = dominator.map(|place| labels[place]);
            }
            if !structures.is_empty() {
                all.push(JudgedRays { case, epoch, kind, structures });
            }
        }
    }
    all
}

impl JudgedRays<'_> {
    /// What the rays are, in a few words.
    pub fn description(&self) -> &'static str {
        self.kind.parse().map_or("rays of a file", RayKind::description)
    }

    /// The most that `of` says of a structure.
    pub fn most(&self, of: fn(&Judged) -> u64) -> u64 {
        self.structures.iter().map(of).max().unwrap_or(0)
    }
}

impl<'a> Judged<'a> {
    /// Nothing where the structure has no time.
    fn of(structure: &'a Structure, kind: &str) -> Option<Self> {
        let rays = structure.rays.iter().find(|rays| rays.workload == kind)?;
        let errors = rays.errors.as_ref()?;
        let (error, error_bound) = (errors.error().share()?, errors.error().bound()?);
        let ns_per_ray = median(&rays.paces(rays.rays))?;
        Some(Self { structure, rays, errors, ns_per_ray, error, error_bound, dominated_by: None })
    }

    /// Whether a part of the rays is judged.
    pub fn is_sampled(&self) -> bool {
        self.errors.rays < self.rays.all as u64
    }
}
