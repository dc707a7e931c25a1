use std::cmp::Ordering;

use glam::Vec3;

use super::bounds_of_hit;
use super::enclosure::{Bounds, pass_plane, place_closely};
use crate::exact;
use crate::geometry::Ray;
use crate::simd::{EightLanes, LaneVec3, indexed};
use crate::triangle::corners::LaneCorners;
use crate::triangle::{BETWEEN_BOUNDS, DIRECTION, Depth, INPUTS, ORIGIN};

/// The triangle of a hit, and bounds of the exact `t`.
#[derive(Clone, Copy, Debug)]
pub struct ExactDepth<'a> {
    low: f32,
    high: f32,
    /// `high - low` if the bounds come from `filter.rs`. Otherwise infinite.
    width: f32,
    triangle: LaneCorners<'a>,
}

impl<'a> ExactDepth<'a> {
    /// If the bounds do not come from `filter.rs`, call `without_filter_bounds` on the result.
    #[inline(always)]
    pub(super) fn new(triangle: LaneCorners<'a>, low: f32, high: f32) -> Self {
        Self { low, high, width: high - low, triangle }
    }

    /// [`pass_plane`] requires an infinite `width` if the bounds do not come from `filter.rs`.
    #[inline(always)]
    pub(super) fn without_filter_bounds(self) -> Self {
        Self { width: f32::INFINITY, ..self }
    }

    #[inline(always)]
    pub(super) fn overlaps<L: EightLanes>(&self, low: L, high: L) -> u32 {
        low.le(L::splat(self.high)) & L::splat(self.low).le(high)
    }

    pub(super) fn latest(&self, ray: &Ray) -> f64 {
        match bounds_of_hit(ray, self.triangle.corners()) {
            Bounds::Hit { high, .. } => high,
            _ => self.high.into(),
        }
    }

    #[cold]
    fn exact(&self, ray: &Ray) -> exact::ExactT {
        exact::hit(ray, self.triangle.corners()).expect("a depth exists only for a hit")
    }

    #[inline(never)]
    pub(super) fn order_closely(&self, other: &ExactDepth, ray: &Ray) -> Ordering {
        let (own, others) = (self.triangle.corners(), other.triangle.corners());
        if surely_coplanar(&own, &others) || meet_at_a_corner(ray, &own, &others) {
            return Ordering::Equal;
        }
        let order = |look: fn(&Ray, [Vec3; 3]) -> Bounds| match (look(ray, own), look(ray, others)) {
            (Bounds::Hit { high, .. }, Bounds::Hit { low, .. }) if high < low => Some(Ordering::Less),
            (Bounds::Hit { low, .. }, Bounds::Hit { high, .. }) if high < low => Some(Ordering::Greater),
            (Bounds::Hit { low, high }, Bounds::Hit { low: 0.0, high: 0.0 }) if low == high && high == 0.0 => {
                Some(Ordering::Equal)
            }
            _ => None,
        };
        let equal = || meet_at_an_edge(ray, &own, &others).then_some(Ordering::Equal);
        order(bounds_of_hit)
            .or_else(equal)
            .or_else(|| order(place_closely))
            .unwrap_or_else(|| self.exact(ray).cmp(&other.exact(ray)))
    }
}

/// Whether two triangles have equal corners or lie in one axis-aligned plane.
///
/// If true, the hits of one ray with the two triangles have equal exact `t`.
#[inline(always)]
fn surely_coplanar(a: &[Vec3; 3], b: &[Vec3; 3]) -> bool {
    let first = a[0];
    let level = |axis: usize| a.iter().chain(b).all(|p| p[axis] == first[axis]);
    a.iter().all(|p| b.contains(p)) && b.iter().all(|p| a.contains(p)) || (0..3).any(level)
}

/// The line of `ray` must meet both triangles.
#[inline(always)]
fn meet_at_a_corner(ray: &Ray, a: &[Vec3; 3], b: &[Vec3; 3]) -> bool {
    a.iter().any(|corner| b.contains(corner) && exact::passes_through(ray, *corner))
}

/// The line of `ray` must meet both triangles.
fn meet_at_an_edge(ray: &Ray, a: &[Vec3; 3], b: &[Vec3; 3]) -> bool {
    let shared = |edge: &[Vec3; 2]| b.contains(&edge[0]) && b.contains(&edge[1]);
    [[a[0], a[1]], [a[1], a[2]], [a[2], a[0]]]
        .into_iter()
        .find(shared)
        .is_some_and(|edge| exact::side(ray, edge).is_eq())
}

impl Depth for ExactDepth<'_> {
    #[inline(always)]
    fn of(_: f32) -> Option<Self> {
        None
    }

    #[inline(always)]
    fn order(&self, other: &Self) -> Option<Ordering> {
        if self.high < other.low {
            Some(Ordering::Less)
        } else if self.low > other.high {
            Some(Ordering::Greater)
        } else {
            None
        }
    }

    /// The exact `t`, correctly rounded.
    #[inline(always)]
    fn t(&self, ray: &Ray) -> f32 {
        let corners = self.triangle.corners();
        rounded(bounds_of_hit(ray, corners)).unwrap_or_else(|| exact_t(ray, corners))
    }

    const LATE: bool = true;

    #[inline(always)]
    fn inputs(&self, ray: &Ray) -> [f32; INPUTS] {
        let ([ax, ay, az, bx, by, bz, cx, cy, cz], o, d) = (self.triangle.coordinates(), ray.origin, ray.direction);
        [ax, ay, az, bx, by, bz, cx, cy, cz, o.x, o.y, o.z, d.x, d.y, d.z, self.width]
    }

    #[inline(always)]
    fn ts<L: EightLanes>(inputs: &[[f32; 8]; INPUTS], which: u32) -> [f32; 8] {
        let vector = |first: usize| LaneVec3::load(&[inputs[first], inputs[first + 1], inputs[first + 2]]);
        let corners = [vector(0), vector(3), vector(6)];
        let width = L::load(&inputs[BETWEEN_BOUNDS]);
        let (low, high) = pass_plane::<8, L>(vector(ORIGIN), vector(DIRECTION), corners, width);
        let (low, high) = (L::narrow(low), L::narrow(high));
        let (undecided, mut ts) = (which & !high.le(low), high.store());
        if undecided != 0 {
            for (lane, t) in ts.iter_mut().enumerate().filter(|(lane, _)| undecided >> lane & 1 == 1) {
                let vector = |first: usize| Vec3::from_array(indexed(|axis| inputs[first + axis][lane]));
                let (ray, corners) = (Ray::new(vector(ORIGIN), vector(DIRECTION)), [vector(0), vector(3), vector(6)]);
                *t = rounded(bounds_of_hit(&ray, corners)).unwrap_or_else(|| exact_t(&ray, corners));
            }
        }
        ts
    }

    #[inline(always)]
    fn bound(&self) -> f32 {
        self.high
    }

    #[inline(always)]
    fn least(&self) -> f32 {
        self.low
    }
}

#[inline(always)]
fn rounded(bounds: Bounds) -> Option<f32> {
    match bounds {
        // If the rounded bounds are -0 and +0, the result is +0.
        Bounds::Hit { low, high } if low as f32 == high as f32 => Some(high as f32),
        _ => None,
    }
}

/// The line of `ray` must meet the triangle.
#[cold]
fn exact_t(ray: &Ray, corners: [Vec3; 3]) -> f32 {
    let exact = || exact::hit(ray, corners).expect("a depth exists only for a hit").round();
    rounded(place_closely(ray, corners)).unwrap_or_else(exact)
}
