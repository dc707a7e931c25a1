//! What reviews and fuzzing of this crate have found: no failure without a name.

use glam::Vec3;

use super::case::{HardCase, added};
use super::set::{Set, indexed, inside, moved, on_surface, star, triangle};
use crate::geometry::Ray;
use crate::validate::Sampler;

pub(super) const CASES: &[HardCase] = &[
    added(85, "scale_7e-15")
        .all_hit(|n| {
            let scale = libm::scalbnf(1.0, -47);
            let mesh = moved(&star(), |p| p * scale);
            Set::new(mesh.clone(), n, 60, |sampler| {
                let (origin, [a, b, _]) = (inside(sampler) * scale, triangle(&mesh, sampler));
                Ray::new(origin, (a.lerp(b, sampler.unit()) - origin) / scale)
            })
        })
        .because("Products of three lengths underflow, those of two do not: a bound on the one is none on the other.")
        .source("sahara, the first stage of the exact test"),
    added(86, "origins_near_the_largest")
        .by_oracle(|n| {
            let mesh = moved(&star(), |p| p * 5e36);
            Set::new(mesh.clone(), n, 61, |sampler| {
                let side = 3.39e38 * sampler.sign();
                let drift = sampler.cube() * 1e35;
                let target = on_surface(&mesh, sampler) - drift / 0.3;
                Ray::new(Vec3::new(side, target.y, target.z), Vec3::new(-0.3 * side, drift.y, drift.z))
            })
        })
        .because("The distance from the origin to a plane overflows, though the ray crosses it at t near 3.")
        .source("sahara, crossings of planes"),
    added(87, "beside_a_sliver")
        .by_oracle(|n| {
            let [a, b, c] = [Vec3::new(0.0, 0.2331, 0.0), Vec3::new(1.0, 0.2341, 1.0), Vec3::new(1.0, 0.2331, 1.0001)];
            let first =
                Ray::new(Vec3::new(1.0529697, 0.79743576, 2.6935759), Vec3::new(-0.052969694, -0.5633358, -1.6935759));
            along_edges([a, b, c], first, n, 62, |sampler, target| {
                let origin = target + sampler.cube();
                Ray::new(origin, target - origin)
            })
        })
        .because("Rays pass a sliver of 1 to 10,000 by less than f64 can tell: the band grows with the aspect ratio.")
        .source("an independent check: a hit 4.5e-11 outside, where a test in f64 had promised 1e-15"),
    added(88, "along_a_needle")
        .by_oracle(|n| {
            let corners = [
                Vec3::new(249066.56, -560805.06, -789597.4),
                Vec3::new(-249066.31, 560804.8, 789596.9),
                Vec3::new(-224159.67, 504724.3, 710637.2),
            ];
            let first =
                Ray::new(Vec3::new(-0.41515878, 0.8378415, 1.5203968), Vec3::new(-5957.0234, 13413.253, 18885.059));
            along_edges(corners, first, n, 63, grazing)
        })
        .because("A needle of 1 to 10,000,000 met along its length: f64 has no digit of the determinant left.")
        .source("an independent check: a hit that a test in f64 loses"),
    added(89, "depth_on_a_needle")
        .by_oracle(|n| {
            let corners = [
                Vec3::new(-405851.38, 785724.8, -466819.28),
                Vec3::new(405851.56, -785725.3, 466820.28),
                Vec3::new(365266.44, -707152.8, 420138.3),
            ];
            let first =
                Ray::new(Vec3::new(49.000397, -704.82355, 176.40697), Vec3::new(-9731.703, 19450.404, -11313.292));
            along_edges(corners, first, n, 64, grazing)
        })
        .because("A needle grazed at a sine of 5e-3: t has half of the digits of f64, which a tolerance of 1 % hides.")
        .source("an independent check: t of a test in f64 115 ulps off"),
];

/// One triangle; the ray that was found first, and others at or beside points of its edges.
fn along_edges(
    corners: [Vec3; 3],
    first: Ray,
    count: usize,
    seed: u64,
    mut towards: impl FnMut(&mut Sampler, Vec3) -> Ray,
) -> Set {
    let mut set = Set::new(indexed(corners.into(), vec![[0, 1, 2]]), count, seed, |sampler| {
        let from = sampler.below(3);
        let target = corners[from].lerp(corners[(from + 1) % 3], sampler.unit());
        towards(sampler, target)
    });
    set.rays.iter_mut().take(1).for_each(|ray| *ray = first);
    set
}

/// Towards a point of a needle through zero, from near its middle.
fn grazing(sampler: &mut Sampler, target: Vec3) -> Ray {
    let origin = sampler.cube() * 100.0;
    Ray::new(origin, (target - origin) / 64.0)
}
