//! Benchmarks that build acceleration structures on all threads of the machine: `cargo bench --bench build -- dragon`.

mod common;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};

fn build(criterion: &mut Criterion) {
    let scenes = common::scenes();
    common::announce("build", &scenes);
    for scene in scenes {
        let mut group = criterion.benchmark_group(format!("build/{}", scene.name.to_lowercase()));
        group.sample_size(10).throughput(Throughput::Elements(scene.mesh.len() as u64));
        for choice in common::structures(&scene.mesh) {
            // `iter_batched` does not measure the drop of the tree.
            group.bench_function(choice.label.as_str(), |bencher| {
                bencher.iter_batched(
                    || (),
                    |()| choice.build(&scene.mesh).expect("a valid mesh builds"),
                    BatchSize::PerIteration,
                );
            });
        }
        group.finish();
    }
}

criterion_group!(benches, build);
criterion_main!(benches);
