use glam::DVec3;
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

/// Seeded random directions, with the same bits on every machine.
pub struct Sampler(Pcg32);

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
