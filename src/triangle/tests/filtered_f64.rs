//! The first stage loses nothing, and leaves little.

use super::*;

#[test]
fn filtered_f64_gives_the_bits_of_plain_f64() {
    let mut rng = Pcg32::seed_from_u64(6);
    let mut hits = 0;
    for round in 0..400_000 {
        let (ray, corners) = hard(&mut rng, round);
        let ray = super::exact::windowed(&mut rng, ray, corners);
        let plain = scalar_hit::<MollerTrumboreF64>(&ray, corners);
        let filtered = scalar_hit::<FilteredF64>(&ray, corners);
        assert_eq!(filtered.map(f32::to_bits), plain.map(f32::to_bits), "{ray:?} {corners:?}");
        hits += usize::from(plain.is_some());
    }
    assert!(hits > 40_000, "{hits}");
    // A `t` so small that its rounding is no longer relative.
    let corners = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 1.4) * libm::exp2f(-22.0));
    let ray = Ray::new(Vec3::ZERO, Vec3::Z * libm::exp2f(127.0)).until(f32::from_bits(2));
    assert_eq!(scalar_hit::<MollerTrumboreF64>(&ray, corners), Some(f32::from_bits(1)));
    assert_eq!(scalar_hit::<FilteredF64>(&ray, corners), Some(f32::from_bits(1)));
}

#[test]
fn the_first_stage_rejects_nearly_all_that_is_missed() {
    let mut rng = Pcg32::seed_from_u64(7);
    let (mut misses, mut kept) = (0, 0);
    for _ in 0..50_000 {
        let (ray, corners) =
            (Ray::new(point(&mut rng, unit) * 4.0, point(&mut rng, unit)), triangle(&mut rng, unit).map(|p| p * 0.01));
        if judge::hit(&ray, corners).is_none() {
            let block = filter::FilterBlock::<1>::new(&[corners]);
            misses += 1;
            kept += filter::survivors::<1, Portable<1>>(&filter::FilterRay::new(&ray), &block, f32::INFINITY).0;
        }
    }
    assert!(misses > 40_000 && kept < 20, "{kept} of {misses} misses survive");
}
