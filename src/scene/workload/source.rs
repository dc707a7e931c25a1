//! What the rays of a workload are made from.

use super::sampler::Sampler;
use crate::accel::DynAccel;
use crate::scene::Scene;

/// How many rays a workload gets, and its random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampling {
    /// Width and height of the picture whose hits secondary rays start from; random and lattice rays are as many as it
    /// has pixels.
    pub size: [u32; 2],
    /// No more rays than this, spread evenly over the workload.
    pub limit: usize,
    pub seed: u64,
}

impl Sampling {
    /// All rays of the picture that the scene asks for.
    pub fn of(scene: &Scene) -> Self {
        Self { size: scene.size, limit: usize::MAX, seed: 0 }
    }

    /// At most `limit` of them, picked at equal distances: to check answers, not to take times.
    pub fn some(scene: &Scene, limit: usize, seed: u64) -> Self {
        Self { limit, seed, ..Self::of(scene) }
    }

    pub(super) fn pixels(&self) -> u32 {
        self.size[0] * self.size[1]
    }
}

pub(super) struct Source<'a> {
    pub scene: &'a Scene,
    /// How many rays; [`Sampling::limit`] is applied to what the function returns.
    pub sampling: &'a Sampling,
    /// Finds the hits that secondary rays start from.
    pub accel: &'a dyn DynAccel,
    /// Random numbers of the kind's own.
    pub sampler: Sampler,
}
