//! Splits polygons into triangles.

use earcut::Earcut;
use glam::{DVec3, Vec3};
use robust::{Coord, orient2d};

/// Maximum of `Splitter::pairs`, a sum over all polygons of a file. It bounds the time of ear clipping, which is
/// quadratic for a polygon that crosses itself. A concave polygon beyond the limit becomes a fan. Polygons of at most
/// [`SMALL`] corners add nothing to the sum.
const MOST_PAIRS: usize = 1 << 27;
const SMALL: usize = 64;

/// Largest distance between a corner and the plane of a flat polygon, relative to the polygon's extent.
const BENT: f64 = 0.01;

type Point = [f64; 2];

/// Convex polygons become fans, concave quads are split along the diagonal inside, and ear clipping splits all other
/// polygons. It gives fewer than n - 2 triangles if corners repeat or lie on a line. All decisions are made
/// in a projection along the axis of the largest component of the normal, seen counterclockwise.
///
/// # References
/// G. H. Meisters, "Polygons have ears", 1975. J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast
/// robust geometric predicates", 1997.
#[derive(Default)]
pub(super) struct Splitter {
    earcut: Earcut<f64>,
    triangles: Vec<usize>,
    crossing: usize,
    bent: usize,
    large: usize,
    pairs: usize,
}

impl Splitter {
    /// Returns triangles as indices into `corners`.
    pub fn split(&mut self, corners: &[Vec3]) -> &[[usize; 3]] {
        if corners.len() < 4 || !self.split_other(corners) {
            self.triangles.clear();
            self.triangles.extend((2..corners.len()).flat_map(|i| [0, i - 1, i]));
        }
        self.triangles.as_chunks().0
    }

    pub fn defects(&self) -> [(usize, &'static str); 3] {
        let large = "not convex and too large to search for crossing edges: split into fans, which may overlap";
        [
            (self.crossing, "with crossing edges: split into fans around the first corner, perhaps not as intended"),
            (self.bent, "neither convex nor flat: the surface is ambiguous"),
            (self.large, large),
        ]
    }

    /// Returns false if the polygon must become a fan.
    fn split_other(&mut self, corners: &[Vec3]) -> bool {
        let normal = newell(corners);
        let Some(axis) =
            (0..3).filter(|&i| normal[i] != 0.0).max_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs()))
        else {
            // A polygon without area is a line, or the areas of its loops cancel.
            self.crossing += usize::from((0..3).any(|axis| !is_line(&project(corners, axis, false))));
            return false;
        };
        let points = project(corners, axis, normal[axis] < 0.0);
        if is_convex(&points) {
            return false;
        }
        let pairs = self.pairs.saturating_add(corners.len().saturating_mul(corners.len().saturating_sub(SMALL)));
        if pairs > MOST_PAIRS {
            self.large += 1;
            return false;
        }
        self.pairs = pairs;
        let is_split = if let [a, b, c, d] = points[..] {
            split_quad([a, b, c, d], &mut self.triangles)
        } else {
            self.earcut.earcut_slice(&points, &[], &mut self.triangles);
            is_covered(&points, self.triangles.as_chunks().0)
        };
        let count = if is_split { &mut self.bent } else { &mut self.crossing };
        *count += usize::from(!is_split || is_bent(corners, normal));
        is_split
    }
}

/// Twice the vector area of a polygon, as in Newell's method.
fn newell(corners: &[Vec3]) -> DVec3 {
    let first = corners[0].as_dvec3();
    let from_first = |i: usize| corners[i].as_dvec3() - first;
    (2..corners.len()).map(|i| from_first(i - 1).cross(from_first(i))).sum()
}

fn project(corners: &[Vec3], axis: usize, against: bool) -> Vec<Point> {
    let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
    let (right, up) = if against { (up, right) } else { (right, up) };
    corners.iter().map(|p| [p[right].into(), p[up].into()]).collect()
}

/// Twice the area of a triangle, positive if the triangle is counterclockwise. The sign is exact.
fn area(corners: [Point; 3]) -> f64 {
    let [a, b, c] = corners.map(|[x, y]| Coord { x, y });
    orient2d(a, b, c)
}

fn is_line(points: &[Point]) -> bool {
    let Some(&other) = points.iter().find(|p| **p != points[0]) else { return true };
    points.iter().all(|&p| area([points[0], other, p]) == 0.0)
}

/// The polygon must be counterclockwise. A convex polygon has no right turn. The left turns of a convex polygon add up
/// to 360 degrees. Hence exactly one turn leads from a downward edge to an upward edge.
fn is_convex(points: &[Point]) -> bool {
    let n = points.len();
    let upward = |a: Point, b: Point| b[1] > a[1] || b[1] == a[1] && b[0] > a[0];
    let mut turns_upward = 0;
    for i in 0..n {
        let (a, b, c) = (points[i], points[(i + 1) % n], points[(i + 2) % n]);
        let turn = area([a, b, c]);
        let back = turn == 0.0 && upward(a, b) != upward(b, c);
        if turn < 0.0 || back || a == b {
            return false;
        }
        turns_upward += usize::from(!upward(a, b) && upward(b, c));
    }
    turns_upward == 1
}

/// The quad must be counterclockwise and not convex. Returns whether a diagonal lies inside the quad.
fn split_quad(points: [Point; 4], triangles: &mut Vec<usize>) -> bool {
    let around = |i: usize| [(i + 3) % 4, i, (i + 1) % 4];
    let turns = [0, 1, 2, 3].map(|i| area(around(i).map(|corner| points[corner])));
    let Some(ear) = (0..4).find(|&i| turns[i] > 0.0 && turns[(i + 2) % 4] >= 0.0) else { return false };
    triangles.clear();
    triangles.extend(around(ear));
    triangles.extend((0..4).filter(|&i| i != ear));
    true
}

fn is_covered(points: &[Point], triangles: &[[usize; 3]]) -> bool {
    let fan = (2..points.len()).map(|i| area([points[0], points[i - 1], points[i]]));
    let (own, sizes) = fan.fold((0.0, 0.0), |(own, sizes), area| (own + area, sizes + area.abs()));
    let covered: f64 = triangles.iter().map(|triangle| area(triangle.map(|i| points[i])).abs()).sum();
    // The right-hand side bounds the rounding errors of `covered` and `own`.
    (covered - own).abs() <= 2.0 * f64::EPSILON * points.len() as f64 * sizes
}

fn is_bent(corners: &[Vec3], normal: DVec3) -> bool {
    let (first, normal) = (corners[0].as_dvec3(), normal.normalize());
    let extent = corners.iter().map(|p| (p.as_dvec3() - first).length()).fold(0.0, f64::max);
    corners.iter().any(|p| (p.as_dvec3() - first).dot(normal).abs() > BENT * extent)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[[f32; 2]]) -> Vec<Vec3> {
        points.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect()
    }

    const ARROW: [[f32; 2]; 4] = [[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]];

    fn polar(corners: impl Iterator<Item = (f32, f32)>) -> Vec<Vec3> {
        polygon(&corners.map(|(angle, r)| [r * angle.cos(), r * angle.sin()]).collect::<Vec<_>>())
    }

    fn defects(splitter: &Splitter) -> Vec<&'static str> {
        splitter.defects().into_iter().filter(|(count, _)| *count > 0).map(|(_, defect)| defect).collect()
    }

    fn area(corners: [Vec3; 3]) -> f64 {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        (b - a).cross(c - a).z / 2.0
    }

    fn assert_covered(corners: &[Vec3]) {
        let mut splitter = Splitter::default();
        let triangles = splitter.split(corners).to_vec();
        assert!(triangles.len() <= corners.len() - 2, "{triangles:?}");
        let own = newell(corners).z / 2.0;
        let areas = triangles.iter().map(|t| area(t.map(|i| corners[i])) * own.signum());
        assert!(areas.clone().all(|area| area >= 0.0), "{triangles:?}");
        assert!((areas.sum::<f64>() - own.abs()).abs() < 1e-6, "{triangles:?}");
        assert!(defects(&splitter).is_empty(), "{:?}", defects(&splitter));
    }

    #[test]
    fn concave_polygons_are_covered_once_from_every_first_corner() {
        let comb: Vec<[f32; 2]> = (0..20).map(|i| [i as f32, if i % 2 == 0 { 1.0 } else { 5.0 }]).collect();
        let comb = polygon(&[&comb[..], &[[19.0, 0.0], [0.0, 0.0]]].concat());
        let arm = |r: f32| (0..30).map(move |i| (i as f32 * 0.5, r + i as f32 * 0.2));
        let spiral = polar(arm(1.0).chain(arm(1.5).rev()));
        let outline = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let hole = polygon(&[outline, [[1.0, 1.0], [1.0, 3.0], [3.0, 3.0], [3.0, 1.0], [1.0, 1.0]]].concat());
        let twice = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]]);
        for mut corners in [polygon(&ARROW), comb, spiral, hole, twice] {
            for _ in 0..corners.len() {
                assert_covered(&corners);
                corners.rotate_left(1);
            }
            corners.reverse();
            assert_covered(&corners);
        }
    }

    #[test]
    fn stars_of_any_shape_are_covered() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        for n in (4..120).flat_map(|n| [n; 5]) {
            let corner = |i: usize| (i as f32 / n as f32 * std::f32::consts::TAU, 0.1 + random());
            assert_covered(&polar((0..n).map(corner)));
        }
    }

    #[test]
    fn a_concave_quad_is_split_along_the_diagonal_inside() {
        let mut arrow = polygon(&ARROW);
        for is_fan in [true, false, true, false] {
            let expected = if is_fan { [[0, 1, 2], [0, 2, 3]] } else { [[3, 0, 1], [1, 2, 3]] };
            assert_eq!(Splitter::default().split(&arrow), expected);
            arrow.rotate_left(1);
        }
        // Two corners of this bent quad coincide in the projection.
        let bent = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::new(1.0, 1.0, 0.1)];
        assert_eq!(Splitter::default().split(&bent), [[3, 0, 1], [1, 2, 3]]);
    }

    #[test]
    fn convex_polygons_stay_fans() {
        let mut splitter = Splitter::default();
        let octagon: Vec<_> = [[3, 0], [5, 0], [8, 3], [8, 5], [5, 8], [3, 8], [0, 5], [0, 3]]
            .map(|[x, y]| Vec3::new(x as f32, 7.0, y as f32))
            .into();
        assert_eq!(splitter.split(&octagon), [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 6], [0, 6, 7]]);
        let straight = polygon(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0]]);
        assert_eq!(splitter.split(&straight), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(splitter.split(&octagon[..3]), [[0, 1, 2]]);
        assert!(splitter.split(&octagon[..2]).is_empty());
        let bent = [Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::Y];
        assert_eq!(splitter.split(&bent), [[0, 1, 2], [0, 2, 3]]);
        assert!(defects(&splitter).is_empty());
    }

    #[test]
    fn polygons_that_are_not_simple_are_reported() {
        let noted = |corners: &[Vec3]| {
            let mut splitter = Splitter::default();
            assert_eq!(splitter.split(corners).len(), corners.len() - 2);
            defects(&splitter).concat()
        };
        let bow = polygon(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]);
        let star = polygon(&[[0.0, 3.0], [2.0, -3.0], [-3.0, 1.0], [3.0, 1.0], [-2.0, -3.0]]);
        assert!(noted(&bow).starts_with("with crossing edges") && noted(&star).starts_with("with crossing edges"));
        assert_eq!(noted(&polygon(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0], [2.0, 2.0]])), "", "a line has no surface");
        let mut arrow = polygon(&ARROW);
        arrow[2].z = 0.5;
        assert!(noted(&arrow).contains("neither convex nor flat"));
        let saw = |teeth: usize| {
            let middle = [teeth as f32 / 2.0, -9.0];
            polygon(&(0..teeth).map(|i| [i as f32, (i % 2) as f32]).chain([middle]).collect::<Vec<_>>())
        };
        assert!(noted(&saw(12_000)).contains("too large"));
        let mut splitter = Splitter { pairs: MOST_PAIRS - 1000 * (1000 - SMALL), ..Splitter::default() };
        for (teeth, large) in [(999, 0), (99, 1), (63, 1)] {
            splitter.split(&saw(teeth));
            assert_eq!(splitter.large, large, "{teeth}");
        }
    }

    #[test]
    fn exact_signs_decide_where_rounding_fails() {
        // The last corner lies one ulp beside the line through its neighbours.
        let [a, b, c] = [[0.1, 0.1], [0.7, -1.0], [0.7, 0.7]];
        for (d, is_fan) in [([0.3, 0.3_f32.next_down()], false), ([0.3, 0.3_f32.next_up()], true)] {
            let corners = polygon(&[a, b, c, d]);
            assert_covered(&corners);
            assert_eq!(Splitter::default().split(&corners) == [[0, 1, 2], [0, 2, 3]], is_fan);
        }
    }
}
