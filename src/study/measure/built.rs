use std::sync::Arc;

use crate::accel::{BuildError, DynAccel, Remote};
use crate::measure::{Clock, CpuClock, Threads, median, peak_bytes};
use crate::registry::Choice;
use crate::scene::Scene;

/// A finished structure and its build time.
pub struct Built {
    pub choice: Choice,
    pub accel: Box<dyn DynAccel>,
    /// Build time, ns; for a runner, the time that it reports. If the build is repeated, the median.
    pub build_ns: u64,
    /// Peak memory in bytes, of the first build whose peak is known; `None` if no peak is known.
    pub peak_bytes: Option<usize>,
}

/// A build that takes at most this long is repeated, because short times vary more.
const SHORT_BUILD_NS: u64 = 20_000_000;

impl Built {
    /// Builds once, or up to three times if the builds are short.
    pub fn new(choice: &Choice, scene: &Scene, threads: &Threads, clock: &dyn Clock) -> Result<Self, BuildError> {
        Self::repeated(|_| Self::once(choice, scene, threads, clock))
    }

    /// Like [`new`](Self::new), and counts the peak memory: that slows a build by less than build times vary.
    pub fn counted(choice: &Choice, scene: &Scene, threads: &Threads, clock: &dyn Clock) -> Result<Self, BuildError> {
        Self::repeated(|known_peak| {
            let once = || Self::once(choice, scene, threads, clock);
            // Count until a peak is known: another thread that frees memory during a build may hide its peak.
            let (built, peak) = if known_peak.is_none() { peak_bytes(once) } else { (once(), None) };
            let built = built?;
            // The counter misses memory of C++ and of other processes: a peak below the structure's size is wrong.
            let is_seen = |peak: &usize| built.accel.remote().is_none() && *peak >= built.accel.footprint().total();
            Ok(Self { peak_bytes: known_peak.or(peak.filter(is_seen)), ..built })
        })
    }

    /// Repeats a short build. `build` receives the peak that an earlier build has counted.
    fn repeated(build: impl Fn(Option<usize>) -> Result<Self, BuildError>) -> Result<Self, BuildError> {
        let mut last = build(None)?;
        let mut times = vec![last.build_ns as f64];
        while last.build_ns <= SHORT_BUILD_NS && times.len() < 3 {
            last = build(last.peak_bytes)?;
            times.push(last.build_ns as f64);
        }
        let build_ns = median(&times).expect("there is a build") as u64;
        Ok(Self { build_ns, ..last })
    }

    fn once(choice: &Choice, scene: &Scene, threads: &Threads, clock: &dyn Clock) -> Result<Self, BuildError> {
        let mesh = Arc::clone(&scene.mesh);
        // As for rays, a single thread uses processor time, which excludes the time of other processes on its core.
        let own = CpuClock::Process.on(threads);
        let clock = own.as_ref().map_or(clock, |clock| clock as &dyn Clock);
        let start = clock.now_ns();
        let accel = threads.install(|| choice.build(&mesh));
        let build_ns = clock.now_ns() - start;
        let accel = accel?;
        let build_ns = accel.remote().map_or(build_ns, Remote::build_ns);
        Ok(Self { choice: choice.clone(), accel, build_ns, peak_bytes: None })
    }
}
