//! Rays of a slice get the same hits with `batch=packets` as one by one, bit for bit, on every instruction set.
//!
//! In a process of its own, because the level is that of the process.

use std::sync::Arc;

use glam::Vec3;
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;
use sahara::accel::DynAccel;
use sahara::geometry::{Hit, Mesh, Ray};
use sahara::registry::Registry;
use sahara::scene::{Builtin, Sampling, Workload, WorkloadKind};
use sahara::simd::Level;
use sahara::validate::{Stratum, degenerate_meshes};

use crate::alone::alone;

/// Adversarial rays, in such an order that packets of one octant come about, and the same in the order they were made.
fn bundles(mesh: &Mesh) -> Vec<Ray> {
    let mixed: Vec<Ray> = Stratum::ALL.into_iter().flat_map(|stratum| stratum.rays(mesh, 16, 5)).collect();
    let mut sorted = mixed.clone();
    sorted.sort_by_key(|ray| ray.direction.to_array().map(f32::is_sign_negative));
    // Rays that differ by little, with ends that cut through the scene.
    let neighbours = mixed.iter().step_by(5).flat_map(|ray| {
        let step = |i: u32| {
            let direction = ray.direction * (1.0 + i as f32 * 1e-3);
            let end = if i < 5 { 1.0 + i as f32 * 0.1 } else { f32::INFINITY };
            Ray { direction, t_min: if i > 12 { 0.25 } else { 0.0 }, ..*ray }.until(end)
        };
        (0..16).map(step)
    });
    let near: Vec<Ray> = neighbours.collect();
    // The same with directions of very different lengths: what is certain of the longest is not of the others.
    let unequal = near.iter().enumerate().map(|(i, ray)| {
        let longer = (3.0 * (i % 16) as f32).exp2();
        Ray { direction: ray.direction / longer, t_min: ray.t_min * longer, ..*ray }.until(ray.t_max * longer)
    });
    let unequal: Vec<Ray> = unequal.collect();
    [mixed, sorted, near, unequal].concat()
}

/// Triangles on a coarse grid, so that many are hit at once, at 0 and -0, on edges, and by rays that lie in them.
fn coarse() -> Arc<Mesh> {
    let mut random = Pcg32::seed_from_u64(8);
    let mut corner = || Vec3::from_array(std::array::from_fn(|_| (random.next_u32() % 4) as f32 - 1.0));
    let positions = (0..3 * 300).map(|_| corner()).collect();
    Arc::new(Mesh::new(positions, (0..300).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()).unwrap())
}

/// Sixteen rays at a time from a point of the grid, in directions of one octant; some end at a point of the grid.
fn from_the_grid() -> Vec<Ray> {
    let mut random = Pcg32::seed_from_u64(9);
    let mut rays = vec![];
    for _ in 0..1_000 {
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

fn bits(accel: &dyn DynAccel, rays: &[Ray]) -> (Vec<Option<(u32, u32)>>, Vec<bool>) {
    let bits = |hit: Option<Hit>| hit.map(|hit| (hit.t.to_bits(), hit.prim.index()));
    (accel.closest(rays).into_iter().map(bits).collect(), accel.any(rays))
}

#[test]
fn rays_in_packets_get_the_hits_of_single_rays() {
    if !alone("packets::rays_in_packets_get_the_hits_of_single_rays") {
        return;
    }
    let registry = Registry::builtin();
    let mut cases: Vec<(String, Arc<Mesh>, Vec<Ray>)> = vec![];
    for (name, mesh) in degenerate_meshes() {
        let rays = bundles(&mesh);
        cases.push((name, mesh, rays));
    }
    cases.push(("a coarse grid".into(), coarse(), from_the_grid()));
    for name in ["teapot", "cornellbox", "dragon"] {
        let scene = Builtin::find(name).unwrap().scene(None).unwrap();
        let caster = registry.choose("sah-kd").unwrap().build(&scene.mesh).unwrap();
        let sampling = Sampling::some(&scene, 1_000, 3);
        let mut rays = bundles(&scene.mesh);
        for kind in [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse] {
            rays.extend(Workload::new(&scene, kind, &sampling, &*caster).rays);
        }
        cases.push((name.into(), scene.mesh, rays));
    }

    let mut hits = 0;
    let structures = [
        ("sah-kd-wide", &["moller-trumbore"][..]),
        ("sah-kd-tight", &["exact"]),
        ("sah-hybrid", &["moller-trumbore", "exact"]),
        ("sah-bvh", &["watertight"]),
    ];
    for (structure, tests) in structures {
        for test in tests {
            let choose = |keys: &str| registry.choose(&format!("{structure}:test={test}{keys}")).unwrap();
            for (name, mesh, rays) in &cases {
                let single = choose("").build(mesh).unwrap();
                let right = bits(&*single, rays);
                let packets = choose(",batch=packets").build(mesh).unwrap();
                for level in Level::available() {
                    level.choose();
                    let found = bits(&*packets, rays);
                    let wrong = (0..rays.len()).find(|&i| found.0[i] != right.0[i] || found.1[i] != right.1[i]);
                    if let Some(i) = wrong {
                        panic!(
                            "{structure} over {test}, {level}, on {name}: {:?} gives {:?} and {}, alone {:?} and {}",
                            rays[i], found.0[i], found.1[i], right.0[i], right.1[i]
                        );
                    }
                }
                hits += right.1.iter().filter(|&&hit| hit).count();
            }
        }
    }
    assert!(hits > 20_000, "too few hits to prove anything: {hits}");
}
