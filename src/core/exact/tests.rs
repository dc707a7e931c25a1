use dashu_ratio::RBig;
use dashu_ratio::ops::Abs;
use rand_core::SeedableRng;
use rand_pcg::Pcg32;

use super::*;
use crate::triangle::tests::{any, grid, point, ray, triangle, unit};

fn assert_agree(ray: &Ray, corners: [Vec3; 3]) -> bool {
    let ours = hit(ray, corners);
    let twin = rational::hit(ray, corners);
    let as_rational = |t: ExactT| RBig::from(&t.numerator) / RBig::from(&t.denominator);
    assert_eq!(ours.clone().map(as_rational), twin, "{ray:?} {corners:?}");
    assert_eq!(ours.as_ref().map(ExactT::round), twin.map(|t| t.to_f32().value()), "{ray:?} {corners:?}");
    let [a, ..] = corners;
    let sums = RBig::from(&Expansion::dot(&difference(a, ray.origin), &normal(corners)));
    let found = RBig::try_from(height(ray.origin, corners)).unwrap();
    let most = RBig::try_from(libm::exp2(-49.0)).unwrap() * sums.clone().abs();
    assert!((found - sums).abs() <= most, "{ray:?} {corners:?}");
    ours.is_some()
}

#[test]
fn both_formulations_agree_on_a_grid_and_at_all_scales() {
    let mut rng = Pcg32::seed_from_u64(11);
    let (mut on_grid, mut scaled) = (0, 0);
    for round in 0..4_000 {
        for _ in 0..3 {
            let corners = triangle(&mut rng, grid);
            on_grid += usize::from(assert_agree(&ray(&mut rng, grid), corners));
        }
        if round % 2 == 0 {
            // The scales range from denormals to numbers whose cubes overflow `f32`.
            let scale = f32::from_bits([1 << 10, 1 << 23, 97 << 23, 127 << 23, 157 << 23, 253 << 23][round / 2 % 6]);
            let corners = triangle(&mut rng, unit).map(|p| p * scale);
            let ray = Ray::new(point(&mut rng, unit) * scale, point(&mut rng, unit));
            scaled += usize::from(assert_agree(&ray, corners));
        } else {
            let corners = triangle(&mut rng, any);
            assert_agree(&ray(&mut rng, any), corners);
        }
    }
    assert!(on_grid > 500 && scaled > 100, "too few hits for a meaningful test: {on_grid}, {scaled}");
}

#[test]
fn the_triangle_is_closed_and_its_plane_is_missed() {
    let corners = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 4.0, 0.0)];
    let down = |x: f32, y: f32| hit(&Ray::new(Vec3::new(x, y, 3.0), Vec3::new(0.0, -0.0, -2.0)), corners);
    for (x, y) in [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (2.0, 0.0), (0.0, 1.0), (3.0, 1.0), (1.0, 1.0)] {
        let t = down(x, y).unwrap_or_else(|| panic!("({x}, {y}) is in the closed triangle"));
        assert_eq!((t.round(), t.compare(1.5)), (1.5, Some(Ordering::Equal)));
    }
    let beside = f32::from_bits(1);
    for (x, y) in [(-beside, 0.0), (0.0, -beside), (4.0, beside), (4.0_f32.next_up(), 0.0), (2.0, 2.0_f32.next_up())] {
        assert_eq!(down(x, y), None, "({x}, {y}) is outside");
    }
    for z in [0.0, 1.0] {
        assert_eq!(hit(&Ray::new(Vec3::new(-1.0, 1.0, z), Vec3::X), corners), None);
    }
}

#[test]
fn what_has_no_area_and_what_is_not_finite_is_missed() {
    let ray = Ray::new(Vec3::ZERO, Vec3::ONE);
    let p = Vec3::ONE;
    for corners in [[p, p, p], [p, p, Vec3::X], [Vec3::ZERO, p, p * 2.0], [-p, p * 3.0, p]] {
        assert_eq!(hit(&ray, corners), None);
    }
    let corners = [Vec3::X, Vec3::Y, Vec3::Z];
    assert_eq!(hit(&ray, corners).map(|t| t.round()), Some(1.0 / 3.0));
    assert_eq!(hit(&Ray::new(Vec3::ZERO, Vec3::ZERO), corners), None);
    for bad in [f32::NAN, f32::INFINITY] {
        assert_eq!(hit(&Ray::new(Vec3::ZERO, Vec3::new(1.0, bad, 1.0)), corners), None);
        assert_eq!(hit(&Ray::new(Vec3::new(0.0, bad, 0.0), p), corners), None);
        assert_eq!(hit(&ray, [Vec3::new(bad, 0.0, 0.0), Vec3::Y, Vec3::Z]), None);
    }
}

fn fraction(numerator: f64, denominator: f64) -> ExactT {
    ExactT { numerator: numerator.into(), denominator: denominator.into() }
}

#[test]
fn rounding_is_to_nearest_even() {
    let exact = |x: f32| fraction(x.into(), 1.0);
    for x in [0.0, 1.0, -1.5, 0.1, f32::MIN_POSITIVE, f32::from_bits(1), f32::from_bits(0x7f_ffff), f32::MAX, f32::MIN]
    {
        assert_eq!(exact(x).round(), x);
        assert_eq!(exact(x).compare(x), Some(Ordering::Equal));
        assert_eq!(exact(x).compare(x.next_up()), Some(Ordering::Less));
    }
    assert_eq!(exact(0.0).round().to_bits(), 0);
    assert_eq!(fraction(1.0, 3.0).round(), 1.0 / 3.0);
    assert_eq!(fraction(16_777_217.0, 1.0).round(), 16_777_216.0);
    assert_eq!(fraction(16_777_219.0, 1.0).round(), 16_777_220.0);
    assert_eq!(fraction(-7.0, 1000.0).round(), -0.007);
    // Rounded to `f64`, each fraction would be exactly a tie.
    let near_tie = |off: f64| ExactT { numerator: Expansion::difference(16_777_217.0, off), denominator: 1.0.into() };
    assert_eq!([-1e-20, 0.0, 1e-20].map(|off| near_tie(off).round()), [16_777_218.0, 16_777_216.0, 16_777_216.0]);
    // The tie between zero and the smallest denormal rounds to zero.
    assert_eq!(fraction(1.0, 2.0_f64.powi(150)).round(), 0.0);
    assert_eq!(fraction(3.0, 2.0_f64.powi(151)).round(), f32::from_bits(1));
    // 2^128 - 2^103 is half an ulp above the largest float.
    let limit = 2.0_f64.powi(128) - 2.0_f64.powi(103);
    let below = ExactT { numerator: Expansion::difference(limit, 1.0), denominator: 1.0.into() };
    let at = fraction(limit, 1.0);
    assert_eq!((below.round(), at.round()), (f32::MAX, f32::INFINITY));
    let whole = Ray::new(Vec3::ZERO, Vec3::X);
    assert_eq!([&below, &at].map(|t| t.is_within(&whole)), [true, false]);
    assert!(!below.is_within(&whole.until(f32::MAX)));
    assert!(!fraction(1.0, 1.0).is_within(&whole.until(f32::NAN)));
    assert!(at.approximate() >= whole.end() && whole.end() > f64::from(f32::MAX));
}

#[test]
fn order_is_exact_where_floats_are_not() {
    let third = fraction(1.0, 3.0);
    assert_eq!(third, fraction(2.0, 6.0));
    assert!(third < fraction(333_333_334.0, 1_000_000_000.0));
    assert_eq!(third.compare(1.0 / 3.0), Some(Ordering::Less), "the float 1/3 is above one third");
    assert_eq!(third.compare(f32::NAN), None);
    assert_eq!(third.compare(f32::INFINITY), Some(Ordering::Less));
    assert_eq!(third.compare(f32::NEG_INFINITY), Some(Ordering::Greater));
}

#[test]
fn a_line_passes_through_a_point_if_and_only_if_all_minors_are_zero() {
    let zero_by_sums = |ray: &Ray, point: Vec3| {
        cross(&direction(ray), &difference(point, ray.origin)).iter().all(|minor| minor.sign().is_eq())
    };
    let mut passed = 0;
    for i in 0..3_000_u32 {
        let number = |k: u32| {
            let bits = (5 * i + k).wrapping_mul(2_654_435_761).rotate_left(11).wrapping_mul(0x9e37_79b1);
            ((bits >> 8) as f32 - 8_388_608.0) * 2.0_f32.powi(-20 - (bits % 7) as i32)
        };
        let few = |x: f32| (x * 8.0).round();
        let origin = Vec3::new(number(0), few(number(1)), number(2));
        let directions = [Vec3::new(few(number(3)), few(number(4)), 3.0), Vec3::Z, Vec3::new(1e-20, -0.0, 0.0)];
        for direction in directions {
            for origin in [origin, Vec3::new(few(origin.x), origin.y, few(origin.z)), Vec3::new(1e-30, 0.0, 0.0)] {
                let ray = Ray::new(origin, direction);
                for step in [0.0, 1.0, -2.0, 1024.0, 3e10] {
                    let point = origin + direction * step;
                    for point in [point, Vec3 { y: point.y.next_up(), ..point }, Vec3 { z: 1e-38, ..point }] {
                        let is_on = zero_by_sums(&ray, point);
                        assert_eq!(passes_through(&ray, point), is_on, "{ray} {point}");
                        passed += usize::from(is_on);
                    }
                }
            }
        }
    }
    assert!(passed > 10_000, "{passed}");
}
