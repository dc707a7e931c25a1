//! The box of the part of a triangle that lies in a cell: what makes a split "perfect".

use glam::{DVec3, Vec3};

use crate::geometry::Aabb;

/// At most this many corners are left when six planes have cut a triangle.
const CORNERS: usize = 9;

/// A computed corner is off by at most this share of the triangle's largest coordinate: one interpolation a + (b - a) w
/// with w = (s - a) / (b - a) takes five roundings, at most six interpolations follow each other, and 64 units of 2^-53
/// cover them twice. (Where an edge is almost parallel to the plane, w itself may be far off; what is then lost lies within
/// the same distance of the plane, which is 2^20 times less than the slack with which rays cross it.)
const ERROR: f64 = 64.0 / (1u64 << 53) as f64;

/// A box that contains the part of the triangle `corners` in `cell`, inside `cell` and inside `known`, a box of the part in
/// some larger cell.
///
/// Clips in f64 (Sutherland, Hodgman 1974) and rounds outward, so that nothing of the triangle is lost; where rounding
/// leaves no polygon at all, the answer is `known` cut by the cell: a triangle that reaches into the cell is never dropped.
pub(super) fn clipped_bounds(corners: [Vec3; 3], cell: &Aabb, known: &Aabb) -> Aabb {
    let cut = known.intersection(*cell);
    let mut polygon = Polygon::new(corners);
    for axis in 0..3 {
        polygon.keep(axis, cell.min[axis].into(), 1.0);
        polygon.keep(axis, cell.max[axis].into(), -1.0);
    }
    if polygon.len == 0 {
        return cut;
    }
    let tight = polygon.bounds().intersection(cut);
    if tight.is_empty() { cut } else { tight }
}

/// Corners, and for each whether it was computed (and hence rounded) rather than given.
struct Polygon {
    corners: [(DVec3, bool); CORNERS],
    len: usize,
    slack: DVec3,
}

impl Polygon {
    fn new(corners: [Vec3; 3]) -> Self {
        let corners = corners.map(Vec3::as_dvec3);
        let largest = corners.iter().fold(DVec3::ZERO, |m, p| m.max(p.abs()));
        let mut slots = [(DVec3::ZERO, false); CORNERS];
        for (slot, corner) in slots.iter_mut().zip(corners) {
            slot.0 = corner;
        }
        Self { corners: slots, len: 3, slack: largest * ERROR }
    }

    /// Cuts away what lies beyond the plane: keeps points with `side * (p[axis] - plane) >= 0`.
    fn keep(&mut self, axis: usize, plane: f64, side: f64) {
        let inside = |p: DVec3| side * (p[axis] - plane) >= 0.0;
        let before = &self.corners[..self.len];
        if before.iter().all(|&(p, _)| inside(p)) {
            return;
        }

        let mut after = [(DVec3::ZERO, false); CORNERS];
        let mut len = 0;
        for (i, &(p, computed)) in before.iter().enumerate() {
            let (q, _) = before[if i + 1 == self.len { 0 } else { i + 1 }];
            if inside(p) {
                after[len] = (p, computed);
                len += 1;
            }
            if inside(p) != inside(q) {
                // Both directions of an edge give the same point.
                let (a, b) = if inside(p) { (p, q) } else { (q, p) };
                let mut crossing = a + (b - a) * ((plane - a[axis]) / (b[axis] - a[axis]));
                crossing[axis] = plane;
                after[len] = (crossing, true);
                len += 1;
            }
        }
        (self.corners, self.len) = (after, len);
    }

    /// The box of all corners in f32, rounded outward by at least the error of the computed ones.
    fn bounds(&self) -> Aabb {
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &(p, computed) in &self.corners[..self.len] {
            let slack = if computed { self.slack } else { DVec3::ZERO };
            min = min.min(p - slack);
            max = max.max(p + slack);
        }
        Aabb {
            min: Vec3::from_array(min.to_array().map(round_down)),
            max: Vec3::from_array(max.to_array().map(|x| -round_down(-x))),
        }
    }
}

/// The largest `f32` that does not exceed `x`.
fn round_down(x: f64) -> f32 {
    let rounded = x as f32;
    if f64::from(rounded) > x { rounded.next_down() } else { rounded }
}
