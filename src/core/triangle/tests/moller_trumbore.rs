//! Möller-Trumbore for eight rays at once.

use super::*;
use crate::simd::{EightLanes, Kernel, Level, dispatch};

/// Eight rays that meet one triangle at once find what each finds alone.
#[test]
fn eight_rays_get_the_bits_of_one_by_one() {
    struct Across<'a>(&'a [Ray; 8], &'a [[Vec3; 3]]);
    impl Kernel for Across<'_> {
        type Output = usize;

        #[inline(always)]
        fn run<L: EightLanes>(self) -> usize {
            let Self(rays, triangles) = self;
            let rows = |of: fn(&Ray) -> Vec3| {
                let row = |axis: usize| L::load(&rays.each_ref().map(|ray| of(ray)[axis]));
                LaneVec3::new(row(0), row(1), row(2))
            };
            let (origin, direction) = (rows(|ray| ray.origin), rows(|ray| ray.direction));
            let (block, everywhere) = (MollerTrumbore::block::<8>(triangles), f32::INFINITY);
            let mut hits = 0;
            for (lane, corners) in triangles.iter().enumerate() {
                let (met, t) = MollerTrumbore::intersect_rays(origin, direction, &block, lane).unwrap();
                let met = L::splat(1.0).choose(L::zero(), met).store();
                for (i, ray) in rays.iter().enumerate() {
                    let prepared = MollerTrumbore::prepare(ray);
                    let (alone, value) = MollerTrumbore::candidates::<8, L>(&prepared, &block, -everywhere, everywhere);
                    let (t, value) = (t.store()[i], MollerTrumbore::values(value)[lane]);
                    // Without an interval even NaN is left.
                    assert_eq!(met[i] == 1.0 && !t.is_nan(), alone >> lane & 1 == 1, "{ray:?} {corners:?}");
                    assert!(t.to_bits() == value.to_bits() || t.is_nan() && value.is_nan(), "{t:e} {value:e}");
                    hits += usize::from(met[i] == 1.0);
                }
            }
            hits
        }
    }
    let mut rng = Pcg32::seed_from_u64(12);
    let mut hits = 0;
    for round in 0..2_000 {
        let number: Number = [unit, grid, any][round % 3];
        let triangles: Vec<[Vec3; 3]> = (0..7).map(|_| triangle(&mut rng, number)).collect();
        let rays: [Ray; 8] = std::array::from_fn(|_| ray(&mut rng, number));
        for level in Level::available() {
            hits += dispatch(level, Across(&rays, &triangles));
        }
    }
    assert!(hits > 5_000, "too few hits to prove anything: {hits}");
}
