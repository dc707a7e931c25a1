//! Trace times, one thread, in rays a second: `cargo bench --bench traverse -- dragon`.

mod common;

use std::borrow::Cow;
use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sahara::accel::{Loaded, Query};
use sahara::registry::Registry;
use sahara::scene::{Sampling, Scene, Workload, WorkloadKind};

const KINDS: [WorkloadKind; 4] =
    [WorkloadKind::Primary, WorkloadKind::Shadow, WorkloadKind::Diffuse, WorkloadKind::Random];

/// Enough rays for a sample, few enough that even the median tree ends.
const RAYS: usize = 16_384;

/// Rays of a slice whose nodes are not all at hand when it is answered again.
const SLICE: usize = 262_144;

fn workloads(scene: &Scene, limit: usize) -> Vec<Workload> {
    let caster =
        Registry::builtin().choose("sah-kd").expect("a registered name").build(&scene.mesh).expect("it builds");
    let sampling = Sampling { limit, ..Sampling::of(scene) };
    KINDS.iter().map(|&kind| Workload::new(scene, kind, &sampling, &*caster)).collect()
}

fn trace(loaded: &dyn Loaded, query: Query, rays: usize) -> usize {
    match query {
        Query::Closest => {
            let mut hits = vec![None; rays];
            loaded.closest_hits(&mut hits);
            hits.iter().flatten().count()
        }
        Query::Any => {
            let mut hits = vec![false; rays];
            loaded.any_hits(&mut hits);
            hits.iter().filter(|&&hit| hit).count()
        }
    }
}

fn traverse(criterion: &mut Criterion) {
    for scene in common::scenes() {
        let workloads = workloads(&scene, RAYS);
        for choice in common::structures(&scene.mesh) {
            let accel = choice.build(&scene.mesh).expect("a valid mesh builds");
            for workload in workloads.iter().filter(|workload| !workload.rays.is_empty()) {
                let name = format!("traverse/{}/{}", scene.name.to_lowercase(), workload.name);
                let mut group = criterion.benchmark_group(name);
                group.sample_size(10).throughput(Throughput::Elements(workload.rays.len() as u64));
                let (loaded, rays) = (accel.load(Cow::Borrowed(&workload.rays)), workload.rays.len());
                group.bench_function(choice.label.as_str(), |bencher| {
                    bencher.iter(|| black_box(trace(black_box(&*loaded), workload.query, rays)));
                });
                group.finish();
            }
        }
    }
}

/// The ways to answer a slice: `cargo bench --bench traverse -- slices/lucy`.
fn slices(criterion: &mut Criterion) {
    for name in ["dragon", "lucy"] {
        let scene = common::scene(name);
        let workloads = workloads(&scene, SLICE);
        for batch in ["single", "packets", "interleaved"] {
            let spec = format!("sah-hybrid:test=moller-trumbore,batch={batch}");
            let choice = Registry::builtin().choose(&spec).expect("registered names");
            let accel = choice.build(&scene.mesh).expect("a valid mesh builds");
            for workload in &workloads {
                let mut group = criterion.benchmark_group(format!("slices/{name}/{}", workload.name));
                group.sample_size(10).throughput(Throughput::Elements(workload.rays.len() as u64));
                let (loaded, rays) = (accel.load(Cow::Borrowed(&workload.rays)), workload.rays.len());
                group.bench_function(batch, |bencher| {
                    bencher.iter(|| black_box(trace(black_box(&*loaded), workload.query, rays)));
                });
                group.finish();
            }
        }
    }
}

criterion_group!(benches, traverse, slices);
criterion_main!(benches);
