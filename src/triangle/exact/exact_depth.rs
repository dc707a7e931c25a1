use std::cmp::Ordering;

use glam::Vec3;

use crate::exact::{self, ExactT};
use crate::geometry::{Ray, round_up};
use crate::triangle::Depth;

/// Where a ray meets a triangle, exactly: bounds in `f64`, and what it takes to compute the truth when these do not tell.
#[derive(Clone, Copy, Debug)]
pub struct ExactDepth {
    low: f64,
    high: f64,
    origin: Vec3,
    direction: Vec3,
    corners: [Vec3; 3],
}

impl ExactDepth {
    /// The exact `t` is in [`low`, `high`], and the line of `ray` meets the triangle.
    #[inline(always)]
    pub(super) fn new(ray: &Ray, corners: [Vec3; 3], low: f64, high: f64) -> Self {
        Self { low, high, origin: ray.origin, direction: ray.direction, corners }
    }

    #[cold]
    fn exact(&self) -> ExactT {
        exact::hit(&Ray::new(self.origin, self.direction), self.corners).expect("a depth is that of a hit")
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
        } else if surely_coplanar(&self.corners, &other.corners) {
            Ordering::Equal
        } else {
            self.exact().cmp(&other.exact())
        }
    }

    /// Correctly rounded.
    #[inline(always)]
    fn t(&self) -> f32 {
        let (low, high) = (self.low as f32, self.high as f32);
        if low == high { low } else { self.exact().round() }
    }

    #[inline(always)]
    fn bound(&self) -> f32 {
        round_up(self.high)
    }
}
