use super::TriangleTest;
use crate::simd::{Arithmetic, LaneVec3};

/// The Möller-Trumbore test in `f64`. The test enlarges each triangle by a bound of the rounding errors. The `t` of a
/// hit is rounded to `f32`.
///
/// The size of a vector is the sum of the magnitudes of the components. D is the size of the direction d. The edges e1
/// and e2 begin at the first corner. E is the sum of the sizes of e1 and e2. |s| is the size of the vector s from the
/// first corner to the origin. Let det = e1 . (d x e2). Proven properties:
///
/// - If the line meets the triangle and |det| >= 2^-46 D E E, the test finds the intersection. The computed `t` decides
///   whether the intersection lies in the ray's interval.
/// - No barycentric coordinate of a reported hit is below -2^-46 D E (|s| + 2 E) / |det|.
/// - The error of `t` is at most 2^-51 E E (|s| + |t| D) / |det|, plus half an ulp for the rounding to `f32`.
///
/// # References
/// See [`MollerTrumbore`](super::MollerTrumbore).
#[derive(Clone, Copy, Debug, Default)]
pub struct MollerTrumboreF64;

/// The bits of the first result mark the lanes where the line hits the triangle. The second result is `t`.
///
/// **Bounds.** The documentation of `filter::filter_block` contains the analysis. Here, n = 2^-53 replaces w = 2^-24.
/// The documentation of [`MollerTrumboreF64`] defines D, E and |s|. The slack k = 40 n D E (|s| + 2 E) exceeds the
/// errors of u, v and det - u - v. If a computed value is at least -k, the exact value is at least -2 k.
///
/// The error of det is less than 43 n D E E. If the computed |det| exceeds 80 n D E E, the sign of det is certain.
/// Otherwise the test reports no hit. If the exact |det| is at least 2^7 n D E E, the computed |det| exceeds
/// 80 n D E E.
///
/// Let |e1| and |e2| be the sizes of e1 and e2. Their product is at most E E / 4. The error of h = e2 . (s x e1) is at
/// most 8.1 n |e1| |e2| |s|, less than 2.1 n E E |s|. A tighter bound of the error of det is 7.1 n D |e1| |e2|, less
/// than 1.8 n D E E. Hence the error of t = h / det is less than 4 n E E (|s| + |t| D) / |det|.
#[inline(always)]
fn solve<const N: usize, L: Arithmetic<N, Scalar = f64>>(
    origin: LaneVec3<N, L>,
    direction: LaneVec3<N, L>,
    [a, b, c]: [LaneVec3<N, L>; 3],
) -> (u32, L) {
    let (to_origin, edge1, edge2) = (origin - a, b - a, c - a);
    let p = direction.cross(edge2);
    let q = to_origin.cross(edge1);
    let det = edge1.dot(p);
    let abs_det = det.flip_sign(det);
    let u = to_origin.dot(p).flip_sign(det);
    let v = direction.dot(q).flip_sign(det);

    let extent = edge1.abs_sum().add(edge2.abs_sum());
    let unit = L::splat(40.0 * (f64::EPSILON / 2.0)).mul(direction.abs_sum()).mul(extent);
    let slack = unit.mul(to_origin.abs_sum().add(extent).add(extent));
    let below = L::zero().sub(slack);
    let inside = below.le(u) & below.le(v) & u.add(v).le(abs_det.add(slack));
    let sure = unit.mul(extent.add(extent)).lt(abs_det);
    (inside & sure, edge2.dot(q).div(det))
}

impl TriangleTest for MollerTrumboreF64 {
    const NAME: &'static str = "moller-trumbore-f64";

    decided_in_f64!(solve);
}
