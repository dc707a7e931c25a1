use super::TriangleTest;
use crate::simd::{Arithmetic, LaneVec3};

/// The edge test of [`Plucker`](super::Plucker) in `f64`. It widens triangles by its rounding error. Triple products
/// decide the sides. `t` comes from the plane equation relative to the origin and is rounded to `f32`.
///
/// Proved for a ray o + t d and a triangle with edges e1 and e2 at its first corner a. |v| sums the magnitudes of a
/// vector's components, D = |d|, det = d . (e1 x e2).
///
/// - The test finds a triangle that the ray hits if |det| >= 2^-48 D |e1| |e2|.
/// - If it reports a hit, the barycentric of each corner is at least -2^-47 D |p - o| |e| / |det|, where the opposite
///   edge e starts at p. The error of `t` is at most 2^-49 |e1| |e2| (|a - o| + |t| D) / |det|, plus half an ulp.
///
/// Only needles and slivers have large errors. The test is slower than [`MollerTrumboreF64`](super::MollerTrumboreF64).
///
/// # References
/// See [`Plucker`](super::Plucker).
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeF64;

/// The lanes whose triangle the line hits, as bits, and `t` at the planes of all triangles.
///
/// The volume of the direction d and two corners p and q is computed as d . (p x (q - p)). Its error then grows with
/// the distance times the length of the edge, not with the square of the distance.
///
/// **Bounds.** Let n = 2^-53. A difference has a relative error of n. A component of a cross product of two differences
/// has an error of 4.1 n (|x||y'| + |y||x'|). A dot product adds 3 n. So the error of d . (p x e) is at most 7.1 n 2
/// |d| |p| |e|; the code has 9 instead of 7.1 to cover the rounding of the bound. If a computed value is at least -18 n
/// |d| |p| |e|, the exact value is at least -33 n |d| |p| |e|. The sign of det = d . (e1 x e2) is certain if the
/// computed |det| exceeds 18 n |d| |e1| |e2|. An exact |det| above 26 n |d| |e1| |e2| ensures this. The error of a .
/// (e1 x e2) is 8.1 n |a| |e1| |e2|, and the error of t is less than 14 n |e1| |e2| (|a| + |t| |d|) / |det|.
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

    // The volumes add up to det. Each must have the sign of det, or be zero within its rounding error.
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
