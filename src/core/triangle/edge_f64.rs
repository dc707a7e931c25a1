use super::TriangleTest;
use crate::simd::{Arithmetic, LaneVec3};

/// The edge test of [`Plucker`](super::Plucker) in `f64`. The result `t` is rounded to `f32`.
///
/// The test enlarges each triangle by a bound of the rounding error.
///
/// The ray is o + t d. The edges e1 and e2 begin at the first corner a. For a vector v, |v| is the sum of the
/// magnitudes of its components. Let D = |d| and det = d . (e1 x e2). Proven statements:
///
/// - Let |det| >= 2^-48 D |e1| |e2|. If the line of the ray hits the triangle and the computed `t` lies in the
///   ray interval, the test reports a hit.
/// - Let the edge e begin at the corner p. In a reported hit, the barycentric of the corner opposite e is at least
///   -2^-47 D |p - o| |e| / |det|.
/// - The error of `t` is at most 2^-49 |e1| |e2| (|a - o| + |t| D) / |det|, plus half an `f32` ulp.
///
/// # References
/// See [`Plucker`](super::Plucker).
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeF64;

/// Returns a bit mask of the triangles that the line hits, and `t` for all triangles.
///
/// The corners a, p and q are relative to the ray's origin. The edge e = q - p has the volume d . (p x e). The
/// equivalent d . (p x q) has larger rounding errors for distant triangles.
///
/// **Bounds.** Let n = 2^-53. The error of d . (p x e) is at most 7.1 n |d| |p| |e|. For det > 0, the code accepts
/// computed volumes of at least -18 n |d| |p| |e|. The exact volume is then at least -26 n |d| |p| |e|.
///
/// The sign of det = d . (e1 x e2) is certain if the computed |det| exceeds 18 n |d| |e1| |e2|. If the exact |det|
/// exceeds 26 n |d| |e1| |e2|, the computed |det| exceeds 18 n |d| |e1| |e2|. The error of a . (e1 x e2) is at most
/// 8.1 n |a| |e1| |e2|. The error of t is less than 14 n |e1| |e2| (|a| + |t| |d|) / |det|.
#[inline(always)]
fn solve<const N: usize, L: Arithmetic<N, Scalar = f64>>(
    origin: LaneVec3<N, L>,
    direction: LaneVec3<N, L>,
    corners: [LaneVec3<N, L>; 3],
) -> (u32, L) {
    let [first, second, third] = corners;
    let unit = L::splat(2.0 * 9.0 * (f64::EPSILON / 2.0)).mul(direction.abs_sum());
    let a = first - origin;
    let (edge1, edge2) = (second - first, third - first);
    let normal = edge1.cross(edge2);
    let det = direction.dot(normal);
    let mut inside = unit.mul(edge1.abs_sum().mul(edge2.abs_sum())).lt(det.flip_sign(det));

    // Each volume must have the sign of det, or be zero within its rounding error.
    for (from, to) in [(second, third), (third, first), (first, second)] {
        let (p, edge) = (from - origin, to - from);
        let volume = direction.dot(p.cross(edge)).flip_sign(det);
        let error = unit.mul(p.abs_sum().mul(edge.abs_sum()));
        inside &= L::zero().sub(error).le(volume);
    }
    (inside, a.dot(normal).div(det))
}

impl TriangleTest for EdgeF64 {
    const NAME: &'static str = "edge-f64";

    decided_in_f64!(solve);
}
