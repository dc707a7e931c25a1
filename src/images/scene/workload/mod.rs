//! Workloads: sets of rays with one query.

mod bounces;
mod kinds;
mod lines;
mod picture;
mod primary;
mod source;
#[cfg(test)]
mod tests;

use sha2::{Digest, Sha256};

use self::source::{Sampler, Source};
use super::Scene;
use super::hash::hexadecimal;
use crate::accel::{DynAccel, Query};
use crate::geometry::Ray;

pub use kinds::WorkloadKind;
pub use source::Sampling;

/// Rays with one query. The rays have the same bits on every machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Workload {
    /// [`WorkloadKind::name`], or the name from a ray file.
    pub name: String,
    pub query: Query,
    pub rays: Vec<Ray>,
}

impl Workload {
    /// `accel` must be built over the scene's mesh. Secondary rays depend on the triangle test of `accel`, and on the
    /// choice of `accel` between hits at equal `t`. The workload may be empty.
    pub fn new(scene: &Scene, kind: WorkloadKind, sampling: &Sampling, accel: &dyn DynAccel) -> Self {
        let mut source = Source { scene, sampling, accel, sampler: Sampler::new(kind.name(), sampling.seed) };
        let rays = kind.rays(&mut source);
        Self { name: kind.name().into(), query: kind.query(), rays: spread(rays, sampling.limit) }
    }

    /// All rays as little-endian `f32` values. The order in a ray is origin, `t_min`, direction, `t_max`.
    pub fn bytes(&self) -> Vec<u8> {
        let numbers = |ray: &Ray| {
            let [o, d] = [ray.origin, ray.direction];
            [o.x, o.y, o.z, ray.t_min, d.x, d.y, d.z, ray.t_max]
        };
        self.rays.iter().flat_map(numbers).flat_map(|value| value.to_bits().to_le_bytes()).collect()
    }

    pub fn hash(&self) -> String {
        hexadecimal(&Sha256::digest(self.bytes())[..8])
    }
}

fn spread(rays: Vec<Ray>, limit: usize) -> Vec<Ray> {
    if rays.len() <= limit {
        return rays;
    }
    (0..limit).map(|i| rays[(i as u128 * rays.len() as u128 / limit as u128) as usize]).collect()
}
