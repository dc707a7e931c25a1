//! Samples of many structures on many workloads: the one place where studies take time.

use super::StudyError;
use super::built::Built;
use super::guarded::Guarded;
use crate::measure::{Clock, CpuClock, Pass, Plan, Samples, Threads, Timed, begin, take};
use crate::scene::{Scene, Workload};

/// Passes of a case besides its samples, in each epoch: what the search for the number of rays and a warm-up take as a rule.
const OTHER_PASSES: usize = 3;

/// What a sample may take, nanoseconds, when `cases` with `runs` samples each are to be taken in `budget_ns`.
pub(super) fn sample_budget_ns(budget_ns: u64, cases: usize, runs: usize) -> u64 {
    (budget_ns / (cases * (runs + OTHER_PASSES)).max(1) as u64).max(1)
}

/// What is timed together: a structure and a workload, by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Case {
    pub structure: usize,
    pub workload: usize,
}

impl Case {
    /// Every structure on every workload, structure by structure.
    pub fn all(structures: usize, workloads: usize) -> Vec<Self> {
        (0..structures).flat_map(|structure| (0..workloads).map(move |workload| Self { structure, workload })).collect()
    }
}

/// What samples are taken of, and how.
pub(super) struct Timing<'a> {
    pub scene: &'a Scene,
    pub built: &'a [Built],
    /// None of them empty.
    pub workloads: &'a [Workload],
    pub threads: &'a Threads,
    pub clock: &'a dyn Clock,
}

/// The samples of all cases, in their order.
pub(super) struct Taken {
    pub samples: Vec<Samples>,
    /// Which of them panicked: their samples mean nothing.
    pub panicked: Vec<bool>,
}

impl Timing<'_> {
    /// Takes the samples of `cases`, interleaved, on a pinned thread where there is one. After a first epoch its samples are given
    /// as `before`: more are added, on as many rays.
    ///
    /// # Errors
    /// If a structure answers the same rays differently.
    pub fn take(
        &self,
        cases: &[Case],
        plan: &Plan,
        before: Option<Vec<Samples>>,
        progress: &mut dyn FnMut(usize),
    ) -> Result<Taken, StudyError> {
        let pass = |case: &Case| {
            let workload = &self.workloads[case.workload];
            let accel = self.built[case.structure].accel.as_ref();
            let (pass, panicked) = Guarded::new(Pass::new(accel, &workload.rays, workload.query, self.threads));
            (Box::new(pass) as Box<dyn Timed>, panicked)
        };
        let (mut passes, panicked): (Vec<_>, Vec<_>) = cases.iter().map(pass).collect();
        let _pin = self.threads.pin();
        // What others take of the core is no time of a pass.
        let own = CpuClock::of_thread(self.threads);
        let clock = own.as_ref().map_or(self.clock, |clock| clock as &dyn Clock);
        let mut samples = before.unwrap_or_else(|| {
            let mut samples = begin(clock, &mut passes, plan);
            let labels: Vec<&str> = cases.iter().map(|case| self.built[case.structure].choice.label.as_str()).collect();
            share_rays(cases, &labels, &mut samples);
            samples
        });
        take(clock, &mut passes, plan, &mut samples, progress).map_err(|cause| {
            let Case { structure, workload } = cases[cause.case];
            StudyError::Unsteady {
                structure: self.built[structure].choice.label.clone(),
                scene: self.scene.name.clone(),
                rays: self.workloads[workload].name.clone(),
                cause,
            }
        })?;
        Ok(Taken { samples, panicked: panicked.iter().map(|panicked| panicked.get()).collect() })
    }
}

/// Structures that take up to so many times as long as the fastest are timed on the same rays.
const ALIKE: usize = 8;

/// Gives cases of a workload the same rays, as far as they can be compared in the time there is: those that are not much slower than
/// the fastest take what fits the slowest of them. Twins, structures of one label, always take the same.
fn share_rays(cases: &[Case], labels: &[&str], samples: &mut [Samples]) {
    let workloads = cases.iter().map(|case| case.workload + 1).max().unwrap_or(0);
    for workload in 0..workloads {
        let of: Vec<usize> = (0..cases.len()).filter(|&i| cases[i].workload == workload).collect();
        let most = of.iter().map(|&i| samples[i].rays).max().unwrap_or(0);
        let alike: Vec<usize> = of.iter().copied().filter(|&i| samples[i].rays * ALIKE >= most).collect();
        let common = alike.iter().map(|&i| samples[i].rays).min().unwrap_or(most);
        alike.iter().for_each(|&i| samples[i].rays = common);
        for (at, &i) in of.iter().enumerate() {
            if let Some(&first) = of[..at].iter().find(|&&first| labels[first] == labels[i]) {
                samples[i].rays = samples[first].rays;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comparable_structures_take_the_same_rays_and_twins_always_do() {
        let samples = |rays| Samples { rays, checksum: 0, same_answers: true, unsteady: 0, ns: vec![] };
        // Three structures and the twin of the first, on two workloads: the first and its twin are far slower on the first.
        let cases = Case::all(4, 2);
        let labels = ["a", "a", "b", "b", "c", "c", "a", "a"];
        let mut taken = [64, 512, 4096, 1024, 2048, 300, 32, 1024].map(samples);
        share_rays(&cases, &labels, &mut taken);
        assert_eq!(taken.map(|samples| samples.rays), [64, 300, 2048, 300, 2048, 300, 64, 300]);
    }

    #[test]
    fn the_budget_is_shared_by_samples_and_what_comes_before_them() {
        assert_eq!(sample_budget_ns(1_200, 20, 3), 10);
        assert_eq!((sample_budget_ns(5, 1000, 3), sample_budget_ns(5, 0, 3)), (1, 5));
    }
}
