use super::TriangleTest;
use crate::simd::{Arithmetic, LaneVec3};

/// The edge test of [`Plucker`](super::Plucker) in `f64` over corners in `f32`, widened by its own rounding error:
/// scalar triple products for the sides, `t` from the plane equation relative to the origin, rounded to `f32`.
///
/// Proved, where a vector's size is the sum of its components' magnitudes, D the size of d, and det = d . (e1 x e2):
///
/// - The test finds a triangle that the ray hits if |det| >= 2^-48 D |e1| |e2|.
/// - If it reports a hit, the volume of the direction and an edge e from a corner p, which is the barycentric of the
///   third corner times |det|, is not below -2^-47 D |p - o| |e|, and the error of `t` is at most 2^-49 |e1| |e2| (|a -
///   o| + |t| D) / |det|, plus half an ulp of the final rounding.
///
/// As with [`MollerTrumboreF64`](super::MollerTrumboreF64), the errors are small except for needles and slivers. Slower.
///
/// # References
/// See [`Plucker`](super::Plucker).
#[derive(Clone, Copy, Debug, Default)]
pub struct EdgeF64;

/// The lanes whose triangle the line does not certainly miss, and the parameters at their planes.
///
/// The volume of the direction and two corners p, q is computed as d . (p x (q - p)): its error grows with the length
/// of the edge and not with the distance twice.
///
/// **Bounds.** With n = 2^-53, the relative error of a difference is n; a component of a cross product of two
/// differences has an error of 4.1 n (|x||y'| + |y||x'|), a dot product adds 3 n: the error of d . (p x e) is at most
/// 7.1 n 2 |d| |p| |e| in sums of magnitudes, which leave space in 9 for the rounding of the bound. A value computed
/// not below the negative bound of 18 is exactly not below -33 n |d| |p| |e|. The sign of det = d . (e1 x e2) is known
/// if the computed value is beyond 18 n |d| |e1| |e2|, so if the exact one is beyond 26; the error of a . (e1 x e2) is
/// 8.1 n |a| |e1| |e2|, and the error of t less than 14 n |e1| |e2| (|a| + |t| |d|) / |det|.
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

    // The volumes add up to det, whose sign is known: each must have this sign, or an absolute value within rounding.
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
