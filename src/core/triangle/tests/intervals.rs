//! The ends of intervals.

use std::cmp::Ordering;

use super::*;

/// For any numbers the test does not crash, and returns no `t` outside the interval. A `t` near the end may be rounded
/// to the end.
pub(super) fn survives_all_numbers<T: TriangleTest>() {
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

/// If a test gives the true `t`, and that is a float: an interval contains it if it begins there, and not if it ends
/// there.
pub(super) fn intervals_are_half_open<T: TriangleTest>() {
    let mut rng = Pcg32::seed_from_u64(13);
    let mut hits = 0;
    for _ in 0..60_000 {
        let (corners, ray) = (triangle(&mut rng, grid), ray(&mut rng, grid));
        let Some(t) = scalar_hit::<T>(&ray, corners) else { continue };
        let is_float = |exact: judge::ExactT| exact.compare(t) == Some(Ordering::Equal);
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
    assert!(hits > 1_000, "{}: too few hits to prove anything: {hits}", T::NAME);
}

/// A ray without end ends at numbers whose nearest float is not finite.
pub(super) fn a_t_beyond_the_largest_float_is_no_hit<T: TriangleTest>() {
    let at = |z: f32| [Vec3::new(-1.0, -1.0, z), Vec3::new(3.0, -1.0, z), Vec3::new(-1.0, 3.0, z)];
    let short = |length: f32| Ray::new(Vec3::ZERO, Vec3::new(0.0, 0.0, length));
    let (tiny, far) = (libm::exp2f(-100.0), libm::exp2f(27.0));
    assert_eq!(scalar_hit::<T>(&short(libm::exp2f(-60.0)), at(far)), Some(libm::exp2f(87.0)), "{}", T::NAME);
    for z in [2.0 * far, 3.0 * far, 1e9, 1e12] {
        assert_eq!(scalar_hit::<T>(&short(tiny), at(z)), None, "{}: t = {z} * 2^100", T::NAME);
    }
}
