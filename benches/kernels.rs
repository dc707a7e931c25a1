//! Benchmarks of triangle tests and of observers: `cargo bench --bench kernels`.
//!
//! A traversal uses explicit SIMD instructions only with the observer `()`. The group `kernels/observer` therefore
//! overstates the cost of an observer.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use sahara::accel::{Accel, Counts, Observer};
use sahara::builtin::Builtin;
use sahara::geometry::Ray;
use sahara::kdtree::{KdConfig, KdTree};
use sahara::registry::Registry;
use sahara::scene::{Sampling, Workload, WorkloadKind};
use sahara::simd::{EightLanes, Kernel, Lanes, Level, Portable, dispatch};
use sahara::triangle::{
    BaldwinWeber, EdgeF64, Exact, MollerTrumbore, MollerTrumboreF64, Plucker, TriangleTest, Watertight,
};

fn triangles() -> Vec<[Vec3; 3]> {
    let corner = |i: u32| {
        let turn = |k: u32| (i.wrapping_mul(k) % 1009) as f32 / 504.5 - 1.0;
        Vec3::new(turn(271), turn(577), turn(911))
    };
    (0..512).map(|i| [corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)]).collect()
}

fn test_all<T: TriangleTest, const N: usize, L: Lanes<N>>(ray: &Ray, blocks: &[T::Block<N>]) -> usize {
    let prepared = T::prepare(ray);
    let hits = |block| {
        let (candidates, first) = T::candidates::<N, L>(&prepared, block, 0.0, f32::MAX);
        if candidates == 0 {
            return 0;
        }
        let values = T::values::<N, L>(first);
        let hit = |lane| T::decide(&prepared, block, lane, &values).is_some();
        (0..N).filter(|&lane| candidates >> lane & 1 == 1 && hit(lane)).count()
    };
    blocks.iter().map(hits).sum()
}

struct Eight<'a, T: TriangleTest>(&'a Ray, &'a [T::Block<8>]);

impl<T: TriangleTest> Kernel for Eight<'_, T> {
    type Output = usize;

    #[inline(always)]
    fn run<L: EightLanes>(self) -> usize {
        test_all::<T, 8, L>(self.0, self.1)
    }
}

fn triangle_test<T: TriangleTest>(criterion: &mut Criterion) {
    let triangles = triangles();
    let ray = Ray::new(Vec3::new(0.1, 0.2, -3.0), Vec3::new(0.02, -0.05, 1.0));
    let mut group = criterion.benchmark_group(format!("kernels/{}", T::NAME));
    group.throughput(Throughput::Elements(triangles.len() as u64));
    let single: Vec<_> = triangles.chunks(1).map(T::block::<1>).collect();
    group.bench_function("scalar", |bencher| {
        bencher.iter(|| black_box(test_all::<T, 1, Portable<1>>(black_box(&ray), black_box(&single))));
    });
    let blocks: Vec<_> = triangles.chunks(8).map(T::block::<8>).collect();
    for level in Level::available() {
        group.bench_function(format!("x8-{level}"), |bencher| {
            bencher.iter(|| black_box(dispatch(level, Eight::<T>(black_box(&ray), black_box(&blocks)))));
        });
    }
    group.finish();
}

fn triangle_tests(criterion: &mut Criterion) {
    triangle_test::<MollerTrumbore>(criterion);
    triangle_test::<Watertight>(criterion);
    triangle_test::<BaldwinWeber>(criterion);
    triangle_test::<Plucker>(criterion);
    triangle_test::<MollerTrumboreF64>(criterion);
    triangle_test::<EdgeF64>(criterion);
    triangle_test::<Exact>(criterion);
}

/// Unlike the observer `()`, this observer has `ACTIVE = true`.
struct Silent;

impl Observer for Silent {}

fn observer(criterion: &mut Criterion) {
    let scene = Builtin::find("teapot").and_then(|b| b.scene(None)).expect("built-in scenes are valid");
    let tree = <KdTree<MollerTrumbore> as Accel>::build(&Arc::clone(&scene.mesh), &KdConfig::SAH).expect("it builds");
    let ray_source =
        Registry::builtin().choose("sah-kd").expect("a registered name").build(&scene.mesh).expect("it builds");
    let sampling = Sampling { limit: 16_384, ..Sampling::of(&scene) };
    let rays = Workload::new(&scene, WorkloadKind::Primary, &sampling, &*ray_source).rays;
    let mut group = criterion.benchmark_group("kernels/observer");
    group.throughput(Throughput::Elements(rays.len() as u64));
    let mut hits = vec![None; rays.len()];
    group.bench_function("unit", |b| b.iter(|| tree.closest_hits(black_box(&rays), &mut hits, &mut ())));
    group.bench_function("silent", |b| b.iter(|| tree.closest_hits(black_box(&rays), &mut hits, &mut Silent)));
    group.bench_function("counts", |b| {
        b.iter(|| tree.closest_hits(black_box(&rays), &mut hits, &mut Counts::default()))
    });
    group.finish();
}

criterion_group!(benches, triangle_tests, observer);
criterion_main!(benches);
