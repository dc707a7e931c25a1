//! Samples of many structures on many workloads: the one place where studies take time.

use super::StudyError;
use super::built::Built;
use super::guarded::Guarded;
use crate::measure::{Clock, CpuClock, Part, Pass, Plan, RemotePass, Samples, Threads, Timed, begin, take};
use crate::scene::{Scene, Workload};

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

pub(super) struct Timing<'a> {
    pub scene: &'a Scene,
    pub built: &'a [Built],
    /// None of them empty.
    pub workloads: &'a [Workload],
    pub threads: &'a Threads,
    pub clock: &'a dyn Clock,
}

pub(super) struct Taken {
    pub samples: Vec<Samples>,
    /// Why the samples of some of them mean nothing.
    pub failures: Vec<Option<String>>,
}

impl Timing<'_> {
    /// Takes the samples of `cases`, interleaved, on a pinned thread where there is one. After a first epoch its
    /// samples are given as `before`: `plan.runs` more are added, on as many rays. The samples of any two structures on
    /// a workload, or those of a part of them, are of the same rays.
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
            if let Some(remote) = accel.remote() {
                let (pass, failure) = RemotePass::new(accel, remote, &workload.rays, workload.query);
                return (Box::new(pass) as Box<dyn Timed>, failure);
            }
            let (pass, failure) = Guarded::new(Pass::new(accel, &workload.rays, workload.query, self.threads));
            (Box::new(pass) as Box<dyn Timed>, failure)
        };
        let (mut passes, failures): (Vec<_>, Vec<_>) = cases.iter().map(pass).collect();
        let _pin = self.threads.pin();
        // What others take of the core is no time of a pass.
        let own = CpuClock::of_thread(self.threads);
        let clock = own.as_ref().map_or(self.clock, |clock| clock as &dyn Clock);
        let (runs, mut samples) = match before {
            Some(before) => (plan.runs, before),
            None => {
                // Twins, structures of one label, take as many rays.
                let group = |case: &Case| {
                    let label = |structure: usize| &self.built[structure].choice.label;
                    let alike = |other: &Case| {
                        other.workload == case.workload && label(other.structure) == label(case.structure)
                    };
                    cases.iter().position(alike).expect("it is among them")
                };
                let groups: Vec<usize> = cases.iter().map(group).collect();
                let (runs, mut samples) = begin(clock, &mut passes, &groups, plan);
                add_parts(cases, &mut samples);
                (runs, samples)
            }
        };
        let compared: Vec<usize> = cases.iter().map(|case| case.workload).collect();
        take(clock, &mut passes, &compared, &Plan { runs, ..*plan }, &mut samples, progress).map_err(|cause| {
            let Case { structure, workload } = cases[cause.case];
            StudyError::Unsteady {
                structure: self.built[structure].choice.label.clone(),
                scene: self.scene.name.clone(),
                rays: self.workloads[workload].name.clone(),
                cause,
            }
        })?;
        Ok(Taken { samples, failures: failures.iter().map(|failure| failure.borrow().clone()).collect() })
    }
}

/// Has every case timed on the rays of each slower one of its workload as well.
fn add_parts(cases: &[Case], samples: &mut [Samples]) {
    for i in 0..cases.len() {
        let of_workload = (0..cases.len()).filter(|&other| cases[other].workload == cases[i].workload);
        let mut fewer: Vec<usize> =
            of_workload.map(|other| samples[other].rays).filter(|&rays| rays < samples[i].rays).collect();
        fewer.sort_unstable_by(|a, b| b.cmp(a));
        fewer.dedup();
        samples[i].parts = fewer.into_iter().map(|rays| Part { rays, ns: vec![] }).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_is_timed_on_the_rays_of_each_slower_one_of_its_workload() {
        // Three structures on two workloads.
        let cases = Case::all(3, 2);
        let mut samples = [4096, 4096, 4096, 64, 256, 4096].map(Samples::none);
        add_parts(&cases, &mut samples);
        let parts = samples.map(|samples| samples.parts.iter().map(|part| part.rays).collect::<Vec<_>>());
        assert_eq!(parts, [vec![256], vec![64], vec![256], vec![], vec![], vec![64]]);
    }
}
