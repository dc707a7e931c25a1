use std::sync::Arc;

use glam::Vec3;
use rand_core::{RngCore, SeedableRng};

use super::node::Limits;
use super::plan::{Plan, plan};
use super::*;
use crate::accel::{Accel, BuildError, Counts};
use crate::brute_force::BruteForce;
use crate::geometry::{Mesh, Ray};
use crate::traversal::pages;
use crate::triangle::MollerTrumbore;

type Tree = KdTree<MollerTrumbore>;

fn unit(rng: &mut rand_pcg::Pcg32) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|_| rng.next_u32() as f32 / u32::MAX as f32 * 2.0 - 1.0))
}

/// Triangles of very different sizes, so that many straddle.
fn soup(count: usize, seed: u64) -> Arc<Mesh> {
    let mut rng = rand_pcg::Pcg32::seed_from_u64(seed);
    let mut positions = vec![];
    for i in 0..count {
        let (centre, size) = (unit(&mut rng) * 4.0, if i % 10 == 0 { 3.0 } else { 0.2 });
        positions.extend((0..3).map(|_| centre + unit(&mut rng) * size));
    }
    let triangles = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Arc::new(Mesh::new(positions, triangles).unwrap())
}

fn rays(count: usize, seed: u64) -> Vec<Ray> {
    let mut rng = rand_pcg::Pcg32::seed_from_u64(seed);
    (0..count).map(|_| Ray::new(unit(&mut rng) * 6.0, unit(&mut rng))).collect()
}

fn configs() -> Vec<KdConfig> {
    let report = KdConfig { leaf: 8, ..KdConfig::REPORT };
    vec![
        report,
        KdConfig { axis: AxisRule::Longest, median: Median::Mean, limit: Limit::AtMost, ..report },
        KdConfig { median: Median::Welded, equal: Equal::Below, count: CountOf::Child, ..report },
        KdConfig { mailbox: true, traversal: Traversal::PlaneIntervals, ..report },
        KdConfig::SAH,
        KdConfig { traversal: Traversal::ChildBoxes, ..KdConfig::SAH },
        KdConfig { stop: Stop::Report, leaf: 6, ..KdConfig::SAH },
        KdConfig { stop: Stop::Leaf, leaf: 8, ..KdConfig::SAH },
        KdConfig { plane: Plane::SahBinned, ..KdConfig::SAH },
        KdConfig { plane: Plane::SpatialMedian, stop: Stop::Leaf, axis: AxisRule::Longest, ..report },
        KdConfig { plane: Plane::SpatialMedian, stop: Stop::Sah, ..KdConfig::REPORT },
        KdConfig { plane: Plane::CentroidMedian, axis: AxisRule::Longest, ..report },
        KdConfig { plane: Plane::CentroidMedian, median: Median::Mean, stop: Stop::Sah, ..KdConfig::REPORT },
        KdConfig { stop: Stop::Sah, ..KdConfig::REPORT },
    ]
}

#[test]
fn every_configuration_answers_as_brute_force() {
    let mesh = soup(600, 5);
    let reference = <BruteForce<MollerTrumbore> as Accel>::build(&mesh, &Default::default()).unwrap();
    let rays = rays(4000, 6);
    for config in configs() {
        let tree = Tree::build(&mesh, &config).unwrap();
        for ray in &rays {
            let expected = reference.closest_hit(ray, &mut ());
            assert_eq!(tree.closest_hit(ray, &mut ()), expected, "{config:?} {ray:?}");
            assert_eq!(tree.any_hit(ray, &mut ()), expected.is_some(), "{config:?} {ray:?}");
        }
    }
}

/// A small mesh on a large floor: the first cuts in the middle part nothing from it but space and the floor's two triangles.
#[test]
fn the_middle_of_a_cell_finds_a_small_mesh_on_a_large_floor() {
    let mut rng = rand_pcg::Pcg32::seed_from_u64(9);
    let mesh_point = |i: usize| Vec3::new((i / 3) as f32 / 500.0, 0.0, 0.0);
    let mut positions: Vec<Vec3> = (0..1500).map(|i| mesh_point(i) + unit(&mut rng) * 0.01).collect();
    let floor = [[-9.0, -7.0], [10.0, -7.0], [-9.0, 8.0], [10.0, 8.0]];
    positions.extend(floor.map(|[x, z]| Vec3::new(x, 0.0, z)));
    let mut triangles: Vec<[u32; 3]> = (0..500).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    triangles.extend([[1500, 1501, 1502], [1501, 1502, 1503]]);
    let mesh = Arc::new(Mesh::new(positions, triangles).unwrap());
    for stop in [Stop::Leaf, Stop::Report] {
        let config =
            KdConfig { plane: Plane::SpatialMedian, axis: AxisRule::Longest, stop, leaf: 400, ..KdConfig::REPORT };
        let shape = Tree::build(&mesh, &config).unwrap().shape();
        assert!(shape.largest_leaf < 400, "{shape:?}");
    }
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let mesh = soup(30_000, 7);
    for config in [KdConfig::REPORT, KdConfig::SAH] {
        let build = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Tree::build(&mesh, &config).unwrap())
        };
        let (one, four) = (build(1), build(4));
        assert_eq!(one.nodes, four.nodes);
        assert_eq!(one.shape(), four.shape());
    }
}

#[test]
fn duplication_stays_within_the_budget() {
    // Needles that all cross near one point straddle every plane.
    let mut rng = rand_pcg::Pcg32::seed_from_u64(8);
    let mut positions = vec![];
    for _ in 0..2000 {
        let d = unit(&mut rng) * 10.0;
        positions.extend([d, -d, -d + unit(&mut rng) * 1e-3]);
    }
    let triangles = (0..2000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = Arc::new(Mesh::new(positions, triangles).unwrap());
    for duplication in [1.0, 2.0, 8.0] {
        let tree = Tree::build(&mesh, &KdConfig { duplication, ..KdConfig::SAH }).unwrap();
        let shape = tree.shape();
        assert!(shape.references as f32 <= duplication * 2000.0, "{duplication}: {shape:?}");
    }
}

#[test]
fn the_literal_exit_of_the_report_stops_too_early() {
    let mesh = soup(600, 5);
    let exact = Tree::build(&mesh, &KdConfig { leaf: 8, ..KdConfig::REPORT }).unwrap();
    let literal = Tree::build(&mesh, &KdConfig { leaf: 8, exit: Exit::FirstLeaf, ..KdConfig::REPORT }).unwrap();
    let wrong =
        rays(4000, 6).iter().filter(|ray| exact.closest_hit(ray, &mut ()) != literal.closest_hit(ray, &mut ())).count();
    assert!(wrong > 0, "a triangle that reaches out of its leaf must show the difference");
}

#[test]
fn watching_does_not_change_the_answer_and_the_mailbox_saves_tests() {
    let mesh = soup(600, 5);
    let config = KdConfig { leaf: 8, ..KdConfig::REPORT };
    let plain = Tree::build(&mesh, &config).unwrap();
    let boxed = Tree::build(&mesh, &KdConfig { mailbox: true, ..config }).unwrap();
    let (mut a, mut b) = (Counts::default(), Counts::default());
    for ray in &rays(2000, 9) {
        let expected = plain.closest_hit(ray, &mut ());
        assert_eq!(plain.closest_hit(ray, &mut a), expected);
        assert_eq!(boxed.closest_hit(ray, &mut b), expected);
    }
    assert_eq!((a.inner, a.leaves, a.empty_leaves), (b.inner, b.leaves, b.empty_leaves));
    assert!(b.tests < a.tests, "{b:?} {a:?}");
}

#[test]
fn a_bad_configuration_is_refused_in_a_sentence() {
    let mesh = soup(1, 1);
    let bad = [
        KdConfig { leaf: 0, ..KdConfig::REPORT },
        KdConfig { threshold: 0.0, ..KdConfig::REPORT },
        KdConfig { sample: 15, plane: Plane::SahBinned, ..KdConfig::SAH },
        KdConfig { candidates: 1, plane: Plane::SahBinned, ..KdConfig::SAH },
        KdConfig { threshold: f32::NAN, ..KdConfig::REPORT },
        KdConfig { traversal_cost: -1.0, ..KdConfig::SAH },
        KdConfig { empty_bonus: 1.0, ..KdConfig::SAH },
        KdConfig { duplication: 0.5, ..KdConfig::SAH },
        // Nobody would read these.
        KdConfig { leaf: 8, ..KdConfig::SAH },
        KdConfig { threshold: 0.5, stop: Stop::Leaf, ..KdConfig::REPORT },
        KdConfig { axis: AxisRule::Longest, ..KdConfig::SAH },
        KdConfig { plane: Plane::SpatialMedian, median: Median::Mean, ..KdConfig::REPORT },
        KdConfig { count: CountOf::Child, stop: Stop::Report, ..KdConfig::SAH },
        KdConfig { intersection_cost: 2.0, ..KdConfig::REPORT },
        KdConfig { candidates: 8, ..KdConfig::SAH },
    ];
    for config in bad {
        let error = Tree::build(&mesh, &config).err().expect("refused").to_string();
        assert!(error.contains("must"), "{error}");
    }
}

/// With limits that a small mesh reaches: what is built is what they are told of.
#[test]
fn a_tree_beyond_the_limits_is_refused() {
    let mesh = soup(600, 5);
    for config in configs() {
        let Plan { nodes, references } = plan(&mesh, &config, &Limits::OF_NODES).unwrap();
        let (nodes, references) = (nodes.len(), references.len());
        assert!(plan(&mesh, &config, &Limits { nodes, references }).is_ok());
        for limits in [Limits { nodes: nodes - 1, references }, Limits { nodes, references: references - 1 }] {
            assert!(matches!(plan(&mesh, &config, &limits), Err(BuildError::Mesh(_))), "{config:?}");
        }
        // Refused before anything is built.
        assert!(matches!(plan(&mesh, &config, &Limits { nodes, references: 599 }), Err(BuildError::Mesh(_))));
    }
}

#[test]
fn it_lives_in_the_pages_of_the_wide_tree() {
    if !pages::can_be_large() {
        eprintln!("skipped: no large pages here");
        return;
    }
    let tree = Tree::build(&soup(20_000, 9), &KdConfig::SAH).unwrap();
    assert!(pages::are_large(&tree.nodes) && pages::are_large(&tree.blocks));
}
