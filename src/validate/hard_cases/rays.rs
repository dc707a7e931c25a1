//! Generates rays for the hard cases.

use glam::Vec3;

use super::meshes::{indexed, joined, moved, pot, sphere, star, star_times, strips, tilted};
use super::set::{Set, on_edge, on_surface, ray_to, triangle};
use crate::exact;
use crate::geometry::{Mesh, Ray};
use crate::validate::Sampler;
use crate::validate::adversarial::{near_the_largest_t, rounded_ends};
use crate::validate::degenerate::{TRIANGLE, box_grid, coplanar};

/// A random point at most 0.5 from (0, 0, 0).
pub(super) fn inside(sampler: &mut Sampler) -> Vec3 {
    sampler.direction() * (0.5 * sampler.unit())
}

/// Rays that start inside a sphere.
pub(super) fn in_sphere(count: usize, centre: Vec3, radius: f32) -> Set {
    let mesh = moved(&sphere(), |p| centre + p * radius);
    Set::new(mesh, count, 2, |_, sampler| Ray::new(centre + inside(sampler) * radius, sampler.direction()))
}

pub(super) fn nearly_axis(sampler: &mut Sampler, tiny: f32) -> Vec3 {
    let mut direction = sampler.cube() * tiny;
    direction[sampler.below(3)] = sampler.sign();
    direction
}

/// One component of the direction is 1 or -1. The other two components are `zero`.
pub(super) fn along_axis(sampler: &mut Sampler, zero: f32) -> Vec3 {
    let mut direction = Vec3::splat(zero);
    direction[sampler.below(3)] = sampler.sign();
    direction
}

/// A random multiple of 1/8 in [-1, 1].
fn on_grid(sampler: &mut Sampler) -> f32 {
    sampler.below(17) as f32 / 8.0 - 1.0
}

/// A ray parallel to an axis. The ray meets the cube [-1, 1]^3 at t = 2. The zeros of a negative direction are -0.0.
pub(super) fn face_plane(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let (axis, sign) = (sampler.below(3), sampler.sign());
    let mut origin = [on_grid(sampler), on_grid(sampler), -3.0 * sign];
    origin.rotate_left(2 - axis);
    Ray::new(Vec3::from_array(origin), Vec3::AXES[axis] * sign)
}

/// A diagonal ray that passes through a grid point at t = 4. If `flat`, one component of the direction is zero.
pub(super) fn diagonal(sampler: &mut Sampler, flat: bool) -> Ray {
    let through = Vec3::new(on_grid(sampler), on_grid(sampler), on_grid(sampler));
    let mut direction = Vec3::new(sampler.sign(), sampler.sign(), sampler.sign());
    if flat {
        direction[sampler.below(3)] = 0.0;
    }
    Ray::new(through - direction * 4.0, direction)
}

pub(super) fn at_height(sampler: &mut Sampler, height: f32) -> Vec3 {
    Vec3::new(sampler.signed(), sampler.signed(), height)
}

pub(super) fn in_plane(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let direction = sampler.direction();
    Ray::new(at_height(sampler, 0.0), Vec3::new(direction.x, direction.y, 0.0))
}

pub(super) fn at_slope(sampler: &mut Sampler, slope: f32) -> Ray {
    let direction = sampler.direction();
    let flat = Vec3::new(direction.x, direction.y, 0.0).normalize_or(Vec3::X);
    let direction = tilted(flat) - tilted(Vec3::Z) * slope;
    Ray::new(tilted(at_height(sampler, 0.0)) - direction, direction)
}

pub(super) fn overlapping(count: usize) -> Set {
    let (u, v, normal) = (Vec3::new(0.9, 0.1, 0.3), Vec3::new(-0.2, 0.8, 0.7), Vec3::new(-0.17, -0.69, 0.74));
    Set::new(coplanar(200, u, v), count, 8, |_, sampler| {
        let target = u * sampler.signed() * 4.0 + v * sampler.signed() * 4.0;
        let direction = normal * sampler.sign() + sampler.cube() * 0.5;
        Ray::new(target - direction * 3.0, direction)
    })
}

/// With probability 1/2, the origin of the ray lies in the plane x = 0.5.
pub(super) fn from_split_plane(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let x = if sampler.coin() { 0.5 } else { 0.5 + 2.0 * sampler.signed() };
    Ray::new(Vec3::new(x, sampler.signed(), sampler.signed()), sampler.direction())
}

pub(super) fn scaled(count: usize, scale: f32) -> Set {
    Set::new(star_times(scale), count, 11, |_, sampler| Ray::new(inside(sampler) * scale, sampler.direction()))
}

pub(super) fn long(count: usize, length: f32) -> Set {
    Set::new(star(), count, 11, |_, sampler| Ray::new(inside(sampler), sampler.direction() * length))
}

pub(super) fn slivers(count: usize, placed: fn(Vec3) -> Vec3) -> Set {
    Set::new(moved(&strips(), placed), count, 12, |_, sampler| {
        let target = Vec3::new(1000.0 * sampler.unit(), sampler.unit(), 0.0);
        let from = target + Vec3::new(sampler.signed(), sampler.signed(), 10.0 * (1.0 + sampler.unit()));
        Ray::new(placed(from), placed(target) - placed(from))
    })
}

pub(super) fn below(sampler: &mut Sampler) -> Vec3 {
    Vec3::new(sampler.signed(), sampler.signed(), -3.0 - 2.0 * sampler.unit())
}

/// A ray to a point inside `TRIANGLE`.
pub(super) fn to_copies(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let ([a, b, c], [u, v, w]) = (TRIANGLE, sampler.barycentric().map(|weight| 0.2 + 0.4 * weight));
    let origin = Vec3::new(sampler.signed(), sampler.signed(), 4.0 * sampler.sign());
    ray_to(origin, a * u + b * v + c * w)
}

pub(super) fn to_line(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let target = Vec3::new(50.0 * sampler.unit(), 0.0, 0.001 * sampler.unit());
    ray_to(target + Vec3::new(sampler.signed(), sampler.sign(), sampler.signed()), target)
}

pub(super) fn to_surface(mesh: &Mesh, sampler: &mut Sampler) -> Ray {
    let (centre, reach) = (mesh.bounds().centre(), mesh.bounds().extent().max_element());
    ray_to(centre + sampler.direction() * reach, on_surface(mesh, sampler))
}

/// The points at eighths of the edges are exact floats.
pub(super) const SIMPLE: [Vec3; 3] = [Vec3::ZERO, Vec3::new(8.0, 0.0, 4.0), Vec3::new(0.0, 8.0, -4.0)];

/// A ray that meets an edge or a vertex of `SIMPLE` at exactly t = 1.
pub(super) fn exactly_on_the_rim(_: &Mesh, sampler: &mut Sampler) -> Ray {
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

pub(super) fn from_afar(mesh: &Mesh, sampler: &mut Sampler, distance: f32) -> Ray {
    let direction = sampler.direction();
    Ray::new(on_surface(mesh, sampler) - direction * distance, direction)
}

pub(super) fn among_shells(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let inside = libm::scalbnf(0.1, sampler.below(61) as i32 - 30);
    Ray::new(sampler.cube() * inside, sampler.direction())
}

pub(super) fn around_shells(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let outermost = libm::scalbnf(1.0, 30);
    let origin = sampler.direction() * (2.0 * outermost);
    let target = sampler.cube() * (0.3 * outermost);
    Ray::new(origin, (target - origin) / outermost)
}

pub(super) fn stadium(count: usize) -> Set {
    let pot = pot();
    Set::new(joined(&pot, &moved(&box_grid(8), |p| p * 1e5)), count, 37, |_, sampler| {
        let (target, direction) = (on_surface(&pot, sampler), sampler.direction());
        Ray::new(target - direction * 7e4, direction)
    })
}

pub(super) fn through_smaller(mesh: &Mesh, sampler: &mut Sampler) -> Ray {
    let [corner, ..] = mesh.corners(sampler.below(300) as u32);
    let side = |sampler: &mut Sampler| 0.05 + 0.2 * sampler.unit();
    let from = Vec3::new(1.3, side(sampler), side(sampler));
    Ray::new(from * corner.x, -from)
}

pub(super) fn along_chain(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let at = libm::scalbnf(1.25, sampler.below(120) as i32 - 60);
    let across = Vec3::new(0.0, sampler.signed(), sampler.signed()) * 0.25;
    Ray::new(Vec3::new(at, 0.0, 0.0) + across * at, Vec3::X + across)
}

pub(super) fn window(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let ray = ray_to(sampler.direction() * 3.0, sampler.cube() * 0.3);
    if sampler.coin() { ray.until(1.0) } else { Ray { t_min: 1.0, ..ray } }
}

/// A ray to the plane z = 1. `interval` computes `t_min` and `t_max` from the exact `t` at this plane.
pub(super) fn to_the_lid(sampler: &mut Sampler, interval: fn(f32) -> (f32, f32)) -> Ray {
    let grid = |sampler: &mut Sampler| sampler.below(65) as f32 / 64.0 - 0.5;
    let origin = Vec3::new(grid(sampler), grid(sampler), grid(sampler));
    let direction = Vec3::new(0.25 * grid(sampler), 0.25 * grid(sampler), 0.5);
    let (t_min, t_max) = interval((1.0 - origin.z) * 2.0);
    Ray { t_min, t_max, ..Ray::new(origin, direction) }
}

pub(super) fn just_above(_: &Mesh, sampler: &mut Sampler) -> Ray {
    let height = sampler.pick(&[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7]);
    Ray::new(at_height(sampler, height), Vec3::NEG_Z)
}

pub(super) fn from_the_root_box(mesh: &Mesh, sampler: &mut Sampler) -> Ray {
    let (bounds, axis) = (mesh.bounds(), sampler.below(3));
    let mut origin = bounds.centre() + bounds.extent() * 0.5 * sampler.cube();
    origin[axis] = if sampler.coin() { bounds.min[axis] } else { bounds.max[axis] };
    ray_to(origin, on_surface(mesh, sampler))
}

pub(super) fn off_a_sphere(mesh: &Mesh, sampler: &mut Sampler) -> Ray {
    let (origin, direction) = (on_surface(mesh, sampler), sampler.direction());
    Ray::new(origin, if direction.dot(origin) < 0.0 { -direction } else { direction })
}

/// The function `spoil` makes each ray invalid. `Set::ordinary` contains the unchanged, valid rays.
pub(super) fn spoilt(count: usize, spoil: fn(&mut Sampler, &mut Ray)) -> Set {
    let mut ordinary = vec![];
    let set = Set::new(star(), count, 60, |_, sampler| {
        let mut ray = ray_to(sampler.direction() * 8.0, sampler.cube() * 3.0);
        ordinary.push(ray);
        spoil(sampler, &mut ray);
        ray
    });
    Set { ordinary, ..set }
}

pub(super) fn infinity(sampler: &mut Sampler) -> f32 {
    sampler.sign() * f32::INFINITY
}

pub(super) fn spoil_interval(sampler: &mut Sampler, ray: &mut Ray) {
    match sampler.below(3) {
        0 => ray.t_min = f32::NAN,
        1 => ray.t_max = f32::NAN,
        _ => (ray.t_min, ray.t_max) = (f32::NAN, f32::NAN),
    }
}

/// The scale of the star is so small that products of three lengths underflow.
pub(super) fn in_tiny_star(count: usize) -> Set {
    let scale = libm::scalbnf(1.0, -47);
    Set::new(star_times(scale), count, 60, |mesh, sampler| {
        let origin = inside(sampler) * scale;
        Ray::new(origin, (on_edge(mesh, sampler) - origin) / scale)
    })
}

pub(super) fn from_the_largest(mesh: &Mesh, sampler: &mut Sampler) -> Ray {
    let side = 3.39e38 * sampler.sign();
    let drift = sampler.cube() * 1e35;
    let target = on_surface(mesh, sampler) - drift / 0.3;
    Ray::new(Vec3::new(side, target.y, target.z), Vec3::new(-0.3 * side, drift.y, drift.z))
}

/// Rays to the edges of a triangle. `first` is the origin and the direction of the first ray.
pub(super) fn along_edges(
    count: usize,
    seed: u64,
    corners: [[f32; 3]; 3],
    first: [[f32; 3]; 2],
    towards: fn(&mut Sampler, Vec3) -> Ray,
) -> Set {
    let (corners, [origin, direction]) = (corners.map(Vec3::from), first.map(Vec3::from));
    let mut set = Set::new(indexed(corners.into(), vec![[0, 1, 2]]), count, seed, |_, sampler| {
        let from = sampler.below(3);
        let target = corners[from].lerp(corners[(from + 1) % 3], sampler.unit());
        towards(sampler, target)
    });
    set.rays.iter_mut().take(1).for_each(|ray| *ray = Ray::new(origin, direction));
    set
}

pub(super) fn along_needle(sampler: &mut Sampler, target: Vec3) -> Ray {
    let origin = sampler.cube() * 100.0;
    Ray::new(origin, (target - origin) / 64.0)
}

/// A ray whose exact hit lies before `t_max`. The `t` of the hit rounds to `t_max`.
pub(super) fn before_the_end(mesh: &Mesh, sampler: &mut Sampler) -> Ray {
    loop {
        let corners = triangle(mesh, sampler);
        let target = sampler.point_of(corners);
        let from = target + sampler.direction() * sampler.pick(&[8.0, 64.0, 1024.0]);
        let mut ray = Ray::new(from, (target - from) * (0.5 + sampler.unit()));
        if sampler.coin() {
            ray = exact::hit(&ray, corners).map_or(ray, |t| near_the_largest_t(&ray, t.approximate()));
        }
        let t = exact::hit(&ray, corners).filter(|t| t.round().is_finite() && t.compare(t.round()).unwrap().is_lt());
        if let Some(t) = t {
            return rounded_ends(&ray, &t)[0];
        }
    }
}
