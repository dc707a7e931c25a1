//! Scenes of extreme extent, and scenes of almost nothing.

use std::sync::Arc;

use glam::Vec3;

use super::case::{HardCase, added, extreme, moderate, unranked};
use super::set::{Set, indexed, moved, on_surface, star};
use crate::geometry::{Mesh, Ray};
use crate::scene::meshes::teapot;
use crate::validate::Sampler;
use crate::validate::degenerate::{TRIANGLE, box_grid, exponential, huge_and_small, mesh, shells, soup_triangles};

pub(super) const CASES: &[HardCase] = &[
    moderate(43, "huge_tri_1e6")
        .by_oracle(|n| {
            Set::new(huge_and_small(), n, 30, |sampler| {
                let origin = sampler.direction() * 4.0;
                Ray::new(origin, sampler.cube() - origin)
            })
        })
        .because("One triangle a million times the size of the scene: it dominates every bound and every cost.")
        .source("survey"),
    moderate(44, "teapot_in_stadium_1e5")
        .all_hit(stadium)
        .because(
            "A teapot in a stadium a hundred thousand times its size, seen from the seats: boxes are \
             below the rounding of t.",
        )
        .source("folklore of spatial subdivision; survey"),
    moderate(46, "one_triangle")
        .all_hit(|n| {
            let [a, b, c] = TRIANGLE;
            Set::new(mesh([TRIANGLE]), n, 31, |sampler| {
                let [u, v, w] = sampler.barycentric().map(|weight| 0.2 + 0.4 * weight);
                let origin = Vec3::new(sampler.signed(), sampler.signed(), 4.0 * sampler.sign());
                Ray::new(origin, a * u + b * v + c * w - origin)
            })
        })
        .because("The root is a leaf.")
        .source("survey"),
    moderate(47, "one_triangle_vertex_edge")
        .all_hit(|n| Set::new(mesh([SIMPLE]), n, 32, exactly_on_the_rim))
        .because("Rays that meet the vertices and edges of a lone triangle exactly: it is closed.")
        .source("Woop, Benthin, Wald 2013: no promise for the rim of an open mesh"),
    unranked(48, "empty")
        .all_miss(|n| Set::new(mesh([]), n, 33, |sampler| Ray::new(sampler.cube(), sampler.direction())))
        .because("No triangle at all: no root box, no node, no hit, no panic.")
        .source("kdtree-ray: asserts; Embree, verify.cpp, empty_scene"),
    moderate(49, "far_1e3")
        .by_oracle(|n| from_afar(n, 1e3))
        .because("From 1e3 away: the boxes of thin leaves are a few ulps of t deep.")
        .source("Ize 2013"),
    moderate(50, "far_1e6")
        .by_oracle(|n| from_afar(n, 1e6))
        .because("From 1e6 away: entry and exit of most boxes are one float.")
        .source("Ize 2013"),
    extreme(51, "far_1e8")
        .by_oracle(|n| from_afar(n, 1e8))
        .because("From 1e8 away: the scene is smaller than an ulp of t.")
        .source("Ize 2013"),
    moderate(52, "shells_nested_in")
        .all_hit(|n| {
            Set::new(shells(), n, 34, |sampler| {
                let inside = libm::scalbnf(0.1, sampler.below(61) as i32 - 30);
                Ray::new(sampler.cube() * inside, sampler.direction())
            })
        })
        .because(
            "Octahedra from 2^-30 to 2^30 around zero, from among them: the next is hit, within any \
             absolute epsilon.",
        )
        .source("obvhs, CwBvh node.rs EPSILON"),
    moderate(53, "shells_nested_out")
        .all_hit(|n| {
            let outermost = libm::scalbnf(1.0, 30);
            Set::new(shells(), n, 35, |sampler| {
                let origin = sampler.direction() * (2.0 * outermost);
                let target = sampler.cube() * (0.3 * outermost);
                Ray::new(origin, (target - origin) / outermost)
            })
        })
        .because(
            "The same octahedra from outside: the outermost is hit, in spite of all that is nearer to \
             the middle.",
        )
        .source("survey"),
    moderate(55, "exp_sequence_1.3")
        .all_hit(exponential_rays)
        .because(
            "Each of 300 triangles is 1.3 times as large as the one before: trees become chains, and \
             fixed stacks overflow.",
        )
        .source("svenstaro/bvh, iter.rs: a stack of 32 panics"),
    unranked(57, "nonfinite_verts")
        .by_oracle(largest_numbers)
        .because(
            "The mesh's door refuses vertices that are NaN or infinite, so that no structure can be \
             fed one; this is the \
                 worst that passes: some vertices at the largest float, so that extents and areas are infinite.",
        )
        .source("obvhs, ploc, and svenstaro/bvh, bvh_node.rs: builders panic"),
    added(83, "deep_chain")
        .all_hit(deep_chain)
        .because(
            "A triangle at every power of two from 2^-60 to 2^60: halving the box takes off one at a \
             time, deeper than 64.",
        )
        .source("stacks of 32 or 64 entries in svenstaro/bvh and pbrt-v4"),
];

/// Integer corners, so that eighths of edges are exact.
const SIMPLE: [Vec3; 3] = [Vec3::ZERO, Vec3::new(8.0, 0.0, 4.0), Vec3::new(0.0, 8.0, -4.0)];

/// Towards a corner or an eighth of an edge, from a place in front so simple that the difference is exact: t is 1.
fn exactly_on_the_rim(sampler: &mut Sampler) -> Ray {
    let [a, b, c] = SIMPLE;
    let normal = (b - a).cross(c - a);
    let from = sampler.below(3);
    let (p, q) = ([a, b, c][from], [b, c, a][from]);
    let target = p + (q - p) * (sampler.below(8) as f32 / 8.0);
    loop {
        let away = (sampler.cube() * 16.0).round() / 4.0;
        if away.dot(normal) > 0.0 {
            return Ray::new(target + away, -away);
        }
    }
}

fn from_afar(count: usize, distance: f32) -> Set {
    let mesh = moved(&star(), |p| p * 0.3);
    Set::new(mesh.clone(), count, 36, |sampler| {
        let direction = sampler.direction();
        Ray::new(on_surface(&mesh, sampler) - direction * distance, direction)
    })
}

/// A teapot of about unit size in a closed box a hundred thousand times as large, from inside the box.
fn stadium(count: usize) -> Set {
    let walls = box_grid(8);
    let pot = teapot();
    let teapot: Vec<Vec3> = pot.positions.iter().map(|&p| p * 0.04).collect();
    let of_teapot = teapot.len() as u32;
    let points = teapot.into_iter().chain(walls.positions().iter().map(|&p| p * 1e5)).collect();
    let triangles = pot.triangles.iter().copied().chain(walls.triangles().iter().map(|t| t.map(|i| i + of_teapot)));
    let mesh = indexed(points, triangles.collect());
    Set::new(mesh.clone(), count, 37, |sampler| {
        let [a, b, c] = mesh.corners(sampler.below(pot.triangles.len()) as u32);
        let [u, v, w] = sampler.barycentric();
        let direction = sampler.direction();
        Ray::new(a * u + b * v + c * w - direction * 7e4, direction)
    })
}

/// From just outside of one triangle of the sequence through all that are smaller: it is the first, and where products of three
/// of its lengths overflow, the next that do not are seen in its place.
fn exponential_rays(count: usize) -> Set {
    let mesh = moved(&exponential(300), |p| p * 1e16);
    Set::new(mesh.clone(), count, 38, |sampler| {
        let [corner, ..] = mesh.corners(sampler.below(300) as u32);
        let side = |sampler: &mut Sampler| 0.05 + 0.2 * sampler.unit();
        let from = Vec3::new(1.3, side(sampler), side(sampler));
        Ray::new(from * corner.x, -from)
    })
}

fn largest_numbers(count: usize) -> Set {
    let mut sampler = Sampler::new(39);
    let far = |sampler: &mut Sampler| Vec3::new(sampler.sign(), sampler.sign(), sampler.sign()) * f32::MAX;
    let triangles: Vec<[Vec3; 3]> = soup_triangles(300, 39)
        .enumerate()
        .map(|(i, [a, b, c])| match i % 10 {
            0 => [far(&mut sampler), b, c],
            1 => [far(&mut sampler), far(&mut sampler), c],
            _ => [a, b, c],
        })
        .collect();
    let mesh: Arc<Mesh> = mesh(triangles);
    Set::new(mesh, count, 40, |sampler| {
        let origin = sampler.direction() * 3.0;
        Ray::new(origin, sampler.cube() - origin)
    })
}

/// Each triangle stands across the x axis at its power of two, with that size.
fn deep_chain(count: usize) -> Set {
    let mesh = mesh((-60..=60).map(|exponent| {
        let at = libm::scalbnf(1.0, exponent);
        [Vec3::new(at, -at, -at), Vec3::new(at, 2.0 * at, -at), Vec3::new(at, -at, 2.0 * at)]
    }));
    Set::new(mesh, count, 41, |sampler| {
        let at = libm::scalbnf(1.25, sampler.below(120) as i32 - 60);
        let across = Vec3::new(0.0, sampler.signed(), sampler.signed()) * 0.25;
        Ray::new(Vec3::new(at, 0.0, 0.0) + across * at, Vec3::X + across)
    })
}
