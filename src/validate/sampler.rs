//! Seeded random values that are identical on every machine.

use glam::Vec3;
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

/// A seeded source of random values. The methods must not call functions with platform-dependent results.
pub struct Sampler(Pcg32);

impl Sampler {
    pub fn new(seed: u64) -> Self {
        Self(Pcg32::seed_from_u64(seed))
    }

    /// A multiple of 2^-24 in [0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 / (1 << 24) as f32
    }

    /// A number in [-1, 1).
    pub fn signed(&mut self) -> f32 {
        self.unit() * 2.0 - 1.0
    }

    /// An integer in [0, `n`). 0 if `n` is 0.
    pub fn below(&mut self, n: usize) -> usize {
        ((u64::from(self.0.next_u32()) * n as u64) >> 32) as usize
    }

    pub fn coin(&mut self) -> bool {
        self.0.next_u32() & 1 == 1
    }

    /// A random item. `items` must not be empty.
    pub fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }

    /// +0.0 or -0.0.
    pub fn zero(&mut self) -> f32 {
        if self.coin() { 0.0 } else { -0.0 }
    }

    pub fn sign(&mut self) -> f32 {
        if self.coin() { 1.0 } else { -1.0 }
    }

    /// A point in the cube [-1, 1)^3.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }

    /// A uniformly distributed vector of length 1, up to rounding.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let p = self.cube();
            let length_squared = p.length_squared();
            if length_squared > 1e-4 && length_squared <= 1.0 {
                return p / length_squared.sqrt();
            }
        }
    }

    pub fn point_of(&mut self, [a, b, c]: [Vec3; 3]) -> Vec3 {
        let [u, v, w] = self.barycentric();
        a * u + b * v + c * w
    }

    /// Three weights of at least -2^-24. The sum of the weights is 1 up to rounding.
    pub fn barycentric(&mut self) -> [f32; 3] {
        let (mut u, mut v) = (self.unit(), self.unit());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        [1.0 - u - v, u, v]
    }
}
