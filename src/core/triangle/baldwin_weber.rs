use glam::{DVec3, Vec3};

use super::TriangleTest;
use crate::simd::{LaneVec3, Lanes, indexed};

/// The Baldwin-Weber test in `f32`.
///
/// Rays may pass between triangles that share an edge. Rounding errors grow with the distance from the world's origin.
///
/// Unlike in the paper, all twelve numbers of a matrix are stored, because the trivial column differs per lane.
///
/// # References
/// Baldwin, Weber: Fast ray-triangle intersections by coordinate transformation. Journal of Computer Graphics
/// Techniques 5(3), 2016.
#[derive(Clone, Copy, Debug, Default)]
pub struct BaldwinWeber;

/// One matrix per triangle. Each matrix maps a point to two barycentrics and a multiple of the height above the plane.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct ToUnit<const N: usize> {
    rows: [[[f32; N]; 3]; 3],
    translation: [[f32; N]; 3],
}

const _: () = assert!(size_of::<ToUnit<1>>() == 48);

/// If the computed area is zero, all results are zero. Then no ray hits the triangle, because `t` is NaN.
fn to_unit(corners: [Vec3; 3]) -> [(DVec3, f64); 3] {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (edge1, edge2) = (b - a, c - a);
    let normal = edge1.cross(edge2);
    let longest = normal.abs().max_position();
    let det = normal[longest];
    if det == 0.0 {
        return [(DVec3::ZERO, 0.0); 3];
    }
    // The third basis vector is arbitrary.
    let free = DVec3::AXES[longest];
    [edge2.cross(free), free.cross(edge1), normal].map(|row| (row / det, -row.dot(a) / det))
}

impl TriangleTest for BaldwinWeber {
    const NAME: &'static str = "baldwin-weber";

    type Block<const N: usize> = ToUnit<N>;

    decided_on_rays!();

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> ToUnit<N> {
        assert!(triangles.len() <= N, "a block of {N} lanes cannot hold {} triangles", triangles.len());
        let mut block = ToUnit { rows: [[[0.0; N]; 3]; 3], translation: [[0.0; N]; 3] };
        for (lane, &corners) in triangles.iter().enumerate() {
            for (i, (row, translation)) in to_unit(corners).into_iter().enumerate() {
                for axis in 0..3 {
                    block.rows[i][axis][lane] = row[axis] as f32;
                }
                block.translation[i][lane] = translation as f32;
            }
        }
        block
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(
        &(origin, direction): &Self::Ray,
        block: &ToUnit<N>,
        from: f32,
        to: f32,
    ) -> (u32, L) {
        let (origin, direction) = (LaneVec3::splat(origin), LaneVec3::splat(direction));
        let [to_u, to_v, to_height] = indexed(|i| LaneVec3::<N, L>::load(&block.rows[i]));
        let [move_u, move_v, move_height] = indexed(|i| L::load(&block.translation[i]));

        let zero = L::zero();
        let t = zero.sub(to_height.dot(origin).add(move_height)).div(to_height.dot(direction));
        let along = |o: L, d: L| o.add(t.mul(d));
        let point =
            LaneVec3::new(along(origin.x, direction.x), along(origin.y, direction.y), along(origin.z, direction.z));
        let u = to_u.dot(point).add(move_u);
        let v = to_v.dot(point).add(move_v);
        let inside = zero.le(u) & zero.le(v) & u.add(v).le(L::splat(1.0));
        (inside & L::splat(from).le(t) & t.le(L::splat(to)), t)
    }
}
