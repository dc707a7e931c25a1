use super::{Corners, TriangleTest};
use crate::simd::{LaneVec3, Lanes, each};

/// Edge test in `f32`. A ray hits a triangle if the ray passes all three edges on the same side.
///
/// Two triangles compute the same number for a common edge, with opposite signs. So no ray passes between the
/// triangles. A ray through a vertex may miss all triangles at the vertex.
///
/// In scenes of size 1e13 and above, products of three lengths may overflow. In scenes of size below 1e-12, products of
/// three lengths may underflow.
///
/// # References
/// Shoemake: Plücker coordinate tutorial. Ray Tracing News 11(1), 1998. Segura, Feito: Algorithms to test ray-triangle
/// intersection. Comparative study. WSCG 2001.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plucker;

impl TriangleTest for Plucker {
    const NAME: &'static str = "plucker";

    decided_on_corners!();

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(
        &(origin, direction): &Self::Ray,
        block: &Corners<N>,
        from: f32,
        to: f32,
    ) -> (u32, L) {
        let (origin, direction) = (LaneVec3::splat(origin), LaneVec3::splat(direction));
        let corners = block.load::<L>();
        let [a, b, c] = each(&corners, |&corner| corner - origin);
        let volumes = each(&[c.cross(b), a.cross(c), b.cross(a)], |&side| direction.dot(side));
        // Edges belong to the triangle, so the comparisons accept zero.
        let zero = L::zero();
        let above = volumes.iter().fold(u32::MAX, |lanes, v| lanes & zero.le(*v));
        let below = volumes.iter().fold(u32::MAX, |lanes, v| lanes & v.le(zero));

        let [first, second, third] = corners;
        let normal = (second - first).cross(third - first);
        let det = direction.dot(normal);
        let abs_det = det.flip_sign(det);
        let t = a.dot(normal).div(det);
        ((above | below) & zero.lt(abs_det) & L::splat(from).le(t) & t.le(L::splat(to)), t)
    }
}
