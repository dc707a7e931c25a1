//! All triangles in one plane, and rays across, along and nearly along it.

use glam::Vec3;

use super::case::{HardCase, added, moderate};
use super::set::{Set, moved, sheet, tilted};
use crate::geometry::Ray;
use crate::validate::Sampler;
use crate::validate::degenerate::coplanar;

pub(super) const CASES: &[HardCase] = &[
    moderate(10, "flat_down")
        .all_hit(|n| Set::new(sheet(32), n, 6, |sampler| Ray::new(above(sampler, 1.0), Vec3::new(0.0, 0.0, -1.0))))
        .because("The root box has no thickness: an interval of one point must not count as empty.")
        .source("Hapala, Havran 2011: flat cells"),
    moderate(11, "flat_inplane")
        .all_miss(|n| {
            Set::new(sheet(32), n, 7, |sampler| {
                let direction = sampler.direction();
                Ray::new(above(sampler, 0.0), Vec3::new(direction.x, direction.y, 0.0))
            })
        })
        .because("A ray in the plane of every triangle meets none in a point: the determinant is 0.")
        .source("Möller, Trumbore 1997"),
    moderate(12, "flat_grazing_1e-3")
        .by_oracle(|n| grazing(n, 1e-3))
        .because("Rays at a slope of 1e-3 on a tilted plane: the determinant loses ten bits.")
        .source("Embree issue 387"),
    moderate(13, "flat_grazing_1e-6")
        .by_oracle(|n| grazing(n, 1e-6))
        .because(
            "At a slope of 1e-6 the determinant is all rounding: t is wrong by a hundred thousand \
             ulps, hits are missed and invented.",
        )
        .source("Embree issue 387; measured: 55 to 75 % of the depths wrong in every f32 system"),
    moderate(42, "coplanar_overlap_200")
        .by_oracle(|n| {
            let mesh = coplanar(200, Vec3::new(0.9, 0.1, 0.3), Vec3::new(-0.2, 0.8, 0.7));
            Set::new(mesh, n, 8, |sampler| {
                let normal = Vec3::new(-0.17, -0.69, 0.74);
                let target = Vec3::new(0.9, 0.1, 0.3) * sampler.signed() * 4.0
                    + Vec3::new(-0.2, 0.8, 0.7) * sampler.signed() * 4.0;
                let direction = normal * sampler.sign() + sampler.cube() * 0.5;
                Ray::new(target - direction * 3.0, direction)
            })
        })
        .at_most(2000)
        .because("Overlapping triangles of one tilted plane: which is nearer is below the rounding of t.")
        .source("survey"),
    added(79, "planar_in_split_plane")
        .by_oracle(|n| {
            let mesh = moved(&sheet(32), |p| Vec3::new(0.5, p.x, p.y));
            Set::new(mesh, n, 9, |sampler| {
                // Every other ray starts in the plane.
                let x = if sampler.coin() { 0.5 } else { 0.5 + 2.0 * sampler.signed() };
                Ray::new(Vec3::new(x, sampler.signed(), sampler.signed()), sampler.direction())
            })
        })
        .because("All triangles lie in the only plane across x that can split, and belong to neither side.")
        .source("Wald, Havran 2006: planar triangles on either side; Hapala, Havran 2011"),
];

fn above(sampler: &mut Sampler, height: f32) -> Vec3 {
    Vec3::new(sampler.signed(), sampler.signed(), height)
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
