use std::cmp::Ordering;

use glam::Vec3;

use super::enclosure::{Sight, place};
use crate::exact;
use crate::geometry::Ray;
use crate::triangle::Depth;

/// Where a ray meets a triangle, exactly: bounds in `f32`, and what it takes to compute the truth when these do not tell.
#[derive(Clone, Copy, Debug)]
pub struct ExactDepth {
    low: f32,
    high: f32,
    origin: Vec3,
    direction: Vec3,
    corners: [Vec3; 3],
}

impl ExactDepth {
    /// The exact `t` is in [`low`, `high`], and the line of `ray` meets the triangle.
    #[inline(always)]
    pub(super) fn new(ray: &Ray, corners: [Vec3; 3], low: f32, high: f32) -> Self {
        Self { low, high, origin: ray.origin, direction: ray.direction, corners }
    }

    fn line(&self) -> Ray {
        Ray::new(self.origin, self.direction)
    }

    /// Bounds of the exact `t` in `f64`, if it gives any.
    #[inline(always)]
    fn narrower(&self) -> Option<(f64, f64)> {
        match place(&self.line(), self.corners) {
            Sight::Hit { low, high } => Some((low, high)),
            Sight::Miss | Sight::Unclear => None,
        }
    }

    #[cold]
    fn exact(&self) -> exact::ExactT {
        exact::hit(&self.line(), self.corners).expect("a depth is that of a hit")
    }

    /// The order of two whose bounds overlap.
    #[inline(never)]
    fn order_closely(&self, other: &Self) -> Ordering {
        if surely_coplanar(&self.corners, &other.corners) {
            return Ordering::Equal;
        }
        match (self.narrower(), other.narrower()) {
            (Some((_, high)), Some((low, _))) if high < low => Ordering::Less,
            (Some((low, _)), Some((_, high))) if high < low => Ordering::Greater,
            _ => self.exact().cmp(&other.exact()),
        }
    }
}

/// Whether one look tells that two triangles lie in one plane, so that a line meets both at the same `t`: they have the same corners
/// (one triangle in several leaves, or a sheet with two sides), or lie in the same axis-aligned plane.
#[inline(always)]
fn surely_coplanar(a: &[Vec3; 3], b: &[Vec3; 3]) -> bool {
    let first = a[0];
    let level = |axis: usize| a.iter().chain(b).all(|p| p[axis] == first[axis]);
    a.iter().all(|p| b.contains(p)) && b.iter().all(|p| a.contains(p)) || (0..3).any(level)
}

impl Depth for ExactDepth {
    #[inline(always)]
    fn of(_: f32) -> Option<Self> {
        None
    }

    #[inline(always)]
    fn order(&self, other: &Self) -> Ordering {
        if self.high < other.low {
            Ordering::Less
        } else if self.low > other.high {
            Ordering::Greater
        } else {
            // Copies, so that those that are ordered at once need no place in memory.
            let (one, other) = (*self, *other);
            one.order_closely(&other)
        }
    }

    /// Correctly rounded.
    #[inline(always)]
    fn t(&self) -> f32 {
        match self.narrower() {
            // The upper one: of two zeros it is the positive one.
            Some((low, high)) if low as f32 == high as f32 => high as f32,
            _ => self.exact().round(),
        }
    }

    #[inline(always)]
    fn bound(&self) -> f32 {
        self.high
    }
}
