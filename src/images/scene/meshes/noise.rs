//! Noise as a function of position, with the same values on every machine.

use glam::{IVec3, Vec3};

/// A pseudo-random number in [0, 1) for a grid cell.
pub fn cell(x: i32, y: i32, z: i32, salt: u32) -> f32 {
    let mut h = salt.wrapping_mul(0x9E37_79B9);
    for v in [x, y, z] {
        h = (h ^ v as u32).wrapping_mul(0x85EB_CA6B);
        h ^= h >> 13;
        h = h.wrapping_mul(0xC2B2_AE35);
        h ^= h >> 16;
    }
    (h >> 8) as f32 / (1u32 << 24) as f32
}

/// Smooth noise in [-1, 1] with features of size 1.
pub fn smooth(p: Vec3, salt: u32) -> f32 {
    let floor = p.floor();
    let IVec3 { x, y, z } = floor.as_ivec3();
    let f = p - floor;
    let w = f * f * (Vec3::splat(3.0) - f * 2.0);
    let row = |y, z| cell(x, y, z, salt) * (1.0 - w.x) + cell(x + 1, y, z, salt) * w.x;
    let plane = |z| row(y, z) * (1.0 - w.y) + row(y + 1, z) * w.y;
    2.0 * (plane(z) * (1.0 - w.z) + plane(z + 1) * w.z) - 1.0
}

/// Distances from `p` to the nearest and the second nearest random point (Worley 1996). Each unit cell contains one
/// random point.
pub fn pebbles(p: Vec3, salt: u32) -> (f32, f32) {
    let base = p.floor().as_ivec3();
    let (mut first, mut second) = (f32::MAX, f32::MAX);
    for i in 0..27 {
        let c = base + IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        let jitter = |n| 0.15 + 0.7 * cell(c.x, c.y, c.z, salt + n);
        let d = (c.as_vec3() + Vec3::new(jitter(0), jitter(1), jitter(2))).distance_squared(p);
        second = second.min(d.max(first));
        first = first.min(d);
    }
    (first.sqrt(), second.sqrt())
}
