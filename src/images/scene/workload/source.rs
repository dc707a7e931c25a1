//! The input of the functions that make workloads.

use glam::DVec3;
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

use crate::accel::DynAccel;
use crate::scene::Scene;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// Maximum number of rays. A larger workload is reduced to an evenly spaced subset.
    pub limit: usize,
    pub seed: u64,
}

impl Sampling {
    pub fn of(scene: &Scene) -> Self {
        Self { size: scene.size, limit: usize::MAX, seed: 0 }
    }

    /// Use this sampling to check hits, not to measure times.
    pub fn some(scene: &Scene, limit: usize, seed: u64) -> Self {
        Self { limit, seed, ..Self::of(scene) }
    }

    pub(super) fn pixels(&self) -> u32 {
        self.size[0] * self.size[1]
    }
}

pub(super) struct Source<'a> {
    pub scene: &'a Scene,
    /// [`Workload::new`](super::Workload::new) applies `limit` after all rays are made.
    pub sampling: &'a Sampling,
    pub accel: &'a dyn DynAccel,
    pub sampler: Sampler,
}

/// Seeded random directions, with the same bits on every machine.
pub(super) struct Sampler(Pcg32);

impl Sampler {
    /// Each name gives a different sequence of random numbers.
    pub fn new(name: &str, seed: u64) -> Self {
        let mixed = name.bytes().fold(seed, |mixed, byte| mixed.wrapping_mul(0x0100_0000_01b3) ^ u64::from(byte));
        Self(Pcg32::seed_from_u64(mixed))
    }

    fn signed(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / f64::from(1u32 << 31) - 1.0
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            let point = DVec3::new(self.signed(), self.signed(), self.signed());
            let length_squared = point.length_squared();
            if length_squared > 1e-6 && length_squared <= 1.0 {
                return point / length_squared.sqrt();
            }
        }
    }
}
