//! The exact test is held against exact sums and rationals.

use super::*;

/// In a scene of 1e-15, the products of three lengths underflow before those of two.
#[test]
fn hits_where_only_the_height_underflows_are_found() {
    let unit = libm::exp2f(-51.0);
    let corners = [Vec3::new(1.0, -2.0, -1.0), Vec3::new(2.0, 3.0, 0.0), Vec3::new(-3.0, 3.0, 2.0)].map(|p| p * unit);
    let ray = Ray::new(corners[2], Vec3::NEG_Z);
    assert_eq!(scalar_hit::<Exact>(&ray, corners), Some(0.0));
}

/// Some interval, often one that ends at the hit.
pub(super) fn windowed(rng: &mut Pcg32, ray: Ray, corners: [Vec3; 3]) -> Ray {
    let t = judge::hit(&ray, corners).map_or(1.0, |t| t.round());
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
fn the_exact_test_agrees_with_the_judges_everywhere() {
    let mut rng = Pcg32::seed_from_u64(5);
    let mut hits = 0;
    for round in 0..200_000 {
        let (ray, corners) = hard(&mut rng, round);
        let ray = windowed(&mut rng, ray, corners);
        let found = scalar_hit::<Exact>(&ray, corners);
        assert_eq!(found.map(f32::to_bits), true_t(&ray, corners).map(f32::to_bits), "{ray:?} {corners:?}");
        // These sums are those of the test itself: a second judge shares nothing with it, but takes longer.
        if round % 31 == 0 && ray.is_valid() {
            let second = rational::hit_within(&ray, corners);
            assert_eq!(found.map(f32::to_bits), second.map(f32::to_bits), "{ray:?} {corners:?}");
        }
        hits += usize::from(found.is_some());
    }
    assert!(hits > 30_000, "{hits}");
}

/// Both corners of a pair of triangles at the same exact `t`: the lower number wins, whatever `f64` makes of them.
#[test]
fn exact_depths_are_ordered_exactly() {
    let ray = Ray::new(Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.7, 0.3, -0.9));
    // Planes z = -1 and z = -1 - 2^-23: t differs in the last bit of f32.
    let [p, q, r] = [Vec3::new(-9.0, -9.0, -1.0), Vec3::new(9.0, -9.0, -1.0), Vec3::new(0.0, 19.0, -1.0)];
    let order = |one: [Vec3; 3], other: [Vec3; 3]| {
        let (prepared, blocks) = (Exact::prepare(&ray), [one, other].map(|corners| Exact::block(&[corners])));
        let [one, other] =
            [0, 1].map(|i: usize| Exact::hit(&prepared, &blocks[i], 0.0, f32::INFINITY).expect("it is hit"));
        Exact::order(&prepared, &one, &other)
    };
    let turned = [q, r, p];
    assert_eq!(order([p, q, r], turned), std::cmp::Ordering::Equal);
    // The same plane by other corners.
    assert_eq!(order([p, q, Vec3::new(0.3, 7.1, -1.0)], turned), std::cmp::Ordering::Equal);
    let lower = [p, q, r].map(|v| Vec3::new(v.x, v.y, v.z.next_down()));
    assert_eq!(order(turned, lower), std::cmp::Ordering::Less);
    assert_eq!(order(lower, turned), std::cmp::Ordering::Greater);
}
