//! Generators of numbers, rays and triangles for tests.

mod closed;
mod eight_rays;
mod every;
mod exact;
mod f64_bounds;
mod filter;

use glam::Vec3;
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

use super::*;
use crate::exact::{self as judge, rational};

pub(crate) type Number = fn(&mut Pcg32) -> f32;

pub(crate) fn unit(rng: &mut Pcg32) -> f32 {
    rng.next_u32() as f32 / u32::MAX as f32 * 2.0 - 1.0
}

/// Small integers often give hits on edges and corners.
pub(crate) fn grid(rng: &mut Pcg32) -> f32 {
    (rng.next_u32() % 5) as f32 - 2.0
}

pub(crate) fn any(rng: &mut Pcg32) -> f32 {
    loop {
        let x = f32::from_bits(rng.next_u32());
        if x.is_finite() {
            return x;
        }
    }
}

pub(crate) fn point(rng: &mut Pcg32, number: Number) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|_| number(rng)))
}

pub(crate) fn triangle(rng: &mut Pcg32, number: Number) -> [Vec3; 3] {
    std::array::from_fn(|_| point(rng, number))
}

pub(crate) fn ray(rng: &mut Pcg32, number: Number) -> Ray {
    Ray::new(point(rng, number), point(rng, number))
}

fn aimed(rng: &mut Pcg32, [a, b, c]: [Vec3; 3]) -> Ray {
    let (u, v) = (unit(rng) * 0.7 + 0.3, unit(rng) * 0.7 + 0.3);
    let target = a + (b - a) * u + (c - a) * v;
    let origin = target + point(rng, unit) * libm::exp2f((rng.next_u32() % 40) as f32 - 20.0);
    Ray::new(origin, (target - origin) * libm::exp2f((rng.next_u32() % 40) as f32 - 20.0))
}

fn true_t(ray: &Ray, corners: [Vec3; 3]) -> Option<f32> {
    judge::hit(ray, corners).filter(|t| ray.is_valid() && t.is_within(ray)).map(|t| t.round())
}

fn hard(rng: &mut Pcg32, round: usize) -> (Ray, [Vec3; 3]) {
    let scale = f32::from_bits((1 + rng.next_u32() % 251) << 23);
    match round % 4 {
        0 => (ray(rng, any), triangle(rng, any)),
        1 => {
            let corners = triangle(rng, unit).map(|p| p * scale);
            (aimed(rng, corners), corners)
        }
        2 => {
            let shift = point(rng, unit) * (scale * 1e3);
            let [a, b, _] = triangle(rng, unit).map(|p| p * scale + shift);
            let corners = [a, b, a + (b - a) * unit(rng) + point(rng, unit) * (scale * 1e-6)];
            (aimed(rng, corners), corners)
        }
        _ => {
            let corners = triangle(rng, grid);
            let origin = point(rng, grid);
            let target = corners[round / 4 % 3]
                + (corners[(round / 4 + 1) % 3] - corners[round / 4 % 3]) * (rng.next_u32() % 3) as f32 * 0.5;
            (Ray::new(origin * scale, (target - origin) * scale), corners.map(|p| p * scale))
        }
    }
}
