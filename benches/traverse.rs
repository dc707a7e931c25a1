//! Benchmarks of traversals on one thread: `cargo bench --bench traverse -- dragon`.

mod common;

use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sahara::accel::DynAccel;
use sahara::measure::{CpuClock, Pass, Stopwatch, SystemClock, Threads, Timed};
use sahara::registry::Registry;
use sahara::scene::{Sampling, Scene, Workload};

fn workloads(scene: &Scene) -> Vec<Workload> {
    let ray_source =
        Registry::builtin().choose("sah-kd").expect("a registered name").build(&scene.mesh).expect("it builds");
    let sampling = Sampling { seed: 1, ..Sampling::of(scene) };
    let workloads = common::KINDS.iter().map(|&kind| Workload::new(scene, kind, &sampling, &*ray_source));
    workloads.filter(|workload| !workload.rays.is_empty()).collect()
}

/// Uses the same warm-up and the same clock as `sahara compare`.
fn bench(criterion: &mut Criterion, group: &str, name: &str, accel: &dyn DynAccel, workload: &Workload) {
    let threads = Threads::pinned(1).expect("there is a thread");
    let _pin = threads.pin();
    let (system, own) = (SystemClock::start(), CpuClock::Thread.on(&threads));
    let watch = Stopwatch::new(own.as_ref().map_or(&system, |own| own));
    let mut pass = Pass::new(accel, &workload.rays, workload.query, &threads);
    let mut group = criterion.benchmark_group(format!("{group}/{}", workload.name));
    group.sample_size(10).throughput(Throughput::Elements(workload.rays.len() as u64));
    group.bench_function(name, |bencher| {
        bencher.iter_custom(|passes| {
            let one = |_| {
                pass.clear();
                pass.lead_in();
                Duration::from_nanos(pass.run(&watch)[0])
            };
            (0..passes).map(one).sum()
        });
    });
    group.finish();
}

fn traverse(criterion: &mut Criterion) {
    let scenes = common::scenes();
    common::announce("traverse", &scenes);
    for scene in scenes {
        let workloads = workloads(&scene);
        for choice in common::structures(&scene.mesh) {
            let accel = choice.build(&scene.mesh).expect("a valid mesh builds");
            for workload in &workloads {
                let group = format!("traverse/{}", scene.name.to_lowercase());
                bench(criterion, &group, &choice.label, accel.as_ref(), workload);
            }
        }
    }
}

/// Compares traversals of single rays with traversals of packets: `cargo bench --bench traverse -- slices/lucy`.
fn slices(criterion: &mut Criterion) {
    for name in common::SLICED {
        let scene = common::scene(name);
        let workloads = workloads(&scene);
        for batch in common::BATCHES {
            let spec = format!("sah-hybrid:test=moller-trumbore,batch={batch}");
            let choice = Registry::builtin().choose(&spec).expect("registered names");
            let accel = choice.build(&scene.mesh).expect("a valid mesh builds");
            for workload in &workloads {
                bench(criterion, &format!("slices/{name}"), batch, accel.as_ref(), workload);
            }
        }
    }
}

criterion_group!(benches, traverse, slices);
criterion_main!(benches);
