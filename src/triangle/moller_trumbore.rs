use glam::Vec3;

use super::TriangleTest;
use crate::geometry::Ray;
use crate::simd::{LaneVec3, Lanes};

/// Möller-Trumbore in `f32`: no precomputation, two-sided, division only for `t`.
///
/// Promises: every comparison is closed, there is no epsilon, NaN never hits. Does not promise: closed meshes may leak at
/// edges, because both neighbours round their barycentrics on their own; `t` of a grazing ray may be off by thousands of ulps.
/// Costs one division for each block: per triangle 2.4 ns scalar and 1.0 ns in blocks of eight, on the machine of the README's
/// table (`cargo bench --bench kernels`).
///
/// # References
/// Möller, Trumbore: Fast, minimum storage ray/triangle intersection. Journal of Graphics Tools 2(1), 1997.
#[derive(Clone, Copy, Debug, Default)]
pub struct MollerTrumbore;

/// One corner and the two edges that leave it, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Edges<const N: usize> {
    corner: [[f32; N]; 3],
    edge1: [[f32; N]; 3],
    edge2: [[f32; N]; 3],
}

const _: () = assert!(size_of::<Edges<1>>() == 36);

impl TriangleTest for MollerTrumbore {
    const NAME: &'static str = "moller-trumbore";

    type Ray = (Vec3, Vec3);
    type Block<const N: usize> = Edges<N>;

    #[inline(always)]
    fn prepare(ray: &Ray) -> Self::Ray {
        (ray.origin, ray.direction)
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> Edges<N> {
        assert!(triangles.len() <= N, "a block of {N} lanes cannot hold {} triangles", triangles.len());
        // Edges of length zero give a determinant of zero, which hits nothing.
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
    fn hits<const N: usize, L: Lanes<N>>(&(origin, direction): &Self::Ray, block: &Edges<N>) -> (u32, L) {
        let direction = LaneVec3::splat(direction);
        let edge1 = LaneVec3::<N, L>::load(&block.edge1);
        let edge2 = LaneVec3::load(&block.edge2);
        let to_origin = LaneVec3::splat(origin) - LaneVec3::load(&block.corner);

        // Solve by Cramer's rule; all numerators share the sign of the determinant when the barycentrics are positive.
        let p = direction.cross(edge2);
        let q = to_origin.cross(edge1);
        let det = edge1.dot(p);
        let abs_det = det.flip_sign(det);
        let u = to_origin.dot(p).flip_sign(det);
        let v = direction.dot(q).flip_sign(det);

        let zero = L::splat(0.0);
        let inside = zero.le(u) & zero.le(v) & u.add(v).le(abs_det) & zero.lt(abs_det);
        let t = edge2.dot(q).div(det);
        // An overflow may have made t NaN: such a lane hits nothing.
        (inside & t.le(t), t)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use rand_core::{RngCore, SeedableRng};

    use super::*;
    use crate::simd::{F32x4, F32x8, Portable};

    fn unit(rng: &mut rand_pcg::Pcg32) -> Vec3 {
        Vec3::from_array(std::array::from_fn(|_| rng.next_u32() as f32 / u32::MAX as f32 * 2.0 - 1.0))
    }

    /// Corners and rays on a coarse grid, so that hits on edges and corners, -0.0 and parallel rays are frequent.
    fn grid(rng: &mut rand_pcg::Pcg32) -> Vec3 {
        Vec3::from_array(std::array::from_fn(|_| (rng.next_u32() % 5) as f32 - 2.0))
    }

    /// The textbook formula in f64: the naive twin.
    fn naive(ray: &Ray, corners: [Vec3; 3]) -> Option<f64> {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let (o, d): (DVec3, DVec3) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let (e1, e2) = (b - a, c - a);
        let det = e1.dot(d.cross(e2));
        let u = (o - a).dot(d.cross(e2)) / det;
        let v = d.dot((o - a).cross(e1)) / det;
        (det != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| e2.dot((o - a).cross(e1)) / det)
    }

    #[test]
    fn on_a_grid_the_test_is_exact() {
        let mut rng = rand_pcg::Pcg32::seed_from_u64(1);
        let mut hits = 0;
        for _ in 0..200_000 {
            let corners = std::array::from_fn(|_| grid(&mut rng));
            let ray = Ray::new(grid(&mut rng), grid(&mut rng));
            let found = MollerTrumbore::hit(&MollerTrumbore::prepare(&ray), &MollerTrumbore::block(&[corners]));
            assert_eq!(found, naive(&ray, corners).map(|t| t as f32), "{ray:?} {corners:?}");
            hits += usize::from(found.is_some());
        }
        assert!(hits > 10_000, "the grid must produce hits, or the test proves nothing: {hits}");
    }

    #[test]
    fn random_hits_agree_with_f64_away_from_edges() {
        let mut rng = rand_pcg::Pcg32::seed_from_u64(2);
        for _ in 0..100_000 {
            let corners = std::array::from_fn(|_| unit(&mut rng));
            let ray = Ray::new(unit(&mut rng) * 4.0, unit(&mut rng));
            let found = MollerTrumbore::hit(&MollerTrumbore::prepare(&ray), &MollerTrumbore::block(&[corners]));
            let shrunk = corners.map(|p| p + ((corners[0] + corners[1] + corners[2]) / 3.0 - p) * 1e-2);
            if naive(&ray, shrunk).is_some() {
                assert!(found.is_some(), "a hit well inside is lost: {ray:?} {corners:?}");
            }
            let grown = corners.map(|p| p - ((corners[0] + corners[1] + corners[2]) / 3.0 - p) * 1e-2);
            if found.is_some() {
                assert!(naive(&ray, grown).is_some(), "a hit well outside is invented: {ray:?} {corners:?}");
            }
        }
    }

    #[test]
    fn all_widths_give_the_same_bits() {
        fn check<const N: usize, L: Lanes<N>>(ray: &Ray, corners: &[[Vec3; 3]]) {
            let prepared = MollerTrumbore::prepare(ray);
            for chunk in corners.chunks(N) {
                let (mask, t) = MollerTrumbore::hits::<N, L>(&prepared, &MollerTrumbore::block(chunk));
                for (lane, &triangle) in chunk.iter().enumerate() {
                    let scalar = MollerTrumbore::hit(&prepared, &MollerTrumbore::block(&[triangle]));
                    let wide = (mask >> lane & 1 == 1).then(|| t.store()[lane]);
                    assert_eq!(wide.map(f32::to_bits), scalar.map(f32::to_bits));
                }
                assert_eq!(mask >> chunk.len(), 0, "an unused lane hits");
            }
        }
        let mut rng = rand_pcg::Pcg32::seed_from_u64(3);
        for round in 0..20_000 {
            let point = if round % 2 == 0 { unit } else { grid };
            let corners: Vec<[Vec3; 3]> = (0..7).map(|_| std::array::from_fn(|_| point(&mut rng))).collect();
            let ray = Ray::new(point(&mut rng) * 3.0, point(&mut rng));
            check::<4, F32x4>(&ray, &corners);
            check::<8, F32x8>(&ray, &corners);
            check::<8, Portable<8>>(&ray, &corners);
        }
    }

    #[test]
    fn what_is_not_a_number_never_hits() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let block = MollerTrumbore::block(&[corners]);
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for axis in 0..3 {
                let mut ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
                ray.direction[axis] = bad;
                assert_eq!(MollerTrumbore::hit(&MollerTrumbore::prepare(&ray), &block), None);
            }
        }
    }
}
