//! The input of the generators of workloads.

use glam::DVec3;
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

use crate::accel::DynAccel;
use crate::scene::Scene;

/// The number of rays of a workload, and its random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Width and height of the picture whose hits are the origins of secondary rays; there are as many random and
    /// lattice rays as pixels.
    pub size: [u32; 2],
    /// The maximum number of rays; they are evenly spread over the workload.
    pub limit: usize,
    pub seed: u64,
}

impl Sampling {
    /// All rays of the scene's picture.
    pub fn of(scene: &Scene) -> Self {
        Self { size: scene.size, limit: usize::MAX, seed: 0 }
    }

    /// At most `limit` of the rays at equal distances: for checking hits, not for measuring times.
    pub fn some(scene: &Scene, limit: usize, seed: u64) -> Self {
        Self { limit, seed, ..Self::of(scene) }
    }

    pub(super) fn pixels(&self) -> u32 {
        self.size[0] * self.size[1]
    }
}

pub(super) struct Source<'a> {
    pub scene: &'a Scene,
    /// The number of rays; [`Sampling::limit`] is applied to the rays that the generator of the workload returns.
    pub sampling: &'a Sampling,
    /// The structure that finds the hits at which secondary rays start.
    pub accel: &'a dyn DynAccel,
    /// The random numbers of this kind of workload.
    pub sampler: Sampler,
}

/// Seeded random directions, with the same bits on every machine.
pub(super) struct Sampler(Pcg32);

impl Sampler {
    /// The random numbers of the workload `name`, independent of other names.
    pub fn new(name: &str, seed: u64) -> Self {
        let mixed = name.bytes().fold(seed, |mixed, byte| mixed.wrapping_mul(0x0100_0000_01b3) ^ u64::from(byte));
        Self(Pcg32::seed_from_u64(mixed))
    }

    fn signed(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / f64::from(1u32 << 31) - 1.0
    }

    /// A uniform direction of unit length: a point of the ball by rejection sampling, normalised.
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
