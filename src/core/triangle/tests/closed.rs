//! Checks that no ray passes between neighbouring triangles.

use super::*;

/// `scale` multiplies the triangles and the ray's origin.
fn closed_at<T: TriangleTest>(scale: f32, rounds: usize, vertices: bool) {
    let mut rng = Pcg32::seed_from_u64(8);
    for round in 0..rounds {
        let rim: Vec<Vec3> = (0..6)
            .map(|k| {
                let (x, y) = [(1.0, 0.0), (0.5, 0.9), (-0.5, 0.9), (-1.0, 0.0), (-0.5, -0.9), (0.5, -0.9)][k];
                Vec3::new(x, y, 0.0) + point(&mut rng, unit) * 0.2
            })
            .collect();
        let centre = point(&mut rng, unit) * 0.2;
        let share = if vertices { 0.0 } else { unit(&mut rng) * 0.4 + 0.5 };
        let target = centre + (rim[0] - centre) * share;
        let beside = if round % 4 == 0 { Vec3::new(target.x, target.y, 0.0) } else { point(&mut rng, unit) };
        let origin = Vec3::new(0.0, 0.0, 3.0) + beside;
        let ray = Ray::new(origin * scale, target - origin);
        let fan = |k: usize| [centre, rim[k], rim[(k + 1) % 6]].map(|p| p * scale);
        let hits: Vec<f32> = (0..6).filter_map(|k| scalar_hit::<T>(&ray, fan(k))).collect();
        assert!(!hits.is_empty(), "{}: {ray:?} slips through {centre:?} {rim:?} times {scale:e}", T::NAME);
        let right = |t: &f32| (t / scale - 1.0).abs() < 1e-2;
        assert!(hits.iter().all(right), "{}: {hits:?} for {scale:e}: {ray:?}", T::NAME);
    }
}

#[test]
fn edge_tests_watertight_and_exact_are_closed_at_edges_and_all_but_plucker_at_vertices() {
    closed_at::<Plucker>(1.0, 20_000, false);
    for vertices in [false, true] {
        closed_at::<MollerTrumboreF64>(1.0, 20_000, vertices);
        closed_at::<EdgeF64>(1.0, 20_000, vertices);
        closed_at::<Exact>(1.0, 20_000, vertices);
        closed_at::<Watertight>(1.0, 20_000, vertices);
        // At some of these scales, products of two coordinates leave the range of `f32`.
        for exponent in [-140, -120, -90, -76, -60, -45, 30, 45, 63, 64, 90, 120] {
            closed_at::<Watertight>(libm::exp2(f64::from(exponent)) as f32, 2_000, vertices);
        }
    }
}
