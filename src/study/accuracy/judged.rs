//! Groups the measurements by scene and workload.

use crate::measure::median;
use crate::report::words::each_once;
use crate::request::RayKind;
use crate::study::epoch::{Rays, Structure};
use crate::study::{Case, Dataset, Epoch};
use crate::validate::ErrorCounts;

/// The judged structures on one workload of one scene.
pub struct JudgedRays<'a> {
    pub case: &'a Case,
    pub epoch: &'a Epoch,
    /// The name of the workload.
    pub kind: &'a str,
    pub structures: Vec<Judged<'a>>,
}

pub struct Judged<'a> {
    pub structure: &'a Structure,
    pub rays: &'a Rays,
    pub errors: &'a ErrorCounts,
    /// Median of the samples.
    pub ns_per_ray: f64,
    /// Share of wrong results (missed hits, false hits, wrong depths).
    pub error: f64,
    /// Upper bound of the true error rate, with 95 % confidence.
    pub error_bound: f64,
    /// The label of a Pareto-optimal structure that dominates this structure. `None` on the Pareto front.
    pub dominated_by: Option<&'a str>,
}

pub fn judged(dataset: &Dataset) -> Vec<JudgedRays<'_>> {
    let mut all = vec![];
    for scene in dataset.scenes() {
        let (case, epoch) = (scene.case, scene.epochs[0]);
        let kinds = each_once(epoch.structures.iter().flat_map(|own| &own.rays).map(|rays| rays.workload.as_str()));
        for kind in kinds {
            let mut structures: Vec<Judged> = epoch.structures.iter().filter_map(|own| Judged::of(own, kind)).collect();
            // Upper bounds are comparable between structures with different numbers of judged rays.
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
    pub fn description(&self) -> &'static str {
        self.kind.parse().map_or("rays of a file", RayKind::description)
    }

    pub fn most(&self, of: fn(&Judged) -> u64) -> u64 {
        self.structures.iter().map(of).max().unwrap_or(0)
    }
}

impl<'a> Judged<'a> {
    fn of(structure: &'a Structure, kind: &str) -> Option<Self> {
        let rays = structure.rays.iter().find(|rays| rays.workload == kind)?;
        let errors = rays.errors.as_ref()?;
        let (error, error_bound) = (errors.error_share()?, errors.error_bound()?);
        let ns_per_ray = median(&rays.ns_per_ray(rays.rays))?;
        Some(Self { structure, rays, errors, ns_per_ray, error, error_bound, dominated_by: None })
    }

    pub fn is_sampled(&self) -> bool {
        self.errors.rays < self.rays.all as u64
    }
}

/// For each point (cost, error), returns the cheapest dominating point of the Pareto front.
///
/// # References
/// Kung, Luccio, Preparata: On finding the maxima of a set of vectors. J. ACM 22, 1975.
fn dominators(points: &[(f64, f64)]) -> Vec<Option<usize>> {
    let dominates = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    let is_front = |i: &usize| !points.iter().any(|other| dominates(other, &points[*i]));
    let front: Vec<usize> = (0..points.len()).filter(is_front).collect();
    let dominator = |point: &(f64, f64)| {
        let dominating = front.iter().copied().filter(|&i| dominates(&points[i], point));
        dominating.min_by(|&a, &b| points[a].0.total_cmp(&points[b].0))
    };
    points.iter().map(dominator).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_nothing_dominates() {
        let points = [(1.0, 0.5), (2.0, 0.1), (3.0, 0.1), (3.0, 0.6), (9.0, 0.0), (1.0, 0.5)];
        assert_eq!(dominators(&points), [None, None, Some(1), Some(0), None, None]);
        assert_eq!(dominators(&[]), []);
    }
}
