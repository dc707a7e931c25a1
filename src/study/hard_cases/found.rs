//! What reviews and fuzzing of this crate have found: no failure without a name.

use glam::Vec3;

use super::set::{inside, moved, on_surface, star, triangle};
use super::{Case, Content, Rank, Set};
use crate::geometry::Ray;

pub(super) const CASES: &[Case] = &[
    Case {
        number: 85,
        name: "scale_7e-15",
        rank: Rank::Added,
        content: Content::hit(|n| {
            let scale = libm::scalbnf(1.0, -47);
            let mesh = moved(&star(), |p| p * scale);
            Set::new(mesh.clone(), n, 60, |sampler| {
                let (origin, [a, b, _]) = (inside(sampler) * scale, triangle(&mesh, sampler));
                Ray::new(origin, (a.lerp(b, sampler.unit()) - origin) / scale)
            })
        }),
        reason: "Products of three lengths underflow, those of two do not: a bound on the one is none on the other.",
        source: "sahara, the first stage of the exact test",
    },
    Case {
        number: 86,
        name: "origins_near_the_largest",
        rank: Rank::Added,
        content: Content::oracle(|n| {
            let mesh = moved(&star(), |p| p * 5e36);
            Set::new(mesh.clone(), n, 61, |sampler| {
                let side = 3.39e38 * sampler.sign();
                let drift = sampler.cube() * 1e35;
                let target = on_surface(&mesh, sampler) - drift / 0.3;
                Ray::new(Vec3::new(side, target.y, target.z), Vec3::new(-0.3 * side, drift.y, drift.z))
            })
        }),
        reason: "The distance from the origin to a plane overflows, though the ray crosses it at t near 3.",
        source: "sahara, crossings of planes",
    },
];
