//! The input of the generators of workloads.

use super::sampler::Sampler;
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
