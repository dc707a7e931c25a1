use std::sync::Arc;

use super::StudyError;
use crate::accel::DynAccel;
use crate::measure::{Clock, CpuClock, Threads, median};
use crate::registry::Choice;
use crate::scene::Scene;

/// A finished structure, and how long it took.
pub struct Built {
    pub choice: Choice,
    pub accel: Box<dyn DynAccel>,
    /// Nanoseconds, seen from outside; the median where there were several builds.
    pub build_ns: u64,
}

/// A build as short as this is repeated, for a steadier median.
const SHORT_BUILD_NS: u64 = 20_000_000;

impl Built {
    /// Builds once, or three times when that takes no time.
    pub fn new(choice: &Choice, scene: &Scene, threads: &Threads, clock: &dyn Clock) -> Result<Self, StudyError> {
        let mut times = vec![];
        loop {
            let built = Self::once(choice, scene, threads, clock)?;
            times.push(built.build_ns as f64);
            if built.build_ns > SHORT_BUILD_NS || times.len() == 3 {
                let build_ns = median(&times).expect("there is a build") as u64;
                return Ok(Self { build_ns, ..built });
            }
        }
    }

    /// Builds once.
    pub fn once(choice: &Choice, scene: &Scene, threads: &Threads, clock: &dyn Clock) -> Result<Self, StudyError> {
        let mesh = Arc::clone(&scene.mesh);
        // As for rays: what others take of the core of a single thread is no time of the build.
        let own = CpuClock::of_process(threads);
        let clock = own.as_ref().map_or(clock, |clock| clock as &dyn Clock);
        let start = clock.now_ns();
        let accel = threads.install(|| choice.build(&mesh));
        let build_ns = clock.now_ns() - start;
        let accel = accel.map_err(|cause| StudyError::Build {
            structure: choice.label.clone(),
            scene: scene.name.clone(),
            cause,
        })?;
        Ok(Self { choice: choice.clone(), accel, build_ns })
    }
}
