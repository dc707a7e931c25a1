//! What reviews and fuzzing of this crate have found: no failure without a name.

use glam::Vec3;

use super::case::cases;
use super::set::{Set, indexed, inside, moved, on_edge, on_surface, ray_to, star, triangle};
use crate::exact;
use crate::geometry::Ray;
use crate::validate::Sampler;
use crate::validate::adversarial::{near_the_largest_t, rounded_ends};

cases! {
    Added 85 "scale_7e-15", Hit => tiny_star,
        "Products of three lengths underflow, those of two do not: a bound on the one is none on the other.",
        "sahara, the first stage of the exact test";
    Added 86 "origins_near_the_largest", Oracle => from_the_largest,
        "The distance from the origin to a plane overflows, though the ray crosses it at t near 3.",
        "sahara, crossings of planes";
    Added 87 "beside_a_sliver", Oracle => beside_a_sliver,
        "Rays pass a sliver of 1 to 10,000 by less than f64 can tell: the band grows with the aspect ratio.",
        "an independent check: a hit 4.5e-11 outside, where a test in f64 had promised 1e-15";
    Added 88 "along_a_needle", Oracle => along_a_needle,
        "A needle of 1 to 10,000,000 met along its length: f64 has no digit of the determinant left.",
        "an independent check: a hit that a test in f64 loses";
    Added 89 "depth_on_a_needle", Oracle => depth_on_a_needle,
        "A needle grazed at a sine of 5e-3: t has half of the digits of f64, which a tolerance of 1 % hides.",
        "an independent check: t of a test in f64 115 ulps off";
    Added 90 "t_rounds_to_t_max", Hit => before_the_end,
        "The exact t lies before t_max and rounds to it, half of the time near the largest float, where crossings overflow.",
        "a user's ray: both KD-trees lost a hit just before t_max = 3.4028235e38";
}

fn tiny_star(count: usize) -> Set {
    let scale = libm::scalbnf(1.0, -47);
    let mesh = moved(&star(), |p| p * scale);
    Set::new(mesh.clone(), count, 60, |sampler| {
        let origin = inside(sampler) * scale;
        Ray::new(origin, (on_edge(&mesh, sampler) - origin) / scale)
    })
}

fn from_the_largest(count: usize) -> Set {
    let mesh = moved(&star(), |p| p * 5e36);
    Set::new(mesh.clone(), count, 61, |sampler| {
        let side = 3.39e38 * sampler.sign();
        let drift = sampler.cube() * 1e35;
        let target = on_surface(&mesh, sampler) - drift / 0.3;
        Ray::new(Vec3::new(side, target.y, target.z), Vec3::new(-0.3 * side, drift.y, drift.z))
    })
}

fn beside_a_sliver(count: usize) -> Set {
    let corners = [[0.0, 0.2331, 0.0], [1.0, 0.2341, 1.0], [1.0, 0.2331, 1.0001]];
    let first = [[1.0529697, 0.79743576, 2.6935759], [-0.052969694, -0.5633358, -1.6935759]];
    along_edges(corners, first, count, 62, |sampler, target| ray_to(target + sampler.cube(), target))
}

fn along_a_needle(count: usize) -> Set {
    let corners =
        [[249066.56, -560805.06, -789597.4], [-249066.31, 560804.8, 789596.9], [-224159.67, 504724.3, 710637.2]];
    let first = [[-0.41515878, 0.8378415, 1.5203968], [-5957.0234, 13413.253, 18885.059]];
    along_edges(corners, first, count, 63, grazing)
}

fn depth_on_a_needle(count: usize) -> Set {
    let corners =
        [[-405851.38, 785724.8, -466819.28], [405851.56, -785725.3, 466820.28], [365266.44, -707152.8, 420138.3]];
    let first = [[49.000397, -704.82355, 176.40697], [-9731.703, 19450.404, -11313.292]];
    along_edges(corners, first, count, 64, grazing)
}

fn before_the_end(count: usize) -> Set {
    let mesh = star();
    Set::new(mesh.clone(), count, 65, |sampler| {
        loop {
            let corners = triangle(&mesh, sampler);
            let [u, v, w] = sampler.barycentric();
            let target = corners[0] * u + corners[1] * v + corners[2] * w;
            let from = target + sampler.direction() * sampler.pick(&[8.0, 64.0, 1024.0]);
            let mut ray = Ray::new(from, (target - from) * (0.5 + sampler.unit()));
            if sampler.coin() {
                ray = exact::hit(&ray, corners).map_or(ray, |t| near_the_largest_t(&ray, t.approximate()));
            }
            let t =
                exact::hit(&ray, corners).filter(|t| t.round().is_finite() && t.compare(t.round()).unwrap().is_lt());
            if let Some(t) = t {
                return rounded_ends(&ray, &t)[0];
            }
        }
    })
}

/// One triangle; origin and direction of the ray that was found first, and others at or beside points of its edges.
fn along_edges(
    corners: [[f32; 3]; 3],
    first: [[f32; 3]; 2],
    count: usize,
    seed: u64,
    mut towards: impl FnMut(&mut Sampler, Vec3) -> Ray,
) -> Set {
    let (corners, [origin, direction]) = (corners.map(Vec3::from), first.map(Vec3::from));
    let mut set = Set::new(indexed(corners.into(), vec![[0, 1, 2]]), count, seed, |sampler| {
        let from = sampler.below(3);
        let target = corners[from].lerp(corners[(from + 1) % 3], sampler.unit());
        towards(sampler, target)
    });
    set.rays.iter_mut().take(1).for_each(|ray| *ray = Ray::new(origin, direction));
    set
}

/// Towards a point of a needle through zero, from near its middle.
fn grazing(sampler: &mut Sampler, target: Vec3) -> Ray {
    let origin = sampler.cube() * 100.0;
    Ray::new(origin, (target - origin) / 64.0)
}
