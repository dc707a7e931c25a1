//! Properties that hold for every mesh and ray, tried on generated ones.

use std::sync::Arc;

use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use sahara::accel::DynAccel;
use sahara::geometry::{Hit, Mesh, Ray};
use sahara::oracle;
use sahara::registry::Registry;
use sahara::validate::{Reference, validate};

/// The structures of this crate; small leaves, so that small meshes make deep trees.
const OURS: [&str; 6] = [
    "brute-force",
    "median-kd",
    "median-kd:leaf=1,threshold=1",
    "median-kd:leaf=2,threshold=1,traversal=plane-intervals,mailbox=true",
    "sah-kd",
    "sah-kd:intersection_cost=50,traversal=child-boxes",
];

fn built(spec: &str, mesh: &Arc<Mesh>) -> Box<dyn DynAccel> {
    Registry::builtin().choose(spec).unwrap().build(mesh).unwrap()
}

fn closest(accel: &dyn DynAccel, rays: &[Ray]) -> Vec<Option<Hit>> {
    let mut hits = vec![None; rays.len()];
    accel.closest_hits(rays, &mut hits);
    hits
}

/// A triangle mesh with corners that `number` makes, most triangles sharing corners with others.
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

/// Small integers of both signs of zero: on them Möller-Trumbore does not round but in its one division.
fn integers() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![9 => (-4_i8..=4).prop_map(f32::from), 1 => Just(-0.0_f32)]
}

/// What floats are made of: a coarse grid, zeros, denormals, powers of two, anything moderate.
fn floats() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![
        4 => (-16_i8..=16).prop_map(|k| f32::from(k) / 8.0),
        4 => -2.0_f32..2.0,
        1 => prop::sample::select(vec![0.0_f32, -0.0, 1e-45, -1e-40, f32::MIN_POSITIVE]),
        1 => (-40_i32..40, any::<bool>()).prop_map(|(k, minus)| libm::scalbnf(if minus { -1.0 } else { 1.0 }, k)),
    ]
}

/// Every finite float, whatever its size.
fn any_finite() -> impl Strategy<Value = f32> + Clone {
    any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |x| x.is_finite())
}

/// The same cases on every run.
fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 400,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(2003),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config())]

    /// Not brute force but the exact oracle judges: nearest `t`, correctly rounded, and the lowest number there.
    #[test]
    fn on_an_integer_grid_every_structure_is_exact(mesh in meshes(integers(), 60), rays in rays(integers(), 40)) {
        let exact: Vec<Option<(f32, u32)>> =
            rays.iter().map(|ray| oracle::nearest(ray, &mesh).map(|(t, ids)| (t.round(), ids[0]))).collect();
        for spec in OURS {
            let accel = built(spec, &mesh);
            for ((ray, exact), hit) in rays.iter().zip(&exact).zip(closest(&*accel, &rays)) {
                prop_assert_eq!(hit.map(|h| (h.t, h.prim.index())), *exact, "{}: ray \"{}\"", spec, ray);
            }
        }
    }

    /// The ends of the interval fall on hits, again exactly.
    #[test]
    fn on_an_integer_grid_intervals_are_half_open(
        mesh in meshes(integers(), 40),
        rays in rays(integers(), 20),
        ends in (0_u8..6, 0_u8..6),
    ) {
        let window = |ray: &Ray| Ray { t_min: f32::from(ends.0) / 2.0, t_max: f32::from(ends.1) / 2.0, ..*ray };
        let rays: Vec<Ray> = rays.iter().map(window).collect();
        for spec in OURS {
            let accel = built(spec, &mesh);
            for (ray, hit) in rays.iter().zip(closest(&*accel, &rays)) {
                // A quotient that is not a half may round onto an end: exact halves only.
                let Some((t, ids)) = oracle::nearest(ray, &mesh) else { continue };
                if t.compare(t.round()) == Some(std::cmp::Ordering::Equal) {
                    let found = hit.map(|h| (h.t, h.prim.index()));
                    prop_assert_eq!(found, Some((t.round(), ids[0])), "{}: ray \"{}\"", spec, ray);
                }
            }
        }
    }

    #[test]
    fn no_structure_loses_or_invents_a_hit(mesh in meshes(floats(), 60), rays in rays(floats(), 60)) {
        let reference = Reference::of_test("moller-trumbore", &mesh).unwrap();
        for spec in OURS {
            let v = validate(&*built(spec, &mesh), &reference, &mesh, &rays);
            prop_assert_eq!(v.errors() + v.higher_ids, 0, "{}: {:?}", spec, v.worst.first().map(ToString::to_string));
        }
    }

    #[test]
    fn no_size_of_numbers_breaks_a_structure(mesh in meshes(any_finite(), 30), rays in rays(any_finite(), 30)) {
        let reference = Reference::of_test("moller-trumbore", &mesh).unwrap();
        for spec in OURS {
            let v = validate(&*built(spec, &mesh), &reference, &mesh, &rays);
            prop_assert_eq!(v.errors() + v.higher_ids, 0, "{}: {:?}", spec, v.worst.first().map(ToString::to_string));
        }
    }

    /// Scaling by a power of two scales nothing but the coordinates: the same `t`, the same primitive, to the bit.
    #[test]
    fn powers_of_two_change_nothing(mesh in meshes(-2.0_f32..2.0, 40), rays in rays(-2.0_f32..2.0, 40), k in -12_i32..12) {
        let scale = libm::scalbnf(1.0, k);
        let positions = mesh.positions().iter().map(|p| *p * scale).collect();
        let scaled = Arc::new(Mesh::new(positions, mesh.triangles().to_vec()).unwrap());
        let far: Vec<Ray> = rays.iter().map(|r| Ray { origin: r.origin * scale, direction: r.direction * scale, ..*r }).collect();
        for spec in OURS {
            prop_assert_eq!(closest(&*built(spec, &mesh), &rays), closest(&*built(spec, &scaled), &far), "{}", spec);
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
