use std::sync::Arc;

use glam::Vec3;
use rand_core::SeedableRng;

use super::node::Limits;
use super::tree::{Plan, plan};
use super::*;
use crate::accel::{Accel, BuildError, Counts};
use crate::brute_force::BruteForce;
use crate::build::check::{mesh, needles, same_on_threads, straddling_soup, unit};
use crate::geometry::{Hit, Mesh, Ray};
use crate::traversal::pages;
use crate::triangle::{Exact, MollerTrumbore, MollerTrumboreF64, TriangleTest};

type Tree = KdTree<MollerTrumbore>;

fn soup(count: usize, seed: u64) -> Arc<Mesh> {
    Arc::new(straddling_soup(count, seed))
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

/// Rays close to the floor cross flat cells at a negative `t` nearer to 0 than the slack of crossings.
#[test]
fn rays_that_leave_a_flat_floor_test_none_of_its_triangles() {
    let corner = |i: usize, j: usize| Vec3::new(i as f32, 0.0, j as f32);
    let mesh = Arc::new(mesh(2 * 16 * 16, |half| {
        let (i, j) = (half / 32, half / 2 % 16);
        let third = if half % 2 == 0 { corner(i + 1, j) } else { corner(i, j + 1) };
        [corner(i, j), corner(i + 1, j + 1), third]
    }));
    for config in configs() {
        let tree = Tree::build(&mesh, &config).unwrap();
        for height in [1e-45, 1e-40, f32::MIN_POSITIVE, 1e-20, 1.0] {
            for direction in [Vec3::Y, Vec3::new(0.3, 0.01, -0.7)] {
                let (mut leaving, mut meeting) = (Counts::default(), Counts::default());
                let ray = Ray::new(Vec3::new(7.3, height, 7.6), direction);
                assert_eq!(tree.closest_hit(&ray, &mut leaving), None);
                assert_eq!(leaving.tests, 0, "{config:?} {ray}");
                let back = Ray { direction: -direction, ..ray };
                assert!(height == 1.0 || tree.closest_hit(&back, &mut meeting).is_some(), "{config:?} {back}");
            }
        }
    }
}

/// At `t` near 2^128, some plane crossings overflow.
#[test]
fn hits_near_the_largest_t_are_found() {
    fn as_brute_force<T: TriangleTest>(mesh: &Arc<Mesh>, rays: &[Ray]) -> Vec<Hit> {
        let reference = <BruteForce<T> as Accel>::build(mesh, &Default::default()).unwrap();
        let expected: Vec<Option<Hit>> = rays.iter().map(|ray| reference.closest_hit(ray, &mut ())).collect();
        for config in configs() {
            let tree = KdTree::<T>::build(mesh, &config).unwrap();
            for (ray, &expected) in rays.iter().zip(&expected) {
                assert_eq!(tree.closest_hit(ray, &mut ()), expected, "{} {config:?} \"{ray}\"", T::NAME);
                assert_eq!(tree.any_hit(ray, &mut ()), expected.is_some(), "{} {config:?} \"{ray}\"", T::NAME);
            }
        }
        expected.into_iter().flatten().collect()
    }

    let below = |x: f32, ulps: u32| f32::from_bits(x.to_bits() - ulps);
    let sheet = |z: f32| [[-1e30, -1e30], [1e30, -1e30], [0.0, 2e30]].map(|[x, y]| Vec3::new(x, y, z));
    let mesh = Arc::new(mesh(24, |ulps| sheet(below(2.0_f32.powi(100), ulps as u32))));
    let mut rays = vec![];
    for ulps in 0..40 {
        for z in [0.0, -7.555_786_4e22, 3e23] {
            let ray = Ray::new(Vec3::new(0.4, -0.4, z), Vec3::Z * below(2.0_f32.powi(-28), ulps));
            for t_max in [f32::INFINITY, f32::MAX, below(f32::MAX, 1), below(f32::MAX, 5)] {
                rays.extend([0.0, below(f32::MAX, 3), f32::MAX].map(|t_min| Ray { t_min, t_max, ..ray }));
            }
        }
    }
    for hits in [as_brute_force::<Exact>(&mesh, &rays), as_brute_force::<MollerTrumboreF64>(&mesh, &rays)] {
        assert!(hits.iter().filter(|hit| hit.t == f32::MAX).count() > 10, "{hits:?}");
    }
}

/// The first cuts in the middle leave all triangles on one side. Only the floor is also on the other side.
#[test]
fn the_middle_of_a_cell_finds_a_small_mesh_on_a_large_floor() {
    let mut rng = rand_pcg::Pcg32::seed_from_u64(9);
    let mut corner = |i: usize| Vec3::new(i as f32 / 500.0, 0.0, 0.0) + unit(&mut rng) * 0.01;
    let [a, b, c, d] = [[-2.0, -7.0], [30.0, -7.0], [-2.0, 8.0], [30.0, 8.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
    let floor = [[a, b, c], [b, c, d]];
    let mesh = Arc::new(mesh(502, |i| if i < 500 { [corner(i), corner(i), corner(i)] } else { floor[i - 500] }));
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
        same_on_threads(|| {
            let tree = Tree::build(&mesh, &config).unwrap();
            (tree.shape(), tree.nodes)
        });
    }
}

#[test]
fn duplication_stays_within_the_budget() {
    let mesh = Arc::new(needles(2000, 8));
    for duplication in [1.0, 2.0, 8.0] {
        let tree = Tree::build(&mesh, &KdConfig { duplication, ..KdConfig::SAH }).unwrap();
        let shape = tree.shape();
        assert!(shape.references as f32 <= duplication * 2000.0, "{duplication}: {shape:?}");
    }
}

#[test]
fn the_literal_exit_stops_too_early_and_the_mailbox_saves_tests_and_changes_no_answer() {
    let config = KdConfig { leaf: 8, ..KdConfig::REPORT };
    let literal = KdConfig { exit: Exit::FirstLeaf, ..config };
    let mesh = soup(600, 5);
    let [plain, boxed, literal] =
        [config, KdConfig { mailbox: true, ..config }, literal].map(|config| Tree::build(&mesh, &config).unwrap());
    let (mut a, mut b, mut wrong) = (Counts::default(), Counts::default(), 0);
    for ray in &rays(4000, 6) {
        let hit = plain.closest_hit(ray, &mut a);
        assert_eq!(hit, boxed.closest_hit(ray, &mut b));
        wrong += u32::from(hit != literal.closest_hit(ray, &mut ()));
    }
    assert!(wrong > 0, "a triangle that reaches out of its leaf must show the difference");
    assert_eq!((a.inner, a.leaves, a.empty_leaves), (b.inner, b.leaves, b.empty_leaves));
    assert!(b.tests < a.tests, "{b:?} {a:?}");
}

#[test]
fn a_bad_configuration_is_refused_in_a_sentence() {
    let mesh = soup(1, 1);
    let bad = [
        KdConfig { leaf: 0, ..KdConfig::REPORT },
        KdConfig { threshold: 0.0, ..KdConfig::REPORT },
        KdConfig { threshold: f32::NAN, ..KdConfig::REPORT },
        KdConfig { traversal_cost: -1.0, ..KdConfig::SAH },
        KdConfig { empty_bonus: 1.0, ..KdConfig::SAH },
        KdConfig { duplication: 0.5, ..KdConfig::SAH },
        // Each configuration below changes an option that has no effect.
        KdConfig { leaf: 8, ..KdConfig::SAH },
        KdConfig { threshold: 0.5, stop: Stop::Leaf, ..KdConfig::REPORT },
        KdConfig { axis: AxisRule::Longest, ..KdConfig::SAH },
        KdConfig { plane: Plane::SpatialMedian, median: Median::Mean, ..KdConfig::REPORT },
        KdConfig { count: CountOf::Child, stop: Stop::Report, ..KdConfig::SAH },
        KdConfig { intersection_cost: 2.0, ..KdConfig::REPORT },
    ];
    for config in bad {
        let error = Tree::build(&mesh, &config).err().expect("refused").to_string();
        assert!(error.contains("must"), "{error}");
    }
}

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
        // The mesh is rejected before the build.
        assert!(matches!(plan(&mesh, &config, &Limits { nodes, references: 599 }), Err(BuildError::Mesh(_))));
    }
}

#[test]
fn nodes_and_blocks_use_huge_pages() {
    let tree = Tree::build(&soup(20_000, 9), &KdConfig::SAH).unwrap();
    pages::assert_large(&tree.nodes);
    pages::assert_large(&tree.blocks);
}
