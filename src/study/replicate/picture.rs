//! The rays of a picture.

use super::Rays;
use crate::accel::{DynAccel, Query};
use crate::scene::{Sampling, Scene, Workload, WorkloadKind};

/// All rays that the report counts, on its 512 x 512 pixels.
pub(in crate::study) struct Picture {
    /// Primary and mirror rays, which ask for the closest hit, and shadow rays, which ask for any; neither where there are none.
    pub workloads: Vec<Workload>,
    primary: usize,
}

impl Picture {
    const SIZE: [u32; 2] = [512, 512];

    /// Primary, mirror and shadow rays; `guide`, built over the scene's mesh, finds where they start.
    pub fn whole(scene: &Scene, guide: &dyn DynAccel) -> Self {
        Self::new(scene, guide, &[WorkloadKind::Image, WorkloadKind::ImageShadow])
    }

    /// Primary rays alone.
    pub fn primary(scene: &Scene, guide: &dyn DynAccel) -> Self {
        Self::new(scene, guide, &[WorkloadKind::Primary])
    }

    fn new(scene: &Scene, guide: &dyn DynAccel, kinds: &[WorkloadKind]) -> Self {
        let rays = |&kind: &WorkloadKind| Workload::new(scene, kind, &Self::sampling(scene), guide);
        let mut workloads: Vec<Workload> = kinds.iter().map(rays).collect();
        workloads.retain(|workload| !workload.rays.is_empty());
        Self { workloads, primary: (Self::SIZE[0] * Self::SIZE[1]) as usize }
    }

    fn sampling(scene: &Scene) -> Sampling {
        Sampling { size: Self::SIZE, ..Sampling::of(scene) }
    }

    /// All rays.
    pub fn total(&self) -> u64 {
        self.asked(Query::Closest) + self.asked(Query::Any)
    }

    /// The rays that ask `query`.
    fn asked(&self, query: Query) -> u64 {
        let asked = self.workloads.iter().filter(|workload| workload.query == query);
        asked.map(|workload| workload.rays.len() as u64).sum()
    }

    /// The row of the ray table; `report` is the report's total.
    pub fn rays(&self, scene: &Scene, report: u64) -> Rays {
        Rays {
            scene: scene.name.clone(),
            primary: self.primary as u64,
            mirror: self.asked(Query::Closest) - self.primary as u64,
            shadow: self.asked(Query::Any),
            total: self.total(),
            report,
        }
    }
}
