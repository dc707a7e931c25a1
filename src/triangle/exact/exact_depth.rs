use std::cmp::Ordering;

use glam::Vec3;

use super::enclosure::{Sight, place};
use super::seen;
use crate::exact;
use crate::geometry::Ray;
use crate::simd::{EightLanes, LaneVec3, each};
use crate::triangle::Depth;

/// Where a ray meets a triangle, exactly: bounds in `f32`, and what it takes to compute the truth when these do not tell. In rows, from
/// which those of eight rays are turned to lanes.
#[derive(Clone, Copy, Debug)]
pub struct ExactDepth {
    /// The bounds, the origin and the direction.
    line: [f32; 8],
    corners: [f32; 9],
}

impl ExactDepth {
    /// The exact `t` is in [`low`, `high`], and the line of `ray` meets the triangle.
    #[inline(always)]
    pub(super) fn new(ray: &Ray, [a, b, c]: [Vec3; 3], low: f32, high: f32) -> Self {
        let (o, d) = (ray.origin, ray.direction);
        Self { line: [low, high, o.x, o.y, o.z, d.x, d.y, d.z], corners: [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z] }
    }

    #[inline(always)]
    fn low(&self) -> f32 {
        self.line[0]
    }

    #[inline(always)]
    fn high(&self) -> f32 {
        self.line[1]
    }

    #[inline(always)]
    fn ray(&self) -> Ray {
        Ray::new(Vec3::from_slice(&self.line[2..5]), Vec3::from_slice(&self.line[5..8]))
    }

    #[inline(always)]
    fn corners(&self) -> [Vec3; 3] {
        [0, 3, 6].map(|first| Vec3::from_slice(&self.corners[first..first + 3]))
    }

    #[cold]
    fn exact(&self) -> exact::ExactT {
        exact::hit(&self.ray(), self.corners()).expect("a depth is that of a hit")
    }

    /// The order of two whose bounds overlap.
    #[inline(never)]
    fn order_closely(&self, other: &Self) -> Ordering {
        if surely_coplanar(&self.corners(), &other.corners()) {
            return Ordering::Equal;
        }
        match (seen(&self.ray(), self.corners()), seen(&other.ray(), other.corners())) {
            (Sight::Hit { high, .. }, Sight::Hit { low, .. }) if high < low => Ordering::Less,
            (Sight::Hit { low, .. }, Sight::Hit { high, .. }) if high < low => Ordering::Greater,
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
        if self.high() < other.low() {
            Ordering::Less
        } else if self.low() > other.high() {
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
        match seen(&self.ray(), self.corners()) {
            // The upper one: of two zeros it is the positive one.
            Sight::Hit { low, high } if low as f32 == high as f32 => high as f32,
            _ => self.exact().round(),
        }
    }

    #[inline(always)]
    fn ts<L: EightLanes>(depths: [&Self; 8]) -> [f32; 8] {
        let [_, _, ox, oy, oz, dx, dy, dz] = L::transpose(each(&depths, |depth| L::load(&depth.line)));
        let first = |depth: &&Self| L::load(depth.corners.first_chunk().expect("nine are eight and one"));
        let [ax, ay, az, bx, by, bz, cx, cy] = L::transpose(each(&depths, first));
        let cz = L::load(&each(&depths, |depth| depth.corners[8]));
        let corners = [LaneVec3::new(ax, ay, az), LaneVec3::new(bx, by, bz), LaneVec3::new(cx, cy, cz)];
        let (placed, low, high) = place(LaneVec3::new(ox, oy, oz), LaneVec3::new(dx, dy, dz), corners);
        let (low, high) = (L::narrow(low), L::narrow(high));
        let (told, mut ts) = (placed & high.le(low), high.store());
        if told != 0xff {
            for (i, t) in ts.iter_mut().enumerate().filter(|(i, _)| told >> i & 1 == 0) {
                *t = depths[i].exact().round();
            }
        }
        ts
    }

    #[inline(always)]
    fn bound(&self) -> f32 {
        self.high()
    }
}
