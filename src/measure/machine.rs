//! Facts about the machine.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

/// The one-minute load average at the first call. A later value would include the load of this process.
pub fn load_at_start() -> Option<f64> {
    static LOAD: OnceLock<Option<f64>> = OnceLock::new();
    *LOAD.get_or_init(|| first_number(&fs::read_to_string("/proc/loadavg").ok()?))
}

pub fn governor(core: usize) -> Option<String> {
    let path = format!("/sys/devices/system/cpu/cpu{core}/cpufreq/scaling_governor");
    Some(fs::read_to_string(path).ok()?.trim().to_owned())
}

/// The current clock rate of a core in kHz.
pub fn clock_rate(core: usize) -> Option<f64> {
    first_number(&fs::read_to_string(format!("/sys/devices/system/cpu/cpu{core}/cpufreq/scaling_cur_freq")).ok()?)
}

/// The memory of the machine or a smaller limit of a control group, in bytes.
pub fn memory() -> Option<u64> {
    let machine = || {
        let text = fs::read_to_string("/proc/meminfo").ok()?;
        let kib = first_number(text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?)?;
        Some(kib as u64 * 1024)
    };
    let groups = limits(&fs::read_to_string("/proc/self/cgroup").unwrap_or_default());
    // Without a limit, `memory.max` contains the word `max`.
    let limit = |file: &PathBuf| fs::read_to_string(file).ok()?.trim().parse().ok();
    machine().into_iter().chain(groups.iter().filter_map(limit)).min()
}

/// `groups` is the content of `/proc/self/cgroup`. Inside a container, some of the returned files may not exist.
fn limits(groups: &str) -> Vec<PathBuf> {
    let files = |line: &str| {
        let mut fields = line.splitn(3, ':').skip(1);
        let (controllers, path) = (fields.next()?, fields.next()?);
        let (root, file) = match controllers {
            "" => ("/sys/fs/cgroup", "memory.max"),
            old if old.split(',').any(|name| name == "memory") => ("/sys/fs/cgroup/memory", "memory.limit_in_bytes"),
            _ => return None,
        };
        let group = Path::new(root).join(path.trim_start_matches('/'));
        let around = group.ancestors().take_while(|folder| folder.starts_with(root));
        Some(around.map(|folder| folder.join(file)).collect::<Vec<_>>())
    };
    groups.lines().filter_map(files).flatten().collect()
}

/// The number of involuntary context switches of the calling thread.
#[cfg(target_os = "linux")]
pub fn interruptions() -> Option<u64> {
    use nix::sys::resource::{UsageWho, getrusage};
    u64::try_from(getrusage(UsageWho::RUSAGE_THREAD).ok()?.involuntary_context_switches()).ok()
}

#[cfg(not(target_os = "linux"))]
pub fn interruptions() -> Option<u64> {
    None
}

/// Counts the idle clock ticks of each core during a sleep of length `time`.
pub(super) fn idle_ticks(time: Duration) -> BTreeMap<usize, u64> {
    let read = || fs::read_to_string("/proc/stat").map(|text| idle(&text)).unwrap_or_default();
    let before = read();
    std::thread::sleep(time);
    let mut ticks = read();
    ticks.iter_mut().for_each(|(core, ticks)| *ticks = ticks.saturating_sub(before.get(core).copied().unwrap_or(0)));
    ticks
}

fn idle(stat: &str) -> BTreeMap<usize, u64> {
    let core = |line: &str| {
        let (name, times) = line.split_once(' ')?;
        Some((name.strip_prefix("cpu")?.parse().ok()?, times.split_whitespace().nth(3)?.parse().ok()?))
    };
    stat.lines().filter_map(core).collect()
}

fn first_number(text: &str) -> Option<f64> {
    text.split_whitespace().next()?.parse().ok()
}

/// The floating-point control register MXCSR without the exception flags.
#[cfg(target_arch = "x86_64")]
pub fn mxcsr() -> Option<u32> {
    let mut word = 0_u32;
    // SAFETY: every x86-64 processor has `stmxcsr`. The instruction writes four bytes, the size of `word`.
    unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut word, options(nostack, preserves_flags)) };
    Some(word & !0x3f)
}

#[cfg(not(target_arch = "x86_64"))]
pub fn mxcsr() -> Option<u32> {
    None
}

pub fn denormals(mxcsr: Option<u32>) -> &'static str {
    let Some(word) = mxcsr else { return "unknown" };
    match (word & 1 << 15 != 0, word & 1 << 6 != 0) {
        (false, false) => "kept",
        (true, false) => "results flushed to zero",
        (false, true) => "denormal operands read as zero",
        (true, true) => "denormal operands read as zero, results flushed to zero",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn idle_time_is_read_by_core() {
        let text = "cpu  10 0 20 300 4 0 0\ncpu0 5 0 10 100 2 0 0\ncpu13 5 0 10 200 2 0 0\nintr 5 5\nctxt 1\n";
        assert_eq!(idle(text), BTreeMap::from([(0, 100), (13, 200)]));
    }

    #[test]
    fn limits_of_memory_are_those_of_all_groups_around() {
        let job = "0::/system.slice/slurmstepd.scope/job_7\n";
        let files = ["system.slice/slurmstepd.scope/job_7/", "system.slice/slurmstepd.scope/", "system.slice/", ""];
        assert_eq!(limits(job), files.map(|folder| PathBuf::from(format!("/sys/fs/cgroup/{folder}memory.max"))));
        let old = "12:cpu,cpuacct:/a\n9:memory:/slurm/job_7\n1:name=systemd:/\n";
        let files = ["slurm/job_7/", "slurm/", ""];
        let of = |folder| PathBuf::from(format!("/sys/fs/cgroup/memory/{folder}memory.limit_in_bytes"));
        assert_eq!(limits(old), files.map(of));
        assert!(limits("").is_empty() && limits("nonsense\n0::").len() == 1);
    }

    #[test]
    fn what_happens_to_small_numbers_is_said_in_words() {
        assert_eq!(denormals(Some(0x1f80)), "kept");
        assert_eq!(denormals(Some(0x9f80)), "results flushed to zero");
        assert_eq!(denormals(Some(0x9fc0)), "denormal operands read as zero, results flushed to zero");
        assert_eq!(denormals(None), "unknown");
        // Flushing denormals could change hits.
        assert!(matches!(denormals(mxcsr()), "kept" | "unknown"));
    }
}
