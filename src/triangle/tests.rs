//! What holds for every triangle test, and what only some promise.

mod f64_bounds;
mod intervals;

use std::marker::PhantomData;

use glam::Vec3;
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

use super::*;
use crate::exact::{self as integers, rational};
use crate::simd::{EightLanes, F32x4, Kernel, Level, dispatch};

type Number = fn(&mut Pcg32) -> f32;

fn unit(rng: &mut Pcg32) -> f32 {
    rng.next_u32() as f32 / u32::MAX as f32 * 2.0 - 1.0
}

/// Coarse, so that hits on edges and corners, -0.0 and parallel rays are frequent.
fn grid(rng: &mut Pcg32) -> f32 {
    (rng.next_u32() % 5) as f32 - 2.0
}

/// Any size, up to where the products of tests overflow and underflow.
fn any(rng: &mut Pcg32) -> f32 {
    loop {
        let x = f32::from_bits(rng.next_u32());
        if x.is_finite() {
            return x;
        }
    }
}

fn point(rng: &mut Pcg32, number: Number) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|_| number(rng)))
}

fn triangle(rng: &mut Pcg32, number: Number) -> [Vec3; 3] {
    std::array::from_fn(|_| point(rng, number))
}

fn ray(rng: &mut Pcg32, number: Number) -> Ray {
    Ray::new(point(rng, number), point(rng, number))
}

/// Aims at the triangle, so that it is often hit or narrowly missed, from any distance.
fn aimed(rng: &mut Pcg32, [a, b, c]: [Vec3; 3]) -> Ray {
    let (u, v) = (unit(rng) * 0.7 + 0.3, unit(rng) * 0.7 + 0.3);
    let target = a + (b - a) * u + (c - a) * v;
    let origin = target + point(rng, unit) * libm::exp2f((rng.next_u32() % 40) as f32 - 20.0);
    Ray::new(origin, (target - origin) * libm::exp2f((rng.next_u32() % 40) as f32 - 20.0))
}

fn true_t(ray: &Ray, corners: [Vec3; 3]) -> Option<f32> {
    integers::hit(ray, corners).filter(|t| ray.is_valid() && t.is_within(ray)).map(|t| t.round())
}

/// Every width gives the bits of the scalar form, and lanes left over hit nothing.
fn all_widths_agree<T: TriangleTest>() {
    fn check<T: TriangleTest, const N: usize, L: Lanes<N>>(ray: &Ray, triangles: &[[Vec3; 3]]) -> usize {
        let (t_min, t_max) = ray.interval();
        let (prepared, last) = (T::prepare(ray), T::last(t_max));
        let mut hits = 0;
        for chunk in triangles.chunks(N) {
            let block = T::block::<N>(chunk);
            let (candidates, value) = T::candidates::<N, L>(&prepared, &block, t_min, last);
            assert_eq!(candidates as u64 >> chunk.len(), 0, "{}: an unused lane is a candidate", T::NAME);
            for (lane, &corners) in chunk.iter().enumerate() {
                let is_candidate = candidates >> lane & 1 == 1;
                let hit = is_candidate.then(|| T::decide(&prepared, &block, lane, value.store()[lane])).flatten();
                let scalar = scalar_hit::<T>(ray, corners);
                assert_eq!(hit.map(|d| d.t().to_bits()), scalar.map(f32::to_bits), "{}: {ray:?} {corners:?}", T::NAME);
                hits += usize::from(hit.is_some());
            }
        }
        hits
    }
    /// Eight lanes on a level.
    struct Eight<'a, T>(&'a Ray, &'a [[Vec3; 3]], PhantomData<T>);
    impl<T: TriangleTest> Kernel for Eight<'_, T> {
        type Output = usize;

        #[inline(always)]
        fn run<L: EightLanes>(self) -> usize {
            check::<T, 8, L>(self.0, self.1)
        }
    }
    let mut rng = Pcg32::seed_from_u64(3);
    let mut hits = 0;
    for round in 0..6_000 {
        let number: Number = [unit, grid, any][round % 3];
        let triangles: Vec<[Vec3; 3]> = (0..7).map(|_| triangle(&mut rng, number)).collect();
        let ray = ray(&mut rng, number);
        if ray.is_valid() {
            hits += check::<T, 4, F32x4>(&ray, &triangles);
            for level in Level::available() {
                hits += dispatch(level, Eight::<T>(&ray, &triangles, PhantomData));
            }
        }
    }
    assert!(hits > 5_000, "{}: too few hits to prove anything: {hits}", T::NAME);
}

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
                    let (t, value) = (t.store()[i], value.store()[lane]);
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

/// A triangle a little smaller is hit only where this one is, and this one only where a little larger one is.
fn right_away_from_edges<T: TriangleTest>() {
    let mut rng = Pcg32::seed_from_u64(2);
    let mut hits = 0;
    for _ in 0..30_000 {
        let corners = triangle(&mut rng, unit);
        let origin = point(&mut rng, unit) * 4.0;
        let ray = Ray::new(origin, point(&mut rng, unit) - origin);
        let resized = |share: f32| {
            let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
            true_t(&ray, corners.map(|p| p + (centre - p) * share))
        };
        let found = scalar_hit::<T>(&ray, corners);
        if let Some(t) = resized(1e-2) {
            let found = found.unwrap_or_else(|| panic!("{}: a hit well inside is lost: {ray:?} {corners:?}", T::NAME));
            assert!((found - t).abs() < 0.05 * t.abs() + 1e-3, "{}: {found} {t}: {ray:?} {corners:?}", T::NAME);
            hits += 1;
        }
        if found.is_some() {
            assert!(resized(-1e-2).is_some(), "{}: a hit well outside is invented: {ray:?} {corners:?}", T::NAME);
        }
    }
    assert!(hits > 500, "{hits}");
}

/// Where all arithmetic is exact, the answer is.
fn exact_on_a_grid<T: TriangleTest>() {
    let mut rng = Pcg32::seed_from_u64(1);
    let mut hits = 0;
    for _ in 0..60_000 {
        let (corners, ray) = (triangle(&mut rng, grid), ray(&mut rng, grid));
        let found = scalar_hit::<T>(&ray, corners);
        assert_eq!(found, true_t(&ray, corners), "{}: {ray:?} {corners:?}", T::NAME);
        hits += usize::from(found.is_some());
    }
    assert!(hits > 1_000, "the grid must produce hits, or the test proves nothing: {hits}");
}

macro_rules! every_test {
    ($($module:ident: $test:ty [$($more:ident),*];)*) => {$(
        mod $module {
            use super::*;

            #[test]
            fn all_widths_agree() {
                super::all_widths_agree::<$test>();
            }

            #[test]
            fn right_away_from_edges() {
                super::right_away_from_edges::<$test>();
            }

            #[test]
            fn survives_all_numbers() {
                intervals::survives_all_numbers::<$test>();
            }

            #[test]
            fn intervals_are_half_open() {
                intervals::are_half_open::<$test>();
            }

            #[test]
            fn a_t_beyond_the_largest_float_is_no_hit() {
                intervals::end_at_the_largest_float::<$test>();
            }

            $(
                #[test]
                fn $more() {
                    super::$more::<$test>();
                }
            )*
        }
    )*};
}

every_test! {
    moller_trumbore: MollerTrumbore [exact_on_a_grid];
    moller_trumbore_f64: MollerTrumboreF64 [exact_on_a_grid];
    plucker: Plucker [exact_on_a_grid];
    edge_f64: EdgeF64 [exact_on_a_grid];
    watertight: Watertight [];
    baldwin_weber: BaldwinWeber [];
    filtered_f64: FilteredF64 [exact_on_a_grid];
    exact: Exact [exact_on_a_grid];
}

/// The cases on which the stages of a filter are put to the test: all sizes, aimed closely, on a grid, at random.
fn hard(rng: &mut Pcg32, round: usize) -> (Ray, [Vec3; 3]) {
    // Every size of scene, not every tenth power: each intermediate underflows at another one.
    let scale = f32::from_bits((1 + rng.next_u32() % 251) << 23);
    match round % 4 {
        0 => (ray(rng, any), triangle(rng, any)),
        1 => {
            let corners = triangle(rng, unit).map(|p| p * scale);
            (aimed(rng, corners), corners)
        }
        2 => {
            // A sliver far from the origin.
            let shift = point(rng, unit) * (scale * 1e3);
            let [a, b, _] = triangle(rng, unit).map(|p| p * scale + shift);
            let corners = [a, b, a + (b - a) * unit(rng) + point(rng, unit) * (scale * 1e-6)];
            (aimed(rng, corners), corners)
        }
        _ => {
            let corners = triangle(rng, grid);
            let origin = point(rng, grid);
            let target = corners[round / 4 % 3]
                + (corners[(round / 4 + 1) % 3] - corners[round / 4 % 3]) * (rng.next_u32() % 3) as f32 * 0.5;
            (Ray::new(origin * scale, (target - origin) * scale), corners.map(|p| p * scale))
        }
    }
}

/// In a scene of 1e-15, the products of three lengths underflow before those of two.
#[test]
fn hits_where_only_the_height_underflows_are_found() {
    let unit = libm::exp2f(-51.0);
    let corners = [Vec3::new(1.0, -2.0, -1.0), Vec3::new(2.0, 3.0, 0.0), Vec3::new(-3.0, 3.0, 2.0)].map(|p| p * unit);
    let ray = Ray::new(corners[2], Vec3::NEG_Z);
    assert_eq!(scalar_hit::<Exact>(&ray, corners), Some(0.0));
    assert_eq!(scalar_hit::<FilteredF64>(&ray, corners), scalar_hit::<MollerTrumboreF64>(&ray, corners));
}

/// Some interval, often one that ends at the hit.
fn windowed(rng: &mut Pcg32, ray: Ray, corners: [Vec3; 3]) -> Ray {
    let t = integers::hit(&ray, corners).map_or(1.0, |t| t.round());
    let end = |rng: &mut Pcg32| match rng.next_u32() % 4 {
        0 => t,
        1 => t.next_up(),
        _ => t.next_down(),
    };
    match rng.next_u32() % 4 {
        0 => Ray { t_min: end(rng), ..ray },
        1 => Ray { t_max: end(rng), ..ray },
        _ => ray,
    }
}

#[test]
fn the_exact_test_agrees_with_integers_everywhere() {
    let mut rng = Pcg32::seed_from_u64(5);
    let mut hits = 0;
    for round in 0..200_000 {
        let (ray, corners) = hard(&mut rng, round);
        let ray = windowed(&mut rng, ray, corners);
        let found = scalar_hit::<Exact>(&ray, corners);
        assert_eq!(found.map(f32::to_bits), true_t(&ray, corners).map(f32::to_bits), "{ray:?} {corners:?}");
        // These integers are those of the test itself: a second judge shares nothing with it, but takes longer.
        if round % 31 == 0 && ray.is_valid() {
            let second = rational::hit_within(&ray, corners);
            assert_eq!(found.map(f32::to_bits), second.map(f32::to_bits), "{ray:?} {corners:?}");
        }
        hits += usize::from(found.is_some());
    }
    assert!(hits > 30_000, "{hits}");
}

#[test]
fn filtered_f64_gives_the_bits_of_plain_f64() {
    let mut rng = Pcg32::seed_from_u64(6);
    let mut hits = 0;
    for round in 0..400_000 {
        let (ray, corners) = hard(&mut rng, round);
        let plain = scalar_hit::<MollerTrumboreF64>(&ray, corners);
        let filtered = scalar_hit::<FilteredF64>(&ray, corners);
        assert_eq!(filtered.map(f32::to_bits), plain.map(f32::to_bits), "{ray:?} {corners:?}");
        hits += usize::from(plain.is_some());
    }
    assert!(hits > 60_000, "{hits}");
}

#[test]
fn the_first_stage_rejects_nearly_all_that_is_missed() {
    let mut rng = Pcg32::seed_from_u64(7);
    let (mut misses, mut kept) = (0, 0);
    for _ in 0..50_000 {
        let (ray, corners) =
            (Ray::new(point(&mut rng, unit) * 4.0, point(&mut rng, unit)), triangle(&mut rng, unit).map(|p| p * 0.01));
        if integers::hit(&ray, corners).is_none() {
            let block = filter::FilterBlock::<1>::new(&[corners]);
            misses += 1;
            kept += filter::survivors::<1, Portable<1>>(&filter::FilterRay::new(&ray), &block).0;
        }
    }
    assert!(misses > 40_000 && kept < 20, "{kept} of {misses} misses survive");
}

/// Rays through the edge that two triangles share, and through a vertex that six share, hit one of them.
fn closed<T: TriangleTest>(vertices: bool) {
    closed_at::<T>(1.0, 20_000, vertices);
}

/// The same where everything but the direction is so much larger.
fn closed_at<T: TriangleTest>(scale: f32, rounds: usize, vertices: bool) {
    let mut rng = Pcg32::seed_from_u64(8);
    for _ in 0..rounds {
        let rim: Vec<Vec3> = (0..6)
            .map(|k| {
                let (x, y) = [(1.0, 0.0), (0.5, 0.9), (-0.5, 0.9), (-1.0, 0.0), (-0.5, -0.9), (0.5, -0.9)][k];
                Vec3::new(x, y, 0.0) + point(&mut rng, unit) * 0.2
            })
            .collect();
        let centre = point(&mut rng, unit) * 0.2;
        let origin = Vec3::new(0.0, 0.0, 3.0) + point(&mut rng, unit);
        let share = if vertices { 0.0 } else { unit(&mut rng) * 0.4 + 0.5 };
        let target = centre + (rim[0] - centre) * share;
        let ray = Ray::new(origin * scale, target - origin);
        let fan = |k: usize| [centre, rim[k], rim[(k + 1) % 6]].map(|p| p * scale);
        let hits: Vec<f32> = (0..6).filter_map(|k| scalar_hit::<T>(&ray, fan(k))).collect();
        assert!(!hits.is_empty(), "{}: {ray:?} slips through {centre:?} {rim:?} times {scale:e}", T::NAME);
        let right = |t: &f32| (t / scale - 1.0).abs() < 1e-2;
        assert!(hits.iter().all(right), "{}: {hits:?} for {scale:e}: {ray:?}", T::NAME);
    }
}

#[test]
fn edge_tests_and_watertight_are_closed_at_edges() {
    closed::<Plucker>(false);
    closed::<MollerTrumboreF64>(false);
    closed::<EdgeF64>(false);
    closed::<Watertight>(false);
    closed::<Exact>(false);
}

#[test]
fn watertight_f64_and_exact_are_closed_at_vertices() {
    closed::<Watertight>(true);
    closed::<MollerTrumboreF64>(true);
    closed::<EdgeF64>(true);
    closed::<Exact>(true);
}

/// Products of two coordinates leave the range of `f32` at both ends, differences of two do not.
#[test]
fn watertight_is_closed_at_every_scale() {
    for exponent in [-140, -120, -90, -76, -60, -45, 30, 45, 63, 64, 90, 120] {
        let scale = libm::exp2(f64::from(exponent)) as f32;
        closed_at::<Watertight>(scale, 2_000, false);
        closed_at::<Watertight>(scale, 2_000, true);
    }
}

/// Both corners of a pair of triangles at the same exact `t`: the lower number wins, whatever `f64` makes of them.
#[test]
fn exact_depths_are_ordered_exactly() {
    let ray = Ray::new(Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.7, 0.3, -0.9));
    let depth =
        |corners| Exact::hit(&Exact::prepare(&ray), &Exact::block(&[corners]), 0.0, f32::INFINITY).expect("hit");
    // Planes z = -1 and z = -1 - 2^-23: t differs in the last bit of f32.
    let [p, q, r] = [Vec3::new(-9.0, -9.0, -1.0), Vec3::new(9.0, -9.0, -1.0), Vec3::new(0.0, 19.0, -1.0)];
    let turned = depth([q, r, p]);
    assert_eq!(depth([p, q, r]).order(&turned), std::cmp::Ordering::Equal);
    // The same plane by other corners.
    assert_eq!(depth([p, q, Vec3::new(0.3, 7.1, -1.0)]).order(&turned), std::cmp::Ordering::Equal);
    let lower = [p, q, r].map(|v| Vec3::new(v.x, v.y, v.z.next_down()));
    assert_eq!(turned.order(&depth(lower)), std::cmp::Ordering::Less);
    assert_eq!(depth(lower).order(&turned), std::cmp::Ordering::Greater);
}
