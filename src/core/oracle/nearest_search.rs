use std::cmp::Ordering;

use glam::Vec3;

use super::Truth;
use super::filter::{Proof, Span, classify};
use crate::exact::{self, ExactT};
use crate::geometry::{Mesh, Ray};

pub struct NearestSearch<'a> {
    ray: &'a Ray,
    mesh: &'a Mesh,
    t_max: f64,
    nearest: Option<NearestHit>,
}

struct NearestHit {
    corners: [Vec3; 3],
    span: Span,
    /// `None` until the exact `t` is needed.
    t: Option<ExactT>,
    ids: Vec<u32>,
}

impl<'a> NearestSearch<'a> {
    /// `ray` must be valid.
    pub fn new(ray: &'a Ray, mesh: &'a Mesh) -> Self {
        Self { ray, mesh, t_max: ray.end(), nearest: None }
    }

    pub fn truth(self) -> Option<Truth> {
        let mut found = self.nearest?;
        found.compute_t(self.ray);
        found.ids.sort_unstable();
        Some(Truth { t: found.t?, ids: found.ids })
    }

    /// Tests triangle `id`. The result is an upper bound for the `t` of the nearest hit.
    pub fn triangle(&mut self, id: u32) -> f64 {
        // Two triangles with equal corners are hit at equal `t`.
        if let Some(nearest) = self.nearest.as_mut().filter(|n| n.corners == self.mesh.corners(id)) {
            nearest.ids.push(id);
        } else if let Some(mut found) = self.find(id) {
            let order = self.nearest.as_mut().map_or(Ordering::Less, |nearest| found.compare(nearest, self.ray));
            match (order, &mut self.nearest) {
                (Ordering::Equal, Some(nearest)) => nearest.ids.push(id),
                (Ordering::Less, _) => self.nearest = Some(found),
                _ => {}
            }
        }
        self.nearest.as_ref().map_or(self.t_max, |nearest| nearest.span.high)
    }

    fn find(&self, id: u32) -> Option<NearestHit> {
        let corners = self.mesh.corners(id);
        let (span, t) = match classify(self.ray, corners) {
            Proof::Missed => return None,
            Proof::Hit(span) => (span, None),
            Proof::Undecided => {
                let t = exact::hit(self.ray, corners)?;
                let near = t.approximate();
                (Span::outward(near, near), Some(t))
            }
        };
        let (t_min, t_max) = (f64::from(self.ray.interval().0), self.t_max);
        if span.high < t_min || t_max <= span.low {
            return None;
        }
        let mut found = NearestHit { corners, span, t, ids: vec![id] };
        if span.low < t_min || t_max <= span.high {
            found.compute_t(self.ray);
            return found.t.as_ref().is_some_and(|t| t.is_within(self.ray)).then_some(found);
        }
        Some(found)
    }
}

impl NearestHit {
    fn compute_t(&mut self, ray: &Ray) {
        if self.t.is_none() {
            self.t = exact::hit(ray, self.corners);
            debug_assert!(self.t.is_some(), "the filter has proved this hit");
        }
    }

    fn compare(&mut self, other: &mut Self, ray: &Ray) -> Ordering {
        if self.span.high < other.span.low {
            return Ordering::Less;
        }
        if other.span.high < self.span.low {
            return Ordering::Greater;
        }
        self.compute_t(ray);
        other.compute_t(ray);
        self.t.cmp(&other.t)
    }
}
