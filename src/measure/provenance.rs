//! The provenance of a measurement.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{CpuClock, Threads, machine, program};
use crate::escaped::quoted;
use crate::plural::plural;
use crate::simd::Level;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    pub command: String,
    pub version: String,
    /// The suffix `+changes` means that the sources differ from the commit.
    pub commit: String,
    pub build: String,
    /// Start of the run, in UTC: `2026-03-01T12:30:59Z`.
    pub date: String,
    pub rustc: String,
    /// `release` or `debug`.
    pub profile: String,
    pub target: String,
    /// Instruction set extensions that the compiler could use.
    pub target_features: String,
    pub simd: String,
    pub host: String,
    pub cpu: String,
    pub cores: usize,
    pub threads: usize,
    pub os: String,
    /// Version of the crate obvhs.
    pub obvhs: String,
    /// `cpu` if samples are processor times, `elapsed` otherwise.
    pub clock: String,
    /// The core of each thread.
    pub pinned: Option<Vec<usize>>,
    pub process_per_epoch: bool,
    pub mxcsr: Option<u32>,
    /// `kept` if the processor replaces no denormal number with zero.
    pub denormals: String,
    pub governor: Option<String>,
    /// The one-minute load average at the start of the run.
    pub load: Option<f64>,
}

impl Provenance {
    pub fn capture(threads: usize) -> Self {
        let command: Vec<String> = std::env::args_os().map(quoted).collect();
        Self {
            command: command.join(" "),
            version: env!("CARGO_PKG_VERSION").into(),
            commit: env!("SAHARA_COMMIT").into(),
            build: program::build().into(),
            date: program::started().into(),
            rustc: env!("SAHARA_RUSTC").into(),
            profile: env!("SAHARA_PROFILE").into(),
            target: env!("SAHARA_TARGET").into(),
            target_features: env!("SAHARA_TARGET_FEATURES").into(),
            simd: Level::current().name().into(),
            host: host_name().unwrap_or_else(|| "unknown".into()),
            cpu: cpu_name().unwrap_or_else(|| "unknown".into()),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            threads,
            os: std::env::consts::OS.into(),
            obvhs: env!("SAHARA_OBVHS").into(),
            clock: "elapsed".into(),
            pinned: None,
            process_per_epoch: false,
            mxcsr: machine::mxcsr(),
            denormals: machine::denormals(machine::mxcsr()).into(),
            governor: machine::governor(0),
            load: machine::load_at_start(),
        }
    }

    pub fn of(threads: &Threads) -> Self {
        let pinned = threads.cores().map(<[usize]>::to_vec);
        let core = pinned.as_ref().map_or(0, |cores| cores[0]);
        let clock = if CpuClock::Thread.on(threads).is_some() { "cpu" } else { "elapsed" }.into();
        Self { pinned, clock, governor: machine::governor(core), ..Self::capture(threads.count()) }
    }

    /// Two runs count as runs of the same build and machine if all returned fields are equal. The host name is not
    /// returned: epochs may come from several equal hosts, because samples are paired only within a case.
    pub fn machine(&self) -> Map<String, Value> {
        let facts = "version commit build rustc profile target_features simd cpu threads process_per_epoch";
        let all = serde_json::to_value(self).expect("keys are text");
        facts.split(' ').map(|name| (name.to_owned(), all[name].clone())).collect()
    }

    pub fn too_many_threads(&self) -> Option<String> {
        let Self { threads, cores, .. } = self;
        (threads > cores).then(|| {
            let all = plural(*cores, "core");
            format!(
                "{threads} threads share {all}, so the times are not valid for {threads} or for {cores} threads: use \
                 at most --threads {cores}"
            )
        })
    }

    /// A target feature that `simd` needs but the build does not enable.
    fn lacking(&self) -> Option<&'static str> {
        let needed = match self.simd.as_str() {
            "avx512" => "avx512f",
            "avx2" => "avx2",
            _ => return None,
        };
        (!self.target_features.split(',').any(|feature| feature == needed)).then_some(needed)
    }

    pub fn line(&self) -> String {
        let threads = plural(self.threads, "thread");
        let pinned = match self.pinned.as_deref() {
            Some([core]) => format!(" on core {core}"),
            Some(_) => ", each on its own core".into(),
            None => ", not pinned".into(),
        };
        let Self { cpu, simd, rustc, version, commit, profile, date, .. } = self;
        let day = date.split('T').next().unwrap_or(date);
        let rustc = rustc.split(" (").next().unwrap_or(rustc);
        let lacking = self.lacking().map_or(String::new(), |feature| {
            format!(" (baselines are built without {feature}: set target-cpu=native)")
        });
        format!("{cpu}, {simd}{lacking}, {threads}{pinned}; sahara {version} ({commit}, {profile}), {rustc}; {day}")
    }
}

fn host_name() -> Option<String> {
    let name = std::fs::read_to_string("/proc/sys/kernel/hostname").ok().or_else(|| std::env::var("HOSTNAME").ok())?;
    Some(name.trim().to_owned()).filter(|name| !name.is_empty())
}

fn cpu_name() -> Option<String> {
    model_name(&std::fs::read_to_string("/proc/cpuinfo").ok()?)
}

fn model_name(cpuinfo: &str) -> Option<String> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    let (_, name) = line.split_once(':')?;
    Some(name.split_whitespace().collect::<Vec<_>>().join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_is_named_when_the_system_tells() {
        let text = "processor\t: 0\nmodel name\t: Some  CPU @ 3.00GHz\nmodel name\t: Other\n";
        assert_eq!(model_name(text).as_deref(), Some("Some CPU @ 3.00GHz"));
        assert_eq!(model_name("processor\t: 0\n"), None);
    }

    #[test]
    fn a_program_that_was_built_without_the_instructions_of_the_machine_says_so() {
        let here = Provenance::capture(1);
        for (simd, target_features, lacking) in [
            ("avx512", "fxsr,sse,sse2", Some("avx512f")),
            ("avx512", "avx2,avx512f,sse2", None),
            ("avx2", "sse,sse2", Some("avx2")),
            ("portable", "sse,sse2", None),
        ] {
            let own = Provenance { simd: simd.into(), target_features: target_features.into(), ..here.clone() };
            assert_eq!(own.lacking(), lacking, "{simd} {target_features}");
            assert_eq!(own.line().contains("built without"), lacking.is_some(), "{}", own.line());
        }
    }

    #[test]
    fn the_build_is_known() {
        let provenance = Provenance::capture(1);
        assert!(provenance.rustc.starts_with("rustc "), "{provenance:?}");
        assert!(!provenance.commit.is_empty() && provenance.cores > 0);
        assert!(provenance.build.len() == 16 && provenance.build.chars().all(|c| c.is_ascii_hexdigit()));
        assert_eq!((provenance.date.len(), provenance.date.find('T')), (20, Some(10)), "{provenance:?}");
    }
}
