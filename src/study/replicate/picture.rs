//! The rays of a picture.

use super::Rays;
use crate::accel::DynAccel;
use crate::geometry::Ray;
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};

/// All rays that the report counts, on its 512 x 512 pixels.
pub(in crate::study) struct Picture {
    /// Primary and mirror rays.
    pub closest: Vec<Ray>,
    /// Shadow rays.
    pub any: Vec<Ray>,
    primary: usize,
}

impl Picture {
    const SIZE: [u32; 2] = [512, 512];

    /// Primary, mirror and shadow rays; `guide`, built over the scene's mesh, finds where they start.
    pub fn whole(scene: &Scene, guide: &dyn DynAccel) -> Self {
        let rays = |kind| Workload::new(scene, kind, &Self::sampling(scene), guide).rays;
        let [closest, any] = [WorkloadKind::Image, WorkloadKind::ImageShadow].map(rays);
        Self { closest, any, primary: (Self::SIZE[0] * Self::SIZE[1]) as usize }
    }

    /// Primary rays alone.
    pub fn primary(scene: &Scene, guide: &dyn DynAccel) -> Self {
        let closest = Workload::new(scene, WorkloadKind::Primary, &Self::sampling(scene), guide).rays;
        Self { primary: closest.len(), closest, any: vec![] }
    }

    fn sampling(scene: &Scene) -> Sampling {
        Sampling { size: Self::SIZE, ..Sampling::of(scene) }
    }

    /// All rays.
    pub fn total(&self) -> u64 {
        (self.closest.len() + self.any.len()) as u64
    }

    /// The row of the ray table; `report` is the report's total.
    pub fn rays(&self, scene: &Scene, report: u64) -> Rays {
        Rays {
            scene: scene.name.clone(),
            primary: self.primary as u64,
            mirror: (self.closest.len() - self.primary) as u64,
            shadow: self.any.len() as u64,
            total: self.total(),
            report,
        }
    }
}
