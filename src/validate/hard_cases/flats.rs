//! All triangles in one plane, and rays across, along and nearly along it.

use glam::Vec3;

use super::case::cases;
use super::set::{Set, moved, sheet, tilted};
use crate::geometry::Ray;
use crate::validate::Sampler;
use crate::validate::degenerate::coplanar;

cases! {
    Moderate 10 "flat_down", Hit => |n| Set::new(sheet(32), n, 6, |sampler| Ray::new(above(sampler, 1.0), Vec3::NEG_Z)),
        "The root box has no thickness: an interval of one point must not count as empty.",
        "Hapala, Havran 2011: flat cells";
    Moderate 11 "flat_inplane", Miss => in_plane,
        "A ray in the plane of every triangle meets none in a point: the determinant is 0.",
        "Möller, Trumbore 1997";
    Moderate 12 "flat_grazing_1e-3", Oracle => |n| grazing(n, 1e-3),
        "Rays at a slope of 1e-3 on a tilted plane: the determinant loses ten bits.",
        "Embree issue 387";
    Moderate 13 "flat_grazing_1e-6", Oracle => |n| grazing(n, 1e-6),
        "At a slope of 1e-6 the determinant is all rounding: t is wrong by a hundred thousand ulps, hits are missed and \
         invented.",
        "Embree issue 387; measured: 55 to 75 % of the depths wrong in every f32 system";
    Moderate 42 "coplanar_overlap_200", Oracle x 2000 => overlapping,
        "Overlapping triangles of one tilted plane: which is nearer is below the rounding of t.",
        "survey";
    Added 79 "planar_in_split_plane", Oracle => in_split_plane,
        "All triangles lie in the only plane across x that can split, and belong to neither side.",
        "Wald, Havran 2006: planar triangles on either side; Hapala, Havran 2011";
}

fn above(sampler: &mut Sampler, height: f32) -> Vec3 {
    Vec3::new(sampler.signed(), sampler.signed(), height)
}

fn in_plane(count: usize) -> Set {
    Set::new(sheet(32), count, 7, |sampler| {
        let direction = sampler.direction();
        Ray::new(above(sampler, 0.0), Vec3::new(direction.x, direction.y, 0.0))
    })
}

fn overlapping(count: usize) -> Set {
    let (u, v, normal) = (Vec3::new(0.9, 0.1, 0.3), Vec3::new(-0.2, 0.8, 0.7), Vec3::new(-0.17, -0.69, 0.74));
    Set::new(coplanar(200, u, v), count, 8, |sampler| {
        let target = u * sampler.signed() * 4.0 + v * sampler.signed() * 4.0;
        let direction = normal * sampler.sign() + sampler.cube() * 0.5;
        Ray::new(target - direction * 3.0, direction)
    })
}

fn in_split_plane(count: usize) -> Set {
    let mesh = moved(&sheet(32), |p| Vec3::new(0.5, p.x, p.y));
    Set::new(mesh, count, 9, |sampler| {
        // Every other ray starts in the plane.
        let x = if sampler.coin() { 0.5 } else { 0.5 + 2.0 * sampler.signed() };
        Ray::new(Vec3::new(x, sampler.signed(), sampler.signed()), sampler.direction())
    })
}

/// On a tilted sheet, whose vertices the rounding takes a little out of the plane.
fn grazing(count: usize, slope: f32) -> Set {
    Set::new(moved(&sheet(32), tilted), count, 10, |sampler| {
        let direction = sampler.direction();
        let flat = Vec3::new(direction.x, direction.y, 0.0).normalize_or(Vec3::X);
        let (along, up) = (tilted(flat), tilted(Vec3::Z));
        let direction = along - up * slope;
        Ray::new(tilted(above(sampler, 0.0)) - direction, direction)
    })
}
