use glam::Vec3;

use super::{EightHits, EightRays, TriangleTest};
use crate::simd::{EightLanes, LaneVec3, Lanes};

/// The two-sided Möller-Trumbore test in `f32`, with precomputed edges.
///
/// Edges and vertices belong to the triangle. The test has no epsilon. No ray hits a triangle with a NaN coordinate.
///
/// Rays may leak through the edges of closed meshes. The `t` of a grazing ray may have an error of thousands of ulps.
///
/// # References
/// Möller, Trumbore: Fast, minimum storage ray/triangle intersection. Journal of Graphics Tools 2(1), 1997.
#[derive(Clone, Copy, Debug, Default)]
pub struct MollerTrumbore;

/// The first corners of `N` triangles and the edges from these corners, in structure-of-arrays layout.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Edges<const N: usize> {
    corner: [[f32; N]; 3],
    edge1: [[f32; N]; 3],
    edge2: [[f32; N]; 3],
}

const _: () = assert!(size_of::<Edges<1>>() == 36);

struct Solution<L> {
    /// `u` and `v` are barycentric coordinates, multiplied by `abs_det`.
    u: L,
    v: L,
    abs_det: L,
    t: L,
}

/// `to_origin` points from the first corner to the ray's origin.
#[inline(always)]
fn solve<const N: usize, L: Lanes<N>>(
    direction: LaneVec3<N, L>,
    to_origin: LaneVec3<N, L>,
    [edge1, edge2]: [LaneVec3<N, L>; 2],
) -> Solution<L> {
    let p = direction.cross(edge2);
    let q = to_origin.cross(edge1);
    let det = edge1.dot(p);
    Solution {
        u: to_origin.dot(p).flip_sign(det),
        v: direction.dot(q).flip_sign(det),
        abs_det: det.flip_sign(det),
        t: edge2.dot(q).div(det),
    }
}

impl TriangleTest for MollerTrumbore {
    const NAME: &'static str = "moller-trumbore";
    const BATCHED: bool = true;
    const EIGHT: bool = true;

    type Block<const N: usize> = Edges<N>;

    decided_on_rays!();

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> Edges<N> {
        assert!(triangles.len() <= N, "a block of {N} lanes cannot hold {} triangles", triangles.len());
        // No ray hits an unused lane, because the determinant of edges of length zero is zero.
        let mut block = Edges { corner: [[0.0; N]; 3], edge1: [[0.0; N]; 3], edge2: [[0.0; N]; 3] };
        for (lane, &[a, b, c]) in triangles.iter().enumerate() {
            for axis in 0..3 {
                block.corner[axis][lane] = a[axis];
                block.edge1[axis][lane] = b[axis] - a[axis];
                block.edge2[axis][lane] = c[axis] - a[axis];
            }
        }
        block
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(
        &(origin, direction): &Self::Ray,
        block: &Edges<N>,
        from: f32,
        to: f32,
    ) -> (u32, L) {
        let to_origin = LaneVec3::splat(origin) - LaneVec3::load(&block.corner);
        let edges = [LaneVec3::load(&block.edge1), LaneVec3::load(&block.edge2)];
        let Solution { u, v, abs_det, t } = solve::<N, L>(LaneVec3::splat(direction), to_origin, edges);
        let zero = L::zero();
        let inside = zero.le(u) & zero.le(v) & u.add(v).le(abs_det) & zero.lt(abs_det);
        // If an overflow makes `t` NaN, the comparisons are false.
        (inside & L::splat(from).le(t) & t.le(L::splat(to)), t)
    }

    const ONE_STAGE: bool = true;

    #[inline(always)]
    fn meet_eight<const N: usize, L: EightLanes>(
        rays: &EightRays<L>,
        block: &Edges<N>,
        lane: usize,
        to: L,
        _active: L::Mask,
    ) -> Option<EightHits<L>> {
        let to_origin = rays.origin - LaneVec3::splat_lane(&block.corner, lane);
        let edges = [LaneVec3::splat_lane(&block.edge1, lane), LaneVec3::splat_lane(&block.edge2, lane)];
        let Solution { u, v, abs_det, t } = solve(rays.direction, to_origin, edges);
        let zero = L::zero();
        let barycentrics = L::both(zero.cmp_le(u), zero.cmp_le(v));
        let inside = L::both(u.add(v).cmp_le(abs_det), zero.cmp_lt(abs_det));
        // If an overflow makes `t` NaN, the comparisons are false.
        let within = L::both(rays.t_min.cmp_le(t), t.cmp_le(to));
        let met = L::both(L::both(barycentrics, inside), within);
        Some(EightHits { met, missed: L::mask(0), low: t, high: t })
    }
}
