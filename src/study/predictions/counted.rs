//! What takes seconds to count, and no machine changes.

use serde::{Deserialize, Serialize};

use crate::accel::DynAccel;
use crate::measure::{Clock, Threads};
use crate::registry::Registry;
use crate::scene::{Scene, Workload};
use crate::study::bench::built::Built;
use crate::study::bench::counted::Counted;
use crate::study::epoch::Asked;
use crate::study::reference_structures::{REPORT_TREE, SAH_TREE};
use crate::study::replicate::original::MAIN;
use crate::study::{Stage, StudyError};

pub(super) const CROWDED: &str = "Infinitycandy";

/// The trees whose tests are counted on it: the report's, and a setting of its sweep.
pub(super) const TREES: [&str; 2] = [REPORT_TREE, "median-kd:leaf=50,threshold=0.7"];

/// The structure that finds where rays of the picture start: over the test in single precision that renderers like the
/// report's use, and over the default test, which decides rays near edges exactly.
const GUIDES: [&str; 2] = ["sah-kd:test=moller-trumbore", SAH_TREE];

/// One scene of the report.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureCounts {
    pub scene: String,
    pub triangles: usize,
    /// All rays of the picture, as a triangle test in single precision finds their starts.
    pub rays: u64,
    /// The same with the default triangle test.
    pub default_rays: u64,
    /// The report's.
    pub report_rays: u64,
    /// Triangle tests for all rays with each of the trees compared; on the crowded scene alone.
    pub tests: Vec<u64>,
}

/// Counts one of them.
///
/// # Panics
/// If it is none of the report's easy and normal scenes.
pub fn measure(
    registry: &Registry,
    scene: &Scene,
    threads: &Threads,
    clock: &dyn Clock,
    progress: &mut dyn FnMut(Stage),
) -> Result<PictureCounts, StudyError> {
    let row = MAIN.iter().find(|row| row.scene == scene.name).expect("a scene of the report");
    let build = |spec: &str| Built::new(&registry.choose(spec)?, scene, threads, clock);
    let mut picture = |guide: &str| {
        let guide = build(guide)?.accel;
        Ok::<_, StudyError>(Asked::Picture.workloads(scene, 0, guide.as_ref(), progress))
    };
    let total = |picture: &[Workload]| picture.iter().map(|workload| workload.rays.len() as u64).sum();
    let (default_picture, picture) = (picture(GUIDES[1])?, picture(GUIDES[0])?);
    let mut tests = vec![];
    for spec in TREES.iter().filter(|_| scene.name == CROWDED) {
        progress(Stage::Check(spec));
        tests.push(count(build(spec)?.accel.as_ref(), &picture));
    }
    Ok(PictureCounts {
        scene: scene.name.clone(),
        triangles: scene.mesh.len(),
        rays: total(&picture),
        default_rays: total(&default_picture),
        report_rays: row.rays,
        tests,
    })
}

fn count(accel: &dyn DynAccel, picture: &[Workload]) -> u64 {
    let counted = picture.iter().map(|workload| Counted::new(accel, &workload.rays, workload.query));
    counted.map(|counted| counted.counts.tests).sum()
}
