//! Clips triangles to cells and boxes, for "perfect" splits (Wald, Havran 2006).

use glam::{DVec3, Vec3};

use crate::geometry::{Aabb, round_down, round_up};

/// Maximum number of corners after six planes have cut a triangle.
const CORNERS: usize = 9;

/// Bound on the error of a computed corner coordinate, as a multiple of M. M is the largest absolute coordinate of the
/// triangle on the axis. The interpolation in `kept` has six rounded operations. Each of the first five operations adds
/// an error of at most 2 units of 2^-53 M. The final addition adds at most 1 unit. One interpolation therefore adds at
/// most 11 units. At most seven planes clip a triangle. The total error is therefore at most 77 units.
///
/// Clipping moves each plane outward by this bound. A point of the triangle in the cell therefore stays in the polygon,
/// up to the error of the corners. This holds even for an edge of computed corners that is almost parallel to a plane.
const ERROR: f64 = 128.0 / (1u64 << 53) as f64;

/// A box around the triangle's part in `cell`, rounded outward. `known` is a box around the triangle's part in a larger
/// cell. The result lies in `cell` and in `known`.
///
/// Clips in f64 (Sutherland, Hodgman 1974). If the clipped box is empty, the result is the intersection of `known` and
/// `cell`. So rounding errors never drop a triangle that reaches into the cell.
pub(crate) fn clipped_bounds(corners: [Vec3; 3], cell: &Aabb, known: &Aabb) -> Aabb {
    Polygon::clipped(corners, cell).corner_box().in_cut(known.intersection(*cell))
}

/// Like [`clipped_bounds`], for the parts of `bounds` below and above a plane. `bounds` is a box around the triangle's
/// part in some cell. The plane must cut the interior of `bounds`.
pub(crate) fn cut_bounds(corners: [Vec3; 3], bounds: &Aabb, axis: usize, plane: f32) -> (Aabb, Aabb) {
    let polygon = Polygon::clipped(corners, bounds);
    let (below, above) = bounds.cut(axis, plane);
    let half = |cut: Aabb, side: f64| {
        let mut corner_box = CornerBox::EMPTY;
        polygon.kept(axis, plane.into(), side, |p, computed| corner_box.grow(p, polygon.slack_of(computed)));
        corner_box.in_cut(cut)
    };
    (half(below, -1.0), half(above, 1.0))
}

/// A convex polygon. The flag of a corner is `true` for a computed corner.
struct Polygon {
    corners: [(DVec3, bool); CORNERS],
    len: usize,
    slack: DVec3,
}

impl Polygon {
    fn clipped(corners: [Vec3; 3], cell: &Aabb) -> Self {
        let corners = corners.map(Vec3::as_dvec3);
        let largest = corners.iter().fold(DVec3::ZERO, |m, p| m.max(p.abs()));
        let mut slots = [(DVec3::ZERO, false); CORNERS];
        for (slot, corner) in slots.iter_mut().zip(corners) {
            slot.0 = corner;
        }
        let mut polygon = Self { corners: slots, len: 3, slack: largest * ERROR };
        for axis in 0..3 {
            polygon.keep(axis, cell.min[axis].into(), 1.0);
            polygon.keep(axis, cell.max[axis].into(), -1.0);
        }
        polygon
    }

    fn corners(&self) -> impl Iterator<Item = (DVec3, bool)> + '_ {
        self.corners[..self.len].iter().copied()
    }

    /// The maximum error of a corner on each axis.
    fn slack_of(&self, computed: bool) -> DVec3 {
        if computed { self.slack } else { DVec3::ZERO }
    }

    fn corner_box(&self) -> CornerBox {
        let mut corner_box = CornerBox::EMPTY;
        self.corners().for_each(|(p, computed)| corner_box.grow(p, self.slack_of(computed)));
        corner_box
    }

    /// Keeps the part above (`side` 1.0) or below (`side` -1.0) the plane, with a margin of `slack`.
    fn keep(&mut self, axis: usize, plane: f64, side: f64) {
        let bound = plane - side * self.slack[axis];
        if self.corners().all(|(p, _)| side * (p[axis] - bound) >= 0.0) {
            return;
        }
        let mut after = [(DVec3::ZERO, false); CORNERS];
        let mut len = 0;
        self.kept(axis, plane, side, |p, computed| {
            after[len] = (p, computed);
            len += 1;
        });
        (self.corners, self.len) = (after, len);
    }

    /// Visits the corners of the part with `side * (p[axis] - plane) >= -slack[axis]`.
    #[inline(always)]
    fn kept(&self, axis: usize, plane: f64, side: f64, mut visit: impl FnMut(DVec3, bool)) {
        let plane = plane - side * self.slack[axis];
        let inside = |p: DVec3| side * (p[axis] - plane) >= 0.0;
        for (i, (p, computed)) in self.corners().enumerate() {
            let (q, _) = self.corners[if i + 1 == self.len { 0 } else { i + 1 }];
            if inside(p) {
                visit(p, computed);
            }
            if inside(p) != inside(q) {
                // Interpolate from the inside corner. Both directions of an edge then give the same point.
                let (a, b) = if inside(p) { (p, q) } else { (q, p) };
                let mut crossing = a + (b - a) * ((plane - a[axis]) / (b[axis] - a[axis]));
                crossing[axis] = plane;
                visit(crossing, true);
            }
        }
    }
}

struct CornerBox {
    min: DVec3,
    max: DVec3,
}

impl CornerBox {
    const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    #[inline(always)]
    fn grow(&mut self, p: DVec3, slack: DVec3) {
        self.min = self.min.min(p - slack);
        self.max = self.max.max(p + slack);
    }

    fn in_cut(&self, cut: Aabb) -> Aabb {
        let tight = Aabb {
            min: Vec3::from_array(self.min.to_array().map(round_down)),
            max: Vec3::from_array(self.max.to_array().map(round_up)),
        };
        let tight = tight.intersection(cut);
        if tight.is_empty() { cut } else { tight }
    }
}

#[cfg(test)]
mod tests {
    use rand_core::{RngCore, SeedableRng};

    use super::*;
    use crate::build::check::{holds, point_in, unit};
    use crate::exact;
    use crate::geometry::Ray;

    fn point(rng: &mut rand_pcg::Pcg32) -> Vec3 {
        unit(rng) * 2.0
    }

    #[test]
    fn clipped_boxes_contain_their_parts_and_cut_boxes_match_their_polygons() {
        let mut rng = rand_pcg::Pcg32::seed_from_u64(11);
        let (mut seen, mut cuts) = (0, 0);
        for _ in 0..20_000 {
            let corners: [Vec3; 3] = std::array::from_fn(|_| point(&mut rng));
            let (a, b, plane) = (point(&mut rng), point(&mut rng), point(&mut rng).x);
            let cell = Aabb { min: a.min(b), max: a.max(b) };
            let known = Aabb::of_points(corners);
            let clipped = clipped_bounds(corners, &cell, &known);
            if known.intersection(cell).is_empty() {
                continue;
            }
            assert!(cell.contains(&clipped) && known.contains(&clipped));

            for _ in 0..20 {
                let x = point_in(&mut rng, corners);
                if holds(&cell, x) {
                    assert!(holds(&clipped, x), "{x} of {corners:?} in {cell:?} is outside {clipped:?}");
                    seen += 1;
                }
            }

            let axis = (rng.next_u32() % 3) as usize;
            if clipped.min[axis] < plane && plane < clipped.max[axis] {
                let (below, above) = clipped.cut(axis, plane);
                let side = |cut: Aabb, side: f64| {
                    let mut polygon = Polygon::clipped(corners, &clipped);
                    polygon.keep(axis, plane.into(), side);
                    polygon.corner_box().in_cut(cut)
                };
                assert_eq!(cut_bounds(corners, &clipped, axis, plane), (side(below, -1.0), side(above, 1.0)));
                cuts += 1;
            }
        }
        assert!(seen > 5_000 && cuts > 1_000, "too few points and cuts for a meaningful test: {seen} {cuts}");
    }

    #[test]
    fn a_corner_cut_off_shrinks_the_box_and_a_corner_in_a_face_is_kept() {
        let clipped = |corners: [Vec3; 3], min: Vec3, max: Vec3| {
            clipped_bounds(corners, &Aabb { min, max }, &Aabb::of_points(corners))
        };
        let corners = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0)];
        let Aabb { min, max } = clipped(corners, Vec3::new(3.0, 0.0, -1.0), Vec3::new(5.0, 5.0, 1.0));
        assert_eq!((min, max.x), (Vec3::new(3.0, 0.0, 0.0), 4.0));
        assert!((1.0..1.0 + 2.0 * f32::EPSILON).contains(&max.y), "{max}");

        let corners = [Vec3::ZERO, Vec3::new(-1.0, 1.0, 0.0), Vec3::new(-1.0, -1.0, 0.0)];
        let touched = clipped(corners, Vec3::new(0.0, -1.0, -1.0), Vec3::ONE);
        assert!(touched.contains(&Aabb::of_points([Vec3::ZERO])), "{touched:?}");
    }

    /// Planes close to 0 cut triangles with large coordinates. The error of a corner may exceed the distance of a
    /// plane from 0.
    #[test]
    fn clipping_keeps_every_point_of_edges_near_planes() {
        use std::cmp::Ordering::{Equal, Greater, Less};
        const SMALL: f32 = 1e-12;
        let mut rng = rand_pcg::Pcg32::seed_from_u64(12);
        let mut cuts = 0;
        for _ in 0..100_000 {
            let middle = point(&mut rng) * SMALL;
            let mut reach: [Vec3; 2] = std::array::from_fn(|_| point(&mut rng) * 1e4);
            let [a, b, flat] = std::array::from_fn(|_| (rng.next_u32() % 3) as usize);
            for e in &mut reach {
                e[flat] *= [1.0, 1e-4, SMALL * 1e-4][(rng.next_u32() % 3) as usize];
                e[a] = e[b];
            }
            let corners = [middle - reach[0], middle + reach[0] - reach[1] * 0.5, middle + reach[1]];

            // The ray is parallel to an axis, so only one coordinate of the hit depends on `t`.
            let along = (rng.next_u32() % 3) as usize;
            let (mut origin, mut direction) = (point(&mut rng) * SMALL, Vec3::ZERO);
            (origin[along], direction[along]) = (0.0, 1.0);
            let Some(t) = exact::hit(&Ray::new(origin, direction), corners) else { continue };
            let order = |axis: usize, x: f32| {
                if axis == along { t.compare(x) } else { origin[axis].partial_cmp(&x) }.expect("no number is NaN")
            };
            let inside = |b: &Aabb| (0..3).all(|i| order(i, b.min[i]) != Less && order(i, b.max[i]) != Greater);

            let mut bounds = Aabb::of_points(corners);
            for _ in 0..8 {
                let axis = (rng.next_u32() % 3) as usize;
                let here = if axis == along { t.round() } else { origin[axis] };
                let plane = here + point(&mut rng).x * SMALL;
                if bounds.min[axis] < plane && plane < bounds.max[axis] && order(axis, plane) != Equal {
                    let (below, above) = cut_bounds(corners, &bounds, axis, plane);
                    bounds = if order(axis, plane) == Less { below } else { above };
                    assert!(inside(&bounds), "{corners:?} at {origin} + {t:?} {direction}: {bounds:?}");
                    cuts += 1;
                }
            }
        }
        assert!(cuts > 20_000, "too few cuts for a meaningful test: {cuts}");
    }
}
