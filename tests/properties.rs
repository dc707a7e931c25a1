//! Property tests with generated meshes and rays.

#[path = "fuzz/target.rs"]
mod target;

use std::sync::Arc;

use glam::Vec3;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngSeed, TestRunner};
use sahara::accel::DynAccel;
use sahara::geometry::{Mesh, Ray};
use sahara::oracle;
use sahara::registry::Registry;
use target::{Case, VARIANTS};

fn built((name, keys): (&str, &str), mesh: &Arc<Mesh>) -> Box<dyn DynAccel> {
    Registry::builtin().choose(&format!("{name}:test=moller-trumbore,{keys}")).unwrap().build(mesh).unwrap()
}

/// Meshes of fewer than `most` triangles.
fn meshes(number: impl Strategy<Value = f32> + Clone, most: usize) -> impl Strategy<Value = Arc<Mesh>> {
    let point = prop::array::uniform3(number).prop_map(Vec3::from_array);
    (prop::collection::vec(point, 3..40), prop::collection::vec(any::<[prop::sample::Index; 3]>(), 0..most)).prop_map(
        |(points, picks)| {
            let triangles = picks.iter().map(|t| t.each_ref().map(|i| i.index(points.len()) as u32)).collect();
            Arc::new(Mesh::new(points, triangles).expect("made of finite numbers"))
        },
    )
}

fn rays(number: impl Strategy<Value = f32> + Clone, count: usize) -> impl Strategy<Value = Vec<Ray>> {
    let point = prop::array::uniform3(number).prop_map(Vec3::from_array);
    let ray = (point.clone(), point).prop_map(|(origin, direction)| Ray::new(origin, direction));
    prop::collection::vec(ray, count)
}

/// Small integers and zeros of both signs.
///
/// With these coordinates, the division is the only inexact operation of the Möller-Trumbore test.
fn integers() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![9 => (-4_i8..=4).prop_map(f32::from), 1 => Just(-0.0_f32)]
}

fn cases() -> impl Strategy<Value = Case> {
    prop::collection::vec(any::<u8>(), 0..1600).prop_map(|bytes| Case::read(&bytes))
}

#[test]
fn the_fuzzer_leaves_out_no_structure_of_this_crate() {
    assert_eq!(target::left_out(), Vec::<String>::new());
}

#[test]
fn most_drawn_cases_are_meshes_that_rays_hit() {
    let mut runner = TestRunner::new(config());
    let (mut meshes, mut hits) = (0, 0);
    for _ in 0..200 {
        let Case { positions, triangles, rays } = cases().new_tree(&mut runner).unwrap().current();
        if let Ok(mesh) = Mesh::new(positions, triangles) {
            meshes += 1;
            hits += rays.iter().filter(|ray| oracle::nearest(ray, &mesh).is_some()).count();
        }
    }
    assert!((181..200).contains(&meshes) && hits > 600, "{meshes} meshes of 200 cases, {hits} hits");
}

/// Returns a number from an environment variable. tests/fuzz/README.md describes the variables.
fn from_environment(name: &str, otherwise: u32) -> u32 {
    let number = |text: String| text.parse().unwrap_or_else(|_| panic!("{name}={text} is not a whole number"));
    std::env::var(name).map_or(otherwise, number)
}

/// With the fixed seed, every run has the same cases.
fn config() -> ProptestConfig {
    let (rng_seed, failure_persistence) = (RngSeed::Fixed(2003), None);
    ProptestConfig { cases: 400, failure_persistence, rng_seed, ..ProptestConfig::default() }
}

/// Checks that all variants return the correctly rounded `t` of the nearest hit.
///
/// If several primitives have the same exact `t`, the variants must return the lowest primitive number.
fn all_are_exact(mesh: &Arc<Mesh>, rays: &[Ray]) -> Result<(), TestCaseError> {
    let exact: Vec<Option<(f32, u32)>> =
        rays.iter().map(|ray| oracle::nearest(ray, mesh).map(|truth| truth.first())).collect();
    for structure in VARIANTS {
        let accel = built(structure, mesh);
        for ((ray, exact), hit) in rays.iter().zip(&exact).zip(accel.closest(rays)) {
            prop_assert_eq!(hit.map(|h| (h.t, h.prim.index())), *exact, "{:?}: ray \"{}\"", structure, ray);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    /// Tests ray intervals with bounds at hits and at multiples of 1/2. On this grid, `t` is a fraction with a small
    /// denominator. Such a `t` rounds to a multiple of 1/2 only if it is this multiple.
    #[test]
    fn on_an_integer_grid_every_structure_is_exact_and_intervals_are_half_open(
        mesh in meshes(integers(), 60),
        rays in rays(integers(), 30),
        ends in (0_u8..6, 0_u8..6),
    ) {
        let mut windowed = rays.clone();
        for ray in &rays {
            windowed.push(Ray { t_min: f32::from(ends.0) / 2.0, t_max: f32::from(ends.1) / 2.0, ..*ray });
            // Skip hits whose exact `t` is not a float, because interval bounds are floats.
            let Some(t) = oracle::nearest(ray, &mesh).map(|truth| truth.t) else { continue };
            if t.compare(t.round()) == Some(std::cmp::Ordering::Equal) {
                let (at, behind) = (t.round(), t.round().next_up());
                windowed.extend([at, behind].map(|t_max| ray.until(t_max)));
                windowed.extend([at, behind].map(|t_min| Ray { t_min, ..*ray }));
            }
        }
        all_are_exact(&mesh, &windowed)?;
    }

    /// Scaling the mesh and the rays by a power of two must not change the hits.
    #[test]
    fn powers_of_two_change_nothing(mesh in meshes(-2.0_f32..2.0, 40), rays in rays(-2.0_f32..2.0, 40), k in -12_i32..12) {
        let scale = libm::scalbnf(1.0, k);
        let positions = mesh.positions().iter().map(|p| *p * scale).collect();
        let scaled = Arc::new(Mesh::new(positions, mesh.triangles().to_vec()).unwrap());
        let far: Vec<Ray> = rays.iter().map(|r| Ray { origin: r.origin * scale, direction: r.direction * scale, ..*r }).collect();
        for structure in VARIANTS {
            let [here, there] = [(&mesh, &rays), (&scaled, &far)].map(|(mesh, rays)| built(structure, mesh).closest(rays));
            prop_assert_eq!(here, there, "{:?}", structure);
        }
    }

    #[test]
    fn a_ray_reads_back_from_its_text(bits in any::<[u32; 8]>()) {
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = bits.map(f32::from_bits);
        let ray = Ray { origin: Vec3::new(ox, oy, oz), t_min, direction: Vec3::new(dx, dy, dz), t_max };
        let back: Ray = ray.to_string().parse().unwrap();
        prop_assert_eq!(back.to_string(), ray.to_string());
        if !bits.map(f32::from_bits).iter().any(|x| x.is_nan()) {
            prop_assert_eq!(back, ray);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: from_environment("SAHARA_FUZZ_CASES", 40),
        rng_seed: RngSeed::Fixed(from_environment("SAHARA_FUZZ_SEED", 2003).into()),
        ..config()
    })]

    #[test]
    fn anything_is_answered_right(case in cases()) {
        if let Err(report) = case.check() {
            prop_assert!(false, "{}", report);
        }
    }
}
