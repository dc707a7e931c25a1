use std::sync::Arc;

use glam::Vec3;

use super::batch::{Groups, Interleaved};
use super::node::Limits;
use super::*;
use crate::accel::{Accel, BuildError, Counts};
use crate::build::Quality;
use crate::build::check::{mesh, same_on_threads, soup};
use crate::exact;
use crate::geometry::{Hit, Mesh, PrimId, Ray};
use crate::simd::{Level, dispatch};
use crate::triangle::{Exact, MollerTrumbore, Plucker, TriangleTest};

type Tree = Bvh8<MollerTrumbore>;

const ALL: [Partition; 4] = [Partition::Cells, Partition::Tight, Partition::Hybrid, Partition::Objects];

#[test]
fn rays_test_only_triangles_of_leaves_that_they_meet_and_no_lanes_left_over() {
    let coincident = [1, 8, 9, 40].map(|count| mesh(count, |_| [Vec3::X, Vec3::Y, Vec3::Z]));
    for mesh in coincident.into_iter().chain([soup(12, 3)]).map(Arc::new) {
        for partition in ALL {
            let tree = Tree::build(&mesh, &Bvh8Config::new(partition)).unwrap();
            let bounds = mesh.bounds();
            let beside = Ray::new(bounds.max + bounds.max.abs(), Vec3::ONE);
            let (mut missing, mut meeting) = (Counts::default(), Counts::default());
            assert_eq!(tree.closest_hit(&beside, &mut missing), None);
            assert_eq!(missing.tests, 0, "{partition:?}");
            if bounds.min == Vec3::ZERO {
                tree.closest_hit(&Ray::new(Vec3::ZERO, Vec3::ONE), &mut meeting);
                assert_eq!(meeting.tests, mesh.len() as u64, "{partition:?}");
            }
        }
    }
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let mesh = Arc::new(soup(30_000, 5));
    for partition in ALL {
        for quality in [Quality::Fast, Quality::Balanced, Quality::High] {
            same_on_threads(|| {
                let tree = Tree::build(&mesh, &Bvh8Config { quality, ..Bvh8Config::new(partition) }).unwrap();
                (tree.root, tree.nodes, tree.blocks.iter().map(|block| block.ids).collect::<Vec<_>>())
            });
        }
    }
}

#[test]
fn the_unit_of_length_does_not_matter() {
    let metres = soup(2000, 31);
    let build = |unit: f32, config: &Bvh8Config| {
        let positions = metres.positions().iter().map(|&p| p * unit).collect();
        let mesh = Arc::new(Mesh::new(positions, metres.triangles().to_vec()).unwrap());
        Tree::build(&mesh, config).unwrap().shape()
    };
    for partition in ALL {
        for quality in [Quality::Fast, Quality::Balanced] {
            let config = Bvh8Config { quality, ..Bvh8Config::new(partition) };
            let shape = build(1.0, &config);
            for exponent in [-90, -60, 60, 100] {
                assert_eq!(build(libm::exp2(f64::from(exponent)) as f32, &config), shape, "{config:?}, 2^{exponent}");
            }
        }
    }
}

/// In ray 5, the inverse of `direction.x` is finite. The product of this inverse and `ENLARGED` is infinite.
#[test]
fn packets_leave_alone_what_their_common_bounds_cannot_tell() {
    let mesh = mesh(200, |i| {
        let z = 1.0 + i as f32;
        [Vec3::new(0.0, 0.01 * z, z), Vec3::new(1.0, -1000.0, z), Vec3::new(1.0, 1000.0, z)]
    });
    let mesh = Arc::new(mesh);
    let along = |x: f32| Ray::new(Vec3::ZERO, Vec3::new(x, 0.01, 1.0));
    let mut rays = [along(-1e-3); 16];
    rays[5] = along(-2.938737e-39);
    for partition in ALL {
        let tree = Tree::build(&mesh, &Bvh8Config { batch: Batch::Packets, ..Bvh8Config::new(partition) }).unwrap();
        let mut hits = [None; 16];
        tree.closest_hits(&rays, &mut hits, &mut ());
        assert_eq!(hits, rays.map(|ray| tree.closest_hit(&ray, &mut ())));
        assert!(hits[5].is_some(), "ray 5 must hit a triangle");
    }
}

fn several_answer_as_one<T: TriangleTest>(mesh: &Arc<Mesh>, rays: &[Ray]) {
    for partition in ALL {
        let tree = &Bvh8::<T>::build(mesh, &Bvh8Config::new(partition)).unwrap();
        for level in Level::available() {
            let mut hits = vec![None; rays.len()];
            let which = &Groups::all(rays.len());
            dispatch(level, Interleaved::<T, _, _> { tree, rays, which, answers: &mut hits, convert: &Some });
            for (hit, ray) in hits.iter().zip(rays) {
                let alone = Some(as_bits(&[tree.closest_hit(ray, &mut ())]));
                assert_eq!(hit.map(|hit| as_bits(&[hit])), alone, "{partition:?}, {level}, {ray:?}");
            }
        }
    }
}

fn scattered(i: u32) -> Ray {
    let number = |k: u32| ((i * 6 + k).wrapping_mul(2_654_435_761) >> 8) as f32 / (1 << 24) as f32 * 3.0 - 1.0;
    let x = if i.is_multiple_of(5) { 0.0 } else { number(3) };
    Ray::new(Vec3::new(number(0), number(1), number(2)), Vec3::new(x, number(4), number(5) - 0.5))
}

#[test]
fn several_rays_under_way_find_what_each_finds_alone() {
    // Trees: empty, of one block, of several blocks below the root, and of many levels.
    for n in [0, 3, 30, 3000] {
        let mesh = Arc::new(soup(n, 5));
        let mut rays: Vec<Ray> = (0..500).map(scattered).collect();
        let odd = [f32::NAN, f32::INFINITY, 0.0, -0.0, 1e-40];
        rays.extend(odd.map(|x| Ray::new(Vec3::splat(0.1), Vec3::new(x, 0.0, 1.0))));
        rays.extend(odd.map(|t| Ray::new(Vec3::splat(-3.0), Vec3::ONE).until(t)));
        several_answer_as_one::<MollerTrumbore>(&mesh, &rays);
        several_answer_as_one::<Exact>(&mesh, &rays);
    }
}

/// If all three inverses are NaN, a ray also meets the boxes of unused lanes.
#[test]
fn rays_without_an_inverse_on_any_axis_are_not_through_at_the_first_unused_lane() {
    let mesh = Arc::new(soup(300, 5));
    let corners: Vec<_> = (0..300).map(|id| mesh.corners(id)).collect();
    for length in [1e-39, 1.9e38] {
        let toward = |(i, [a, b, c]): (usize, &[Vec3; 3])| {
            let signs = Vec3::from_array([1, 2, 4].map(|bit| if i & bit == 0 { 1.0 } else { -1.2 }));
            Ray::new((*a + *b + *c) / 3.0 - signs * 0.01, signs * length)
        };
        let rays: Vec<Ray> = corners.iter().enumerate().map(toward).collect();
        let tree = Bvh8::<Exact>::build(&mesh, &Bvh8Config::default()).unwrap();
        assert!(rays.iter().filter(|ray| tree.any_hit(ray, &mut ())).count() > 250, "{length}");
        several_answer_as_one::<Exact>(&mesh, &rays);
    }
}

#[test]
fn long_slices_are_answered_as_their_rays_are() {
    let mesh = Arc::new(soup(300, 5));
    let toward = |id: u32, origin: Vec3| {
        let [a, b, c] = mesh.corners(id % 300);
        Ray::new(origin, (a + b + c) / 3.0 - origin)
    };
    let ray = |i: u32| match i / 16 % 3 {
        0 => toward(i / 16, Vec3::new(-3.0, -4.0 + (i % 16) as f32 * 1e-3, -5.0)),
        _ => toward(i * 7, scattered(i).origin),
    };
    let mut rays: Vec<Ray> = (0..2 * 4096 + 21).map(ray).collect();
    // Rays that begin on a triangle require exact arithmetic.
    for (i, ray) in rays.iter_mut().enumerate().filter(|(i, _)| i / 16 % 3 == 1 && i % 4 == 0) {
        ray.origin = mesh.corners(i as u32 % 300)[0];
    }
    answers_of_long_slices::<MollerTrumbore>(&mesh, &rays);
    answers_of_long_slices::<Exact>(&mesh, &rays);
}

fn answers_of_long_slices<T: TriangleTest>(mesh: &Arc<Mesh>, rays: &[Ray]) {
    let single = Bvh8::<T>::build(mesh, &Bvh8Config::default()).unwrap();
    let alone: Vec<_> = rays.iter().map(|ray| single.closest_hit(ray, &mut ())).collect();
    let met = |of: &dyn Fn(usize) -> bool| (0..rays.len()).filter(|&i| of(i) && alone[i].is_some()).count();
    assert!(met(&|i| i / 16 % 3 == 0) > 2000 && met(&|i| i / 16 % 3 != 0) > 4000, "nearly all hit something");
    for (batch, interleaves) in [(Batch::Single, false), (Batch::Packets, false), (Batch::Packets, true)] {
        let mut tree = Bvh8::<T>::build(mesh, &Bvh8Config { batch, ..Bvh8Config::default() }).unwrap();
        assert!(!tree.interleaves, "so small a tree is traced in order by default");
        tree.interleaves = interleaves;
        let short = (0..20).flat_map(|len| (0..400).step_by(13).map(move |first| first..first + len));
        for range in short.chain([4095, 4096, 4097, rays.len()].map(|len| 0..len)) {
            let (mut hits, mut any) = (vec![None; range.len()], vec![false; range.len()]);
            tree.closest_hits(&rays[range.clone()], &mut hits, &mut ());
            tree.any_hits(&rays[range.clone()], &mut any, &mut ());
            let place = format!("{}, {batch:?}, interleaved: {interleaves}, the rays {range:?}", T::NAME);
            let is_hit: Vec<bool> = alone[range.clone()].iter().map(Option::is_some).collect();
            assert!(as_bits(&hits) == as_bits(&alone[range]) && any == is_hit, "{place}");
        }
    }
}

fn as_bits(hits: &[Option<Hit>]) -> Vec<Option<(u32, PrimId)>> {
    hits.iter().map(|hit| hit.map(|hit| (hit.t.to_bits(), hit.prim))).collect()
}

/// The triangles differ only by a few units in the last place. Some triangles are equal.
#[test]
fn crowds_of_triangles_are_ordered_exactly() {
    let bits = |i: u32| i.wrapping_mul(0x9e37_79b1).rotate_left(11).wrapping_mul(2_654_435_761);
    let moved = |x: f32, i: u32| f32::from_bits((x.to_bits() as i32 + bits(i) as i32 % 5) as u32);
    let mut crowded = 0;
    for scale in [1.0, 1e-12, 3e9] {
        let mesh = Arc::new(mesh(64, |id| {
            let corner = |k: u32, x: f32, y: f32, z: f32| {
                let number = |axis: u32, x: f32| moved(x * scale, 9 * (id as u32 / 2 * 2) + 3 * k + axis);
                Vec3::new(number(0, x), number(1, y), number(2, z))
            };
            [corner(0, -2.1, -1.7, 0.9), corner(1, 2.3, -1.3, 1.1), corner(2, 0.1, 2.7, 1.3)]
        }));
        let tree = Bvh8::<Exact>::build(&mesh, &Bvh8Config::default()).unwrap();
        for i in 0..600 {
            let id = bits(i) % 64;
            let [a, b, c] = mesh.corners(id);
            let from = scattered(i);
            let ray = match i % 5 {
                0 => Ray::new(from.origin * scale, (a + b + c) / 3.0 - from.origin * scale),
                1 => Ray::new(a * 0.25 + b * 0.5 + c * 0.25, from.direction),
                2 => Ray::new(a * 0.3 + b * 0.3 + c * 0.4, Vec3::Z).until(scale * 1e-6),
                3 => Ray::new(a, from.direction),
                _ => Ray::new(a * 0.5 + b * 0.5, from.direction),
            };
            let hits = (0..64).filter_map(|id| Some((exact::hit(&ray, mesh.corners(id))?, id)));
            let right = hits.filter(|(t, _)| t.is_within(&ray)).min().map(|(t, id)| Hit::new(t.round(), id));
            assert_eq!(as_bits(&[tree.closest_hit(&ray, &mut ())]), as_bits(&[right]), "{ray:?}");
            crowded += u32::from(right.is_some());
        }
    }
    assert!(crowded > 900, "{crowded}");
}

#[test]
fn several_rays_at_once_are_refused_over_tests_that_they_are_not_compiled_for() {
    let mesh = Arc::new(soup(3, 1));
    let refused = Bvh8::<Plucker>::build(&mesh, &Bvh8Config { batch: Batch::Packets, ..Bvh8Config::default() });
    assert!(matches!(refused, Err(BuildError::Config(_))));
}

#[test]
fn a_tree_beyond_the_limits_is_refused_in_a_sentence() {
    let mesh = Arc::new(soup(6000, 32));
    for partition in ALL {
        let config = Bvh8Config { duplication: 2.0, ..Bvh8Config::new(partition) };
        let whole = Tree::build(&mesh, &config).unwrap();
        let (nodes, blocks) = (whole.nodes.len(), whole.blocks.len());
        let all = Limits { nodes, blocks, binary: 24_000, ..Limits::OF_NODES };
        assert!(Tree::within(&mesh, &config, &all).is_ok());
        let smaller = [
            Limits { nodes: nodes - 1, ..all },
            Limits { blocks: blocks - 1, ..all },
            Limits { levels: 2, ..all },
            Limits { binary: 23_999, ..all },
        ];
        for limits in smaller {
            let refused = Tree::within(&mesh, &config, &limits).err();
            assert!(matches!(refused, Some(BuildError::Mesh(s)) if s.contains("too large")), "{limits:?}");
        }
    }
}
