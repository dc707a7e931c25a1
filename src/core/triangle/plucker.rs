use super::{Corners, TriangleTest};
use crate::simd::{LaneVec3, Lanes, each};

/// Edge test in `f32`: a ray hits if it passes all three edges on the same side. Triple products of the direction and
/// two corners, relative to the ray's origin, decide the sides. `t` comes from the plane of the triangle.
///
/// Guarantees: the two triangles at an edge compute the same number for the edge, with opposite signs, so no ray passes
/// between them; `t` is as accurate as the normal. Not guaranteed: rays through vertices may be lost; products of three
/// lengths leave the range of `f32` at scales of 1e13 and above, and below 1e-12.
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
        // Any of the three volumes may be zero: the triangle is closed.
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
