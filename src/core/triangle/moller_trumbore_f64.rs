use super::TriangleTest;
use crate::simd::{Arithmetic, LaneVec3};

/// [`MollerTrumbore`](super::MollerTrumbore) in `f64`. It widens triangles by its rounding error; `t` is an `f32`.
///
/// Let D, E and |s| be sums of the magnitudes of components: D of the direction d, E of both edges e1 and e2 at the
/// first corner, |s| of the vector from this corner to the origin. Let det = e1 . (d x e2). Proved:
///
/// - The test finds a triangle that the ray hits if |det| >= 2^-46 D E E.
/// - If it reports a hit, no barycentric is below -2^-46 D E (|s| + 2 E) / |det|, and the error of `t` is at most 2^-51
///   E E (|s| + |t| D) / |det|, plus half an ulp of the final rounding.
///
/// So the test loses a ray through an edge or a vertex of a closed mesh only at needles that the ray grazes.
///
/// The errors are large only for needles and slivers: |det| is twice the area times the sine of the angle to the plane
/// times the length of the direction. Measured on single triangles: a false hit 4.5e-11 outside a sliver of aspect
/// ratio 10,000; a missed hit on a needle of aspect ratio 10,000,000, which the ray meets along its length; a `t` that
/// is off by 115 ulps on another needle. [`Exact`](super::Exact) has none of these errors.
///
/// Cost: two to three times the cost of the `f32` test in blocks.
///
/// # References
/// See [`MollerTrumbore`](super::MollerTrumbore).
#[derive(Clone, Copy, Debug, Default)]
pub struct MollerTrumboreF64;

/// The lanes whose triangle the line hits, as bits, and `t` at the planes of all triangles.
///
/// **Bounds.** The analysis of the first stage of the exact test (`filter::filter_block`) applies, with n = 2^-53
/// instead of 2^-24. The error of u, v and det - u - v is less than 40 n D E (|s| + 2 E), the error of det less than 43
/// n D E E. D and E bound the components of the direction and of the edges, here as sums instead of maxima. If the
/// computed |det| is at most 80 n D E E, its sign is uncertain and the test reports no hit; an exact |det| of at least
/// 2^7 n D E E excludes this. If a computed value is at least minus the slack, the exact value is at least minus twice
/// the slack, 80 n D E (|s| + 2 E). With sums, the error of h = f . (s x e) is 8.1 n |e| |f| |s| <= 2.1 n E E |s|, and
/// the error of det is 1.8 n D E E, so the error of h / det is less than 4 n E E (|s| + |t| D) / |det|.
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
