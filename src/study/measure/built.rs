use std::sync::Arc;

use crate::accel::{BuildError, DynAccel, Remote};
use crate::measure::{Clock, CpuClock, Threads, median, peak_bytes};
use crate::registry::Choice;
use crate::scene::Scene;

pub struct Built {
    pub choice: Choice,
    pub accel: Box<dyn DynAccel>,
    /// The median build time if the build is repeated.
    pub build_ns: u64,
    /// Peak memory of the first build with a known peak.
    pub peak_bytes: Option<usize>,
}

/// A build that takes at most this long is repeated, because short times vary more.
const SHORT_BUILD_NS: u64 = 20_000_000;

impl Built {
    pub fn new(choice: &Choice, scene: &Scene, threads: &Threads, clock: &dyn Clock) -> Result<Self, BuildError> {
        Self::repeated(|_| Self::once(choice, scene, threads, clock))
    }

    /// Like [`new`](Self::new), but counts the peak memory. Counting slows a build by less than build times vary.
    pub fn counted(choice: &Choice, scene: &Scene, threads: &Threads, clock: &dyn Clock) -> Result<Self, BuildError> {
        Self::repeated(|known_peak| {
            let once = || Self::once(choice, scene, threads, clock);
            // Another thread that frees memory during a build may hide the peak. So the memory of each build is counted
            // until a peak is known.
            let (built, peak) = if known_peak.is_none() { peak_bytes(once) } else { (once(), None) };
            let built = built?;
            // The counter misses memory of C++ code and of other processes. So a peak below the size of the structure
            // is ignored.
            let is_seen = |peak: &usize| built.accel.remote().is_none() && *peak >= built.accel.footprint().total();
            Ok(Self { peak_bytes: known_peak.or(peak.filter(is_seen)), ..built })
        })
    }

    /// `build` receives the peak memory of an earlier build.
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
        // With one thread, the clock is processor time, which excludes the time of other processes.
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
