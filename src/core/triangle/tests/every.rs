//! Checks properties of every triangle test.

use std::marker::PhantomData;

use super::*;
use crate::simd::{EightLanes, Kernel, Level, dispatch};

fn all_widths_agree<T: TriangleTest>() {
    fn check<T: TriangleTest, const N: usize, L: Lanes<N>>(ray: &Ray, triangles: &[[Vec3; 3]]) -> usize {
        let (t_min, t_max) = ray.interval();
        let (prepared, last) = (T::prepare(ray), T::last(t_max));
        let mut hits = 0;
        for chunk in triangles.chunks(N) {
            let block = T::block::<N>(chunk);
            let (candidates, first) = T::candidates::<N, L>(&prepared, &block, t_min, last);
            let values = T::values(first);
            assert_eq!(candidates as u64 >> chunk.len(), 0, "{}: an unused lane is a candidate", T::NAME);
            for (lane, &corners) in chunk.iter().enumerate() {
                let is_candidate = candidates >> lane & 1 == 1;
                let hit = is_candidate.then(|| T::decide(&prepared, &block, lane, &values)).flatten();
                let [own, scalar] = [hit.map(|d| d.t(ray)), scalar_hit::<T>(ray, corners)].map(|t| t.map(f32::to_bits));
                assert_eq!(own, scalar, "{}: {ray:?} {corners:?}", T::NAME);
                hits += usize::from(hit.is_some());
            }
        }
        hits
    }
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
            hits += check::<T, 4, Portable<4>>(&ray, &triangles);
            for level in Level::available() {
                hits += dispatch(level, Eight::<T>(&ray, &triangles, PhantomData));
            }
        }
    }
    assert!(hits > 5_000, "{}: too few hits for a meaningful test: {hits}", T::NAME);
}

fn correct_far_from_edges<T: TriangleTest>() {
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

/// Sums and products of small integers are exact.
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

fn survives_all_numbers<T: TriangleTest>() {
    let mut rng = Pcg32::seed_from_u64(4);
    for _ in 0..30_000 {
        let (corners, mut ray) = (triangle(&mut rng, any), ray(&mut rng, any));
        (ray.t_min, ray.t_max) = (any(&mut rng), any(&mut rng));
        if let Some(t) = scalar_hit::<T>(&ray, corners) {
            let rounded_to_end = || T::NAME == Exact::NAME && t == ray.t_max && true_t(&ray, corners) == Some(t);
            let within = ray.interval().0 <= t && (t < ray.t_max || rounded_to_end());
            assert!(within, "{}: {t}: {ray:?} {corners:?}", T::NAME);
        }
    }
}

fn intervals_are_half_open<T: TriangleTest>() {
    let mut rng = Pcg32::seed_from_u64(13);
    let mut hits = 0;
    for _ in 0..60_000 {
        let (corners, ray) = (triangle(&mut rng, grid), ray(&mut rng, grid));
        let Some(t) = scalar_hit::<T>(&ray, corners) else { continue };
        let is_float = |exact: judge::ExactT| exact.compare(t) == Some(std::cmp::Ordering::Equal);
        if t == 0.0 || !judge::hit(&ray, corners).is_some_and(is_float) {
            continue;
        }
        hits += 1;
        let up = t.next_up();
        for (t_min, t_max, inside) in [
            (0.0, t, false),
            (0.0, up, true),
            (t, f32::INFINITY, true),
            (t, up, true),
            (up, f32::INFINITY, false),
            (t.next_down(), t, false),
        ] {
            let windowed = Ray { t_min, t_max, ..ray };
            let found = scalar_hit::<T>(&windowed, corners);
            assert_eq!(found, inside.then_some(t), "{}: {windowed:?} {corners:?}", T::NAME);
        }
    }
    assert!(hits > 1_000, "{}: too few hits for a meaningful test: {hits}", T::NAME);
}

fn a_t_beyond_the_largest_float_is_no_hit<T: TriangleTest>() {
    let at = |z: f32| [Vec3::new(-1.0, -1.0, z), Vec3::new(3.0, -1.0, z), Vec3::new(-1.0, 3.0, z)];
    let short = |length: f32| Ray::new(Vec3::ZERO, Vec3::new(0.0, 0.0, length));
    let (tiny, far) = (libm::exp2f(-100.0), libm::exp2f(27.0));
    assert_eq!(scalar_hit::<T>(&short(libm::exp2f(-60.0)), at(far)), Some(libm::exp2f(87.0)), "{}", T::NAME);
    for z in [2.0 * far, 3.0 * far, 1e9, 1e12] {
        assert_eq!(scalar_hit::<T>(&short(tiny), at(z)), None, "{}: t = {z} * 2^100", T::NAME);
    }
}

macro_rules! every_test {
    ($($name:ident: $test:ty, [$($more:ident)*];)*) => {$(
        #[test]
        fn $name() {
            all_widths_agree::<$test>();
            correct_far_from_edges::<$test>();
            survives_all_numbers::<$test>();
            intervals_are_half_open::<$test>();
            a_t_beyond_the_largest_float_is_no_hit::<$test>();
            $($more::<$test>();)*
        }
    )*};
}

every_test! {
    moller_trumbore: MollerTrumbore, [exact_on_a_grid];
    moller_trumbore_f64: MollerTrumboreF64, [exact_on_a_grid];
    plucker: Plucker, [exact_on_a_grid];
    edge_f64: EdgeF64, [exact_on_a_grid];
    watertight: Watertight, [];
    baldwin_weber: BaldwinWeber, [];
    exact: Exact, [exact_on_a_grid];
}
