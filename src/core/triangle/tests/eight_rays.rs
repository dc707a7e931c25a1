//! Compares the hits from `meet_eight` with the hits from `hit`.

use std::marker::PhantomData;

use super::*;
use crate::simd::{EightLanes, Kernel, LaneVec3, Level, dispatch, each};

/// The first output counts the hits from `hit`. The second output counts the hits from `meet_eight`. A hit
/// counts only if its `t` is below the third field.
struct Eight<'a, T>(&'a [Ray; 8], &'a [[Vec3; 3]], f32, PhantomData<T>);

impl<T: TriangleTest> Kernel for Eight<'_, T> {
    type Output = [usize; 2];

    #[inline(always)]
    fn run<L: EightLanes>(self) -> [usize; 2] {
        let Self(rays, triangles, to, _) = self;
        let lanes = eight::<L>(rays);
        let to = each(rays, |ray| to.min(T::last(ray.t_max)));
        let block = T::block::<8>(triangles);
        let mut counts = [0; 2];
        for (lane, &corners) in triangles.iter().enumerate() {
            // Only rays 0 to 6 are active.
            let found = T::meet_eight(&lanes, &block, lane, L::load(&to), L::mask(0x7f));
            let found =
                found.map(|found| (L::bits(found.met), L::bits(found.missed), found.low.store(), found.high.store()));
            let (met, missed, low, high) = found.unwrap_or((0, 0xff, [0.0; 8], [0.0; 8]));
            for (i, ray) in rays[..7].iter().enumerate() {
                let (met, missed) = (met >> i & 1 == 1, missed >> i & 1 == 1);
                let single = T::block(&[corners]);
                let alone = T::hit(&T::prepare(ray), &single, ray.t_min, T::last(ray.t_max));
                let t = alone.map(|depth| depth.t(ray));
                let to = to[i];
                let place = || format!("{}: {ray:?} {corners:?} up to {to:e}: {t:?}", T::NAME);
                if T::ONE_STAGE {
                    assert_eq!(met, t.is_some_and(|t| t <= to), "{}", place());
                    assert!(!met || t.map(f32::to_bits) == Some(low[i].to_bits()), "{}", place());
                } else {
                    assert!(!met || t.is_some_and(|t| low[i] <= t && t <= high[i]), "{}", place());
                    assert!(!missed || t.is_none_or(|t| t >= to), "{}", place());
                }
                counts[0] += usize::from(t.is_some_and(|t| t < to));
                counts[1] += usize::from(met && t.is_some_and(|t| t < to));
            }
        }
        counts
    }
}

fn eight<L: EightLanes>(rays: &[Ray; 8]) -> EightRays<L> {
    let rows = |of: fn(&Ray) -> Vec3| {
        let row = |axis: usize| L::load(&each(rays, |ray| of(ray)[axis]));
        LaneVec3::new(row(0), row(1), row(2))
    };
    let largest = |of: fn(&Ray) -> Vec3| rays.iter().map(|ray| of(ray).abs().max_element()).fold(0.0, f32::max);
    EightRays {
        origin: rows(|ray| ray.origin),
        direction: rows(|ray| ray.direction),
        t_min: L::load(&each(rays, |ray| ray.interval().0)),
        t_max: L::load(&each(rays, |ray| ray.interval().1)),
        longest: largest(|ray| ray.direction),
        farthest: largest(|ray| ray.origin),
    }
}

fn count_hits<T: TriangleTest>() -> [usize; 2] {
    let mut rng = Pcg32::seed_from_u64(12);
    let mut sums = [0; 2];
    for round in 0..3_000 {
        let number: Number = [unit, grid, any][round % 3];
        let triangles: Vec<[Vec3; 3]> = (0..7).map(|_| triangle(&mut rng, number)).collect();
        let mut one = || {
            let ray = match round % 5 {
                0 | 1 => ray(&mut rng, number),
                2 => aimed(&mut rng, triangles[0]),
                _ => {
                    let origin = point(&mut rng, unit);
                    Ray::new(origin, triangles[0][0] + point(&mut rng, unit) * 0.1 - origin)
                }
            };
            if round % 7 == 0 { Ray { t_min: 0.5, ..ray }.until(1.5) } else { ray }
        };
        let rays: [Ray; 8] = std::array::from_fn(|_| one());
        if !rays.iter().all(Ray::is_valid) {
            continue;
        }
        for level in Level::available() {
            let counts = dispatch(level, Eight(&rays, &triangles, [f32::INFINITY, 1.0][round % 2], PhantomData::<T>));
            sums = [sums[0] + counts[0], sums[1] + counts[1]];
        }
    }
    sums
}

#[test]
fn eight_rays_agree_with_single_rays() {
    let [hits, decided] = count_hits::<MollerTrumbore>();
    assert!(hits > 5_000 && hits == decided, "{decided} of {hits} hits");
    let [hits, decided] = count_hits::<Exact>();
    assert!(hits > 5_000 && decided > hits / 2, "{decided} of {hits} hits");
}
