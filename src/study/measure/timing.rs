//! Takes interleaved samples of many structures on many workloads.

use super::built::Built;
use super::guarded::Guarded;
use super::pair::Pair;
use super::ray_cost;
use crate::measure::tiles::{last_level, rays_at};
use crate::measure::{
    Allotment, Clock, Cost, CpuClock, Failure, Pass, RemotePass, SamplePlan, Samples, Stopwatch, SubsetSamples,
    Threads, Timed, allot, level_by_clock, pilot_level, take,
};
use crate::registry::Choice;
use crate::scene::Workload;

/// A sample of a structure without a runner may take this multiple of `Allotment::share_ns`.
const SLACK: u64 = 8;

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SampleFailure {
    /// The structure panicked, or the runner failed.
    #[error("{0}")]
    Ended(String),
    #[error("it returns other hits when it traces the same rays again: the structure is not deterministic")]
    Unsteady,
}

pub struct Timing<'a> {
    pub cases: &'a [Pair],
    pub choices: &'a [Choice],
    /// In the order of `choices`. An entry is `None` if the structure was not built.
    pub built: &'a [Option<&'a Built>],
    /// No workload is empty.
    pub workloads: &'a [Workload],
    pub threads: &'a Threads,
    pub clock: &'a dyn Clock,
    /// Whether a measured time may reduce the number of rays of a structure without a runner.
    pub by_clock: bool,
}

impl Timing<'_> {
    /// Allots rays to every case, even if the structure of the case was not built.
    pub fn allot(&self, plan: &SamplePlan) -> Allotment {
        // A structure and its twin have the same label. The twin must get as many rays as the structure.
        let label = |case: &Pair| (case.workload, &self.choices[case.structure].label);
        let group =
            |case: &Pair| self.cases.iter().position(|other| label(other) == label(case)).expect("it is among them");
        let costs = ray_cost::picoseconds(self.cases, self.built, self.workloads);
        let cost =
            |(case, ps): (&Pair, u64)| Cost { rays: self.workloads[case.workload].rays.len(), ps, group: group(case) };
        allot(&self.cases.iter().zip(costs).map(cost).collect::<Vec<_>>(), plan)
    }

    /// Takes interleaved samples.
    pub fn take(
        &self,
        allotment: &Allotment,
        is_timed: &dyn Fn(&Pair) -> bool,
        plan: &SamplePlan,
        progress: &mut dyn FnMut(usize),
    ) -> Vec<Result<Samples, SampleFailure>> {
        let Allotment { runs, levels, share_ns } = allotment;
        let all = self.cases;
        let timed: Vec<usize> = (0..all.len()).filter(|&i| is_timed(&all[i])).collect();
        let pass = |&i: &usize| {
            let workload = &self.workloads[all[i].workload];
            let accel = self.built[all[i].structure].expect("a timed structure is built").accel.as_ref();
            if let Some(remote) = accel.remote() {
                let (pass, failure) = RemotePass::new(accel, remote, &workload.rays, workload.query);
                return (Box::new(pass) as Box<dyn Timed>, failure);
            }
            let (pass, failure) = Guarded::new(Pass::new(accel, &workload.rays, workload.query, self.threads));
            (Box::new(pass) as Box<dyn Timed>, failure)
        };
        let (mut passes, failures): (Vec<_>, Vec<_>) = timed.iter().map(pass).collect();
        let _pin = self.threads.pin();
        // Processor time excludes the time of other processes on the core.
        let own = CpuClock::Thread.on(self.threads);
        let clock = own.as_ref().map_or(self.clock, |clock| clock as &dyn Clock);

        let mut levels = levels.clone();
        let built = |i: usize| self.built[all[i].structure];
        let is_remote = |built: &Built| built.accel.remote().is_some();
        let is_by_clock = |i: usize| built(i).is_some_and(|built| self.by_clock || is_remote(built));
        for (&i, pass) in timed.iter().zip(&mut passes).filter(|(i, _)| is_by_clock(**i)) {
            let most_ns = if built(i).is_some_and(is_remote) { *share_ns } else { SLACK * share_ns };
            levels[i] = level_by_clock(&Stopwatch::new(clock), pass.as_mut(), levels[i], most_ns);
        }
        let of = |(i, &Pair { workload, .. }): (usize, &Pair)| {
            let all = self.workloads[workload].rays.len();
            TimedRays { workload, all, level: levels[i], is_by_clock: is_by_clock(i) }
        };
        let cases: Vec<TimedRays> = all.iter().enumerate().map(of).collect();
        let mut samples: Vec<Samples> = timed.iter().map(|&i| empty_samples(&cases[i], &cases)).collect();
        let compared: Vec<usize> = timed.iter().map(|&i| all[i].workload).collect();
        take(clock, &mut passes, &compared, &SamplePlan { runs: *runs, ..*plan }, &mut samples, progress);
        let taken = |(samples, failure): (Samples, &Failure)| match failure.borrow().clone() {
            Some(clause) => Err(SampleFailure::Ended(clause)),
            None if samples.is_steady => Ok(samples),
            None => Err(SampleFailure::Unsteady),
        };
        samples.into_iter().zip(&failures).map(taken).collect()
    }
}

struct TimedRays {
    workload: usize,
    /// Number of rays in the workload.
    all: usize,
    level: usize,
    is_by_clock: bool,
}

/// Returns empty samples of `case`. Each part covers the rays of another case with fewer rays.
fn empty_samples(case: &TimedRays, cases: &[TimedRays]) -> Samples {
    let own = Samples::none(case.all, case.level);
    let mut fewer = vec![];
    for other in cases.iter().filter(|other| other.workload == case.workload) {
        fewer.push(rays_at(other.all, other.level));
        // The clock may choose the next level in another epoch. The next level has a quarter of the rays.
        if other.is_by_clock && other.level < last_level(other.all) {
            fewer.push(rays_at(other.all, other.level + 1));
        }
    }
    fewer.retain(|&rays| rays < own.rays);
    fewer.sort_unstable_by(|a, b| b.cmp(a));
    fewer.dedup();
    // The checksum must cover the same rays in every epoch.
    let checksum_level = if case.is_by_clock { Some(pilot_level(case.all)) } else { own.checksum_level };
    Samples { checksum_level, parts: fewer.into_iter().map(|rays| SubsetSamples { rays, ns: vec![] }).collect(), ..own }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(cases: &[(usize, usize, bool)]) -> Vec<Vec<usize>> {
        let cases: Vec<TimedRays> = cases
            .iter()
            .map(|&(workload, level, is_by_clock)| TimedRays { workload, all: 65_536, level, is_by_clock })
            .collect();
        cases.iter().map(|case| empty_samples(case, &cases).parts.iter().map(|part| part.rays).collect()).collect()
    }

    #[test]
    fn every_case_is_timed_on_the_rays_of_each_slower_one_of_its_workload() {
        let cases = [(0, 2, false), (1, 2, false), (0, 2, false), (1, 5, false), (0, 4, false), (1, 2, false)];
        assert_eq!(parts(&cases), [vec![256], vec![64], vec![256], vec![], vec![], vec![64]]);
    }

    #[test]
    fn a_program_and_all_that_it_is_compared_with_are_timed_on_the_next_level_as_well() {
        let cases = [(0, 0, false), (0, 1, true), (0, 3, false), (1, 0, false)];
        assert_eq!(parts(&cases), [vec![16_384, 4096, 1024], vec![4096, 1024], vec![], vec![]]);
        // Level 5 has no next level.
        assert_eq!(parts(&[(0, 0, false), (0, 5, true)]), [vec![64], vec![]]);
        let program = TimedRays { workload: 0, all: 65_536, level: 1, is_by_clock: true };
        assert_eq!(empty_samples(&program, &[]).checksum_level, Some(5));
    }
}
