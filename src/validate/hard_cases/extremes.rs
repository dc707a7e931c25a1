//! Scenes of extreme extent, and scenes of almost nothing.

use glam::Vec3;

use super::case::cases;
use super::crowds::copies;
use super::set::{Set, indexed, joined, moved, on_surface, ray_to, star};
use crate::geometry::Ray;
use crate::scene::meshes::teapot;
use crate::validate::Sampler;
use crate::validate::degenerate::{box_grid, exponential, huge_and_small, mesh, shells, soup_triangles};

cases! {
    Moderate 43 "huge_tri_1e6", Oracle => |n| {
        Set::new(huge_and_small(), n, 30, |sampler| ray_to(sampler.direction() * 4.0, sampler.cube()))
    },
        "One triangle a million times the size of the scene: it dominates every bound and every cost.",
        "survey";
    Moderate 44 "teapot_in_stadium_1e5", Hit => stadium,
        "A teapot in a stadium a hundred thousand times its size, seen from the seats: boxes are below the rounding of t.",
        "folklore of spatial subdivision; survey";
    Moderate 46 "one_triangle", Hit => |n| copies(1, n, 31),
        "The root is a leaf.",
        "survey";
    Moderate 47 "one_triangle_vertex_edge", Hit => |n| Set::new(mesh([SIMPLE]), n, 32, exactly_on_the_rim),
        "Rays that meet the vertices and edges of a lone triangle exactly: it is closed.",
        "Woop, Benthin, Wald 2013: no promise for the rim of an open mesh";
    Unranked 48 "empty", Miss => |n| Set::new(mesh([]), n, 33, |sampler| Ray::new(sampler.cube(), sampler.direction())),
        "No triangle at all: no root box, no node, no hit, no panic.",
        "kdtree-ray: asserts; Embree, verify.cpp, empty_scene";
    Moderate 49 "far_1e3", Oracle => |n| from_afar(n, 1e3),
        "From 1e3 away: the boxes of thin leaves are a few ulps of t deep.",
        "Ize 2013";
    Moderate 50 "far_1e6", Oracle => |n| from_afar(n, 1e6),
        "From 1e6 away: entry and exit of most boxes are one float.",
        "Ize 2013";
    Extreme 51 "far_1e8", Oracle => |n| from_afar(n, 1e8),
        "From 1e8 away: the scene is smaller than an ulp of t.",
        "Ize 2013";
    Moderate 52 "shells_nested_in", Hit => among_shells,
        "Octahedra from 2^-30 to 2^30 around zero, from among them: the next is hit, within any absolute epsilon.",
        "obvhs, CwBvh node.rs EPSILON";
    Moderate 53 "shells_nested_out", Hit => around_shells,
        "The same octahedra from outside: the outermost is hit, in spite of all that is nearer to the middle.",
        "survey";
    Moderate 55 "exp_sequence_1.3", Hit => exponential_rays,
        "Each of 300 triangles is 1.3 times as large as the one before: trees become chains, and fixed stacks overflow.",
        "svenstaro/bvh, iter.rs: a stack of 32 panics";
    Unranked 57 "nonfinite_verts", Oracle => largest_numbers,
        "The mesh's door refuses vertices that are NaN or infinite, so that no structure can be fed one; this is the \
         worst that passes: some vertices at the largest float, so that extents and areas are infinite.",
        "obvhs, ploc, and svenstaro/bvh, bvh_node.rs: builders panic";
    Added 83 "deep_chain", Hit => deep_chain,
        "A triangle at every power of two from 2^-60 to 2^60: halving the box takes off one at a time, deeper than 64.",
        "stacks of 32 or 64 entries in svenstaro/bvh and pbrt-v4";
}

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

fn among_shells(count: usize) -> Set {
    Set::new(shells(), count, 34, |sampler| {
        let inside = libm::scalbnf(0.1, sampler.below(61) as i32 - 30);
        Ray::new(sampler.cube() * inside, sampler.direction())
    })
}

fn around_shells(count: usize) -> Set {
    let outermost = libm::scalbnf(1.0, 30);
    Set::new(shells(), count, 35, |sampler| {
        let origin = sampler.direction() * (2.0 * outermost);
        let target = sampler.cube() * (0.3 * outermost);
        Ray::new(origin, (target - origin) / outermost)
    })
}

/// A teapot of about unit size in a closed box a hundred thousand times as large, from inside the box.
fn stadium(count: usize) -> Set {
    let model = teapot();
    let pot = moved(&indexed(model.positions, model.triangles), |p| p * 0.04);
    let mesh = joined(&pot, &moved(&box_grid(8), |p| p * 1e5));
    Set::new(mesh, count, 37, |sampler| {
        let (target, direction) = (on_surface(&pot, sampler), sampler.direction());
        Ray::new(target - direction * 7e4, direction)
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
    let triangles = soup_triangles(300, 39).enumerate().map(|(i, [a, b, c])| match i % 10 {
        0 => [far(&mut sampler), b, c],
        1 => [far(&mut sampler), far(&mut sampler), c],
        _ => [a, b, c],
    });
    Set::new(mesh(triangles), count, 40, |sampler| ray_to(sampler.direction() * 3.0, sampler.cube()))
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
