use glam::Vec3;

use super::object::cheapest_group;
use super::offer::Context;
use super::spatial::{Slots, cheapest_cut};
use super::*;
use crate::build::Quality;
use crate::build::binary_tree::Content;
use crate::build::check::{covers, disjoint, leaves, mesh, needles, room, soup};
use crate::build::cut::Cut;
use crate::build::extent::Extent;
use crate::build::part::Part;
use crate::build::planes::Planes;
use crate::build::reference::bounds;
use crate::build::sample::Sample;
use crate::geometry::{Aabb, Mesh};

const ALL: [Splits; 3] = [Splits::Spatial, Splits::SpatialAndObject, Splits::Object];

fn configs() -> impl Iterator<Item = SbvhConfig> {
    let qualities = [Quality::Fast, Quality::Balanced, Quality::High];
    ALL.into_iter().flat_map(move |splits| qualities.map(|quality| SbvhConfig::new(splits, quality)))
}

#[test]
fn every_point_of_every_triangle_is_in_a_leaf_and_spatial_splits_alone_partition_space() {
    for (mesh, seed) in [(soup(1500, 4), 2), (room(8), 3)] {
        for config in configs() {
            let tree = build(&mesh, &config);
            covers(&tree, &mesh, seed);
            let references = tree.references.len();
            assert!(config.splits != Splits::Object || references == mesh.len(), "{config:?}: {references}");
            if config.splits == Splits::Spatial {
                let leaves = leaves(&tree, 64);
                assert!(leaves.len() > 30, "too few leaves for a meaningful test");
                disjoint(&leaves);
            }
        }
    }
}

#[test]
fn references_and_depth_stay_bounded() {
    let n = 3000;
    let diagonals = mesh(n, |i| {
        let x = i as f32;
        [Vec3::new(x, 0.0, 0.0), Vec3::new(x + 3000.0, 3000.0, 3000.0), Vec3::new(x + 3000.0, 3000.0, 2999.0)]
    });
    let coincident = mesh(n, |_| [Vec3::X, Vec3::Y, Vec3::Z]);
    let fan = mesh(n, |i| {
        let (y, z) = ((i as f32).sqrt(), i as f32 / n as f32);
        [Vec3::ZERO, Vec3::new(100.0, y, z), Vec3::new(100.0, y + 1.0, z + 0.5)]
    });
    let shrinking = mesh(n, |i| [Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * 0.97f32.powi(i as i32)));
    let names = ["needles", "diagonals", "coincident", "fan", "shrinking"];
    for (name, mesh) in names.into_iter().zip([needles(n, 6), diagonals, coincident, fan, shrinking]) {
        for duplication in [1.0, 1.5, 4.0, 16.0] {
            for config in configs().map(|c| SbvhConfig { duplication, ..c }) {
                let count = mesh.solid().count();
                let tree = build(&mesh, &config);
                let leaves = leaves(&tree, 64);
                let references = tree.references.len();
                assert!(references as f32 <= duplication * count as f32, "{name} {config:?}: {references}");
                let mut seen = vec![false; mesh.len()];
                leaves.iter().for_each(|(_, ids)| ids.iter().for_each(|&id| seen[id as usize] = true));
                assert!(mesh.solid().all(|id| seen[id as usize]), "{name} {config:?}");

                // At depths of `16.0 + 2.0 * log2` or more, the builder halves the references of a node.
                let log2 = (count as f64).log2().ceil() + 1.0;
                let halvings = (f64::from(duplication) * count as f64).log2();
                let most = 16.0 + 2.0 * log2 + halvings;
                let mut heights = vec![0.0; tree.nodes.len()];
                for (at, node) in tree.nodes.iter().enumerate().rev() {
                    if let Content::Inner([left, right]) = node.content {
                        heights[at] = 1.0 + f64::max(heights[left as usize], heights[right as usize]);
                    }
                }
                assert!(heights[0] <= most, "{name} {config:?}: {} > {most}", heights[0]);
            }
        }
    }
}

#[test]
fn a_floor_and_a_wall_are_separate_leaves_and_tiles_of_a_floor_are_not() {
    let quad = |[a, b, c, d]: [Vec3; 4]| [[a, b, c], [a, c, d]];
    let floor = quad([(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)].map(|(x, z)| Vec3::new(x, 0.0, z)));
    let wall = quad([(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)].map(|(x, y)| Vec3::new(x, y, 0.0)));
    let large = [floor, wall].concat();
    let scene = mesh(204, |i| {
        let small = || [Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * 0.1 + Vec3::splat(5.0 + i as f32 * 0.01));
        large.get(i).copied().unwrap_or_else(small)
    });
    let tiles = mesh(8, |i| {
        let [x, z] = [i / 2 % 2, i / 4].map(|i| i as f32 * 0.7);
        let at = |x: f32, z: f32| Vec3::new(x, 0.3, z);
        [at(x, z), at(x + 0.7, z + 0.7), if i % 2 == 0 { at(x + 0.7, z) } else { at(x, z + 0.7) }]
    });
    for config in configs() {
        let tree = build(&scene, &config);
        // Fast builds, and builds with only spatial splits, may mix the floor and the wall in a leaf.
        let groups = config.splits != Splits::Spatial && config.exact > 0;
        for (_, ids) in leaves(&tree, 64).iter().filter(|_| groups) {
            let has = |part: [u32; 2]| part.iter().any(|id| ids.contains(id));
            assert!(!(has([0, 1]) && has([2, 3])), "{config:?}: {ids:?}");
        }
        assert_eq!(build(&tiles, &config).nodes.len(), 1, "{config:?}");
    }
}

#[test]
fn empty_single_and_extreme_meshes_build() {
    let line = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0];
    let one = [Vec3::X, Vec3::Y, Vec3::Z];
    let huge = one.map(|p| (p - 0.5) * f32::MAX * 1.5);
    for config in configs() {
        assert!(build(&mesh(0, |_| one), &config).nodes.is_empty());
        assert!(build(&mesh(3, |_| line), &config).nodes.is_empty(), "degenerate triangles are in no leaf");
        let tree = build(&mesh(1, |_| one), &config);
        assert_eq!((tree.nodes.len(), &tree.references[..]), (1, &[0][..]));
        assert_eq!(tree.nodes[0].bounds, Aabb { min: Vec3::ZERO, max: Vec3::ONE });
        for scale in [1.0, 1e-30, 1e-38, 1e-42] {
            let mesh = mesh(400, |i| huge.map(|p| p * scale * (1.0 - i as f32 / 400.0)));
            let tree = build(&mesh, &config);
            let held: usize = leaves(&tree, 64).iter().map(|leaf| leaf.1.len()).sum();
            assert!(held >= mesh.solid().count(), "{scale}");
        }
    }
}

fn least_cut(context: &Context, mesh: &Mesh, Part { references, extent }: &Part) -> f64 {
    let mut least = f64::INFINITY;
    for axis in 0..3 {
        let range = (extent.min[axis], extent.max[axis]);
        let candidates = (context.config.candidates as usize).min(references.len());
        let planes = Planes::new(axis, range, candidates, &Sample::all(references)).unwrap();
        for (i, flat_below) in (0..planes.bins() - 1).flat_map(|i| [(i, false), (i, true)]) {
            let cut = Cut { axis, plane: planes.value(i), flat_below };
            let (mut areas, mut counts) = ([Extent::EMPTY; 2], [0; 2]);
            for r in references {
                let sides = cut.sides(r);
                let halves = if sides != [true; 2] {
                    [r.bounds(); 2]
                } else if context.config.sliced == 0 {
                    r.bounds().cut(axis, cut.plane).into()
                } else {
                    let (below, above) = r.cut(mesh, axis, cut.plane);
                    [below.bounds(), above.bounds()]
                };
                for side in (0..2).filter(|&side| sides[side]) {
                    areas[side].grow(halves[side].into());
                    counts[side] += 1;
                }
            }
            if counts.iter().all(|&n| n > 0) && counts != [references.len(); 2] {
                least = least.min(context.costs.box_split(extent.half_area(), areas.map(|e| e.half_area()), counts));
            }
        }
    }
    least
}

fn least_group(context: &Context, Part { references, extent }: &Part) -> f64 {
    let mut least = f64::INFINITY;
    for axis in 0..3 {
        for middle in references.iter().map(|r| r.centre(axis)) {
            let (below, above): (Vec<_>, Vec<_>) = references.iter().partition(|r| r.centre(axis) < middle);
            if !below.is_empty() {
                let counts = [below.len(), above.len()];
                let areas = [below, above].map(|side| bounds(side).half_area());
                least = least.min(context.costs.box_split(extent.half_area(), areas, counts));
            }
        }
    }
    least
}

#[test]
fn no_cut_and_no_grouping_by_centres_is_cheaper_than_the_one_that_is_chosen() {
    for seed in 0..60 {
        let mesh = soup(9 + seed as usize, seed);
        let part = Part::whole(&mesh);
        let spatial = SbvhConfig { refined: u32::MAX, ..SbvhConfig::new(Splits::Spatial, Quality::High) };
        for config in [SbvhConfig { sliced: 0, ..spatial }, spatial] {
            let context = Context::new(&mesh, &config);
            let found = cheapest_cut(&context, &part.references, part.extent, f64::INFINITY, &mut Slots::new());
            let (found, least) = (found.unwrap().cost, least_cut(&context, &mesh, &part));
            // The builder computes slices in `f32`. `least_cut` clips triangles in `f64`.
            let slack = if config.sliced == 0 { 0.0 } else { 1e-5 * least };
            assert!((found - least).abs() <= slack, "{found} instead of {least}");
        }
        let config = SbvhConfig { exact: 128, ..SbvhConfig::new(Splits::Object, Quality::High) };
        let context = Context::new(&mesh, &config);
        let found = cheapest_group(&context, &part.references, part.extent.half_area()).unwrap();
        assert_eq!(found.cost, least_group(&context, &part));
    }
}
