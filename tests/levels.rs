//! Hits and traversal counts must be the same on all SIMD levels.
//!
//! Packets and interleaved rays must have the same hits as single rays.
//!
//! Each test runs in a separate process, because each test sets the SIMD level of the whole process.

use std::io::Write;
use std::sync::Arc;

use glam::Vec3;
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;
use sahara::accel::{Counts, DynAccel};
use sahara::builtin::Builtin;
use sahara::geometry::{Hit, Mesh, Ray};
use sahara::registry::Registry;
use sahara::request::known_defect;
use sahara::scene::{Sampling, Scene, Workload, WorkloadKind};
use sahara::simd::Level;
use sahara::validate::{Stratum, degenerate_meshes};

use crate::alone::alone;

/// The closest hit and the any-hit result of a ray.
type Answer = (Option<(u32, u32)>, bool);

fn answers(closest: Vec<Option<Hit>>, any: Vec<bool>) -> Vec<Answer> {
    let bits = |hit: Hit| (hit.t.to_bits(), hit.prim.index());
    closest.into_iter().map(|hit| hit.map(bits)).zip(any).collect()
}

fn traced(accel: &dyn DynAccel, rays: &[Ray]) -> Vec<Answer> {
    answers(accel.closest(rays), accel.any(rays))
}

fn counted(accel: &dyn DynAccel, rays: &[Ray]) -> (Vec<Answer>, [Counts; 2]) {
    let (mut closest, mut any) = (vec![None; rays.len()], vec![false; rays.len()]);
    let mut counts = [Counts::default(); 2];
    accel.closest_hits_counted(rays, &mut closest, &mut counts[0]);
    accel.any_hits_counted(rays, &mut any, &mut counts[1]);
    let answers = answers(closest, any);
    assert_eq!(traced(accel, rays), answers, "counting changes a hit");
    (answers, counts)
}

fn scene(name: &str) -> Scene {
    Builtin::find(name).unwrap().scene(None).unwrap()
}

#[test]
fn all_levels_return_the_same() {
    if !alone("levels::all_levels_return_the_same") {
        return;
    }
    let mut meshes: Vec<(String, Arc<Mesh>)> = degenerate_meshes();
    meshes.extend(["teapot", "cornellbox"].map(|name| (name.into(), scene(name).mesh)));
    let registry = Registry::builtin();
    let levels = Level::available();
    if let [level] = &levels[..] {
        // Write to stderr directly, because the test harness captures the output of `eprint!`.
        let note = format!("\nwarning: this machine or build has only the level {level}: levels are not compared\n");
        std::io::stderr().write_all(note.as_bytes()).expect("a sentence is written");
    }
    let mut hits = 0;
    for choice in registry.all().iter().filter(|choice| known_defect(&choice.entry.name).is_none()) {
        for (name, mesh) in &meshes {
            let rays: Vec<Ray> = Stratum::ALL.into_iter().flat_map(|stratum| stratum.rays(mesh, 5, 7)).collect();
            let accel = choice.build(mesh).unwrap();
            levels[0].choose();
            let first = counted(&*accel, &rays);
            for level in &levels[1..] {
                level.choose();
                let other = counted(&*accel, &rays);
                assert_eq!(first, other, "{} on {name}: {} and {level} differ", choice.label, levels[0]);
            }
            hits += first.0.iter().filter(|(_, any)| *any).count();
        }
    }
    assert!(hits > 20_000, "too few hits for a meaningful test: {hits}");
}

/// Adversarial rays, then these rays sorted by direction octant, then groups of sixteen similar rays.
fn bundles(mesh: &Mesh) -> Vec<Ray> {
    let mixed: Vec<Ray> = Stratum::ALL.into_iter().flat_map(|stratum| stratum.rays(mesh, 6, 5)).collect();
    let mut sorted = mixed.clone();
    sorted.sort_by_key(|ray| ray.direction.to_array().map(f32::is_sign_negative));
    // If `is_equal` is false, the directions of a group have very different lengths. Error bounds may then decide the
    // hits of long directions, but not the hits of short directions.
    let neighbours = |is_equal: bool| {
        let step = move |i: u32, ray: &Ray| {
            let longer = if is_equal { 1.0 } else { (3.0 * i as f32).exp2() };
            let direction = ray.direction * (1.0 + i as f32 * 1e-3) / longer;
            let end = if i < 5 { 1.0 + i as f32 * 0.1 } else { f32::INFINITY };
            Ray { direction, t_min: if i > 12 { 0.25 * longer } else { 0.0 }, ..*ray }.until(end * longer)
        };
        mixed.iter().step_by(5).flat_map(move |ray| (0..16).map(move |i| step(i, ray))).collect::<Vec<_>>()
    };
    [mixed.clone(), sorted, neighbours(true), neighbours(false)].concat()
}

/// Triangles with corners on a coarse grid. Rays often hit several triangles at the same `t`.
fn coarse() -> Arc<Mesh> {
    let mut random = Pcg32::seed_from_u64(8);
    let mut corner = || Vec3::from_array(std::array::from_fn(|_| (random.next_u32() % 4) as f32 - 1.0));
    let positions = (0..3 * 300).map(|_| corner()).collect();
    Arc::new(Mesh::new(positions, (0..300).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()).unwrap())
}

/// Groups of sixteen rays. The rays of a group share the origin and the direction octant.
fn from_the_grid() -> Vec<Ray> {
    let mut random = Pcg32::seed_from_u64(9);
    let mut rays = vec![];
    for _ in 0..300 {
        let mut some = |n: u32| (random.next_u32() % n) as f32;
        let origin = Vec3::new(some(4) - 1.0, some(4) - 1.0, some(4) - 1.0);
        let signs = [(); 3].map(|()| 2.0 * some(2) - 1.0);
        for _ in 0..16 {
            let ray = Ray::new(origin, Vec3::from_array(signs.map(|sign| sign * (1.0 + some(3)))));
            rays.push(if some(3) == 0.0 { ray.until(1.0 + some(2)) } else { ray });
        }
    }
    rays
}

#[test]
fn packets_and_interleaved_rays_return_what_single_rays_do() {
    if !alone("levels::packets_and_interleaved_rays_return_what_single_rays_do") {
        return;
    }
    let registry = Registry::builtin();
    let with_bundles = |(name, mesh): (String, Arc<Mesh>)| (name, bundles(&mesh), mesh);
    let mut cases: Vec<(String, Vec<Ray>, Arc<Mesh>)> = degenerate_meshes().into_iter().map(with_bundles).collect();
    cases.push(("a coarse grid".into(), from_the_grid(), coarse()));
    for scene in ["teapot", "cornellbox", "dragon"].map(scene) {
        let reference = registry.choose("sah-kd").unwrap().build(&scene.mesh).unwrap();
        let sampling = Sampling::some(&scene, 300, 3);
        let mut rays = bundles(&scene.mesh);
        for kind in [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse] {
            rays.extend(Workload::new(&scene, kind, &sampling, &*reference).rays);
        }
        cases.push((scene.name, rays, scene.mesh));
    }

    let mut hits = 0;
    for structure in [
        "sah-kd-wide:test=moller-trumbore",
        "sah-kd-tight:test=exact",
        "sah-hybrid:test=moller-trumbore",
        "sah-hybrid:test=exact",
        "sah-bvh:test=watertight",
    ] {
        let build = |spec: &str, mesh| registry.choose(spec).unwrap().build(mesh).unwrap();
        for (name, rays, mesh) in &cases {
            let single = traced(&*build(structure, mesh), rays);
            let together = build(&format!("{structure},batch=packets"), mesh);
            // Rays are interleaved only in large trees. The Dragon must therefore have a large tree.
            assert!(name != "Dragon" || together.footprint().total() > 3 << 20, "{structure}");
            for level in Level::available() {
                level.choose();
                let found = traced(&*together, rays);
                if let Some(i) = (0..rays.len()).find(|&i| found[i] != single[i]) {
                    let (ray, found, single) = (rays[i], found[i], single[i]);
                    panic!("{structure}, {level}, on {name}: {ray:?} gives {found:?}, alone {single:?}");
                }
            }
            hits += single.iter().filter(|(_, any)| *any).count();
        }
    }
    assert!(hits > 20_000, "too few hits for a meaningful test: {hits}");
}
