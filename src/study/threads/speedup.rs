//! From times to speedups, and the serial share that Amdahl's law makes of them.

use serde::{Deserialize, Serialize};

use crate::measure::{Estimate, Rerun, Variance};
use crate::report::words::distinct;
use crate::study::epoch::{Epoch, Line, lines, middles, twins};

/// One epoch of one scene with so many threads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ThreadsEpoch {
    pub threads: usize,
    pub epoch: Epoch,
}

/// One structure on one scene: its build, or its rays of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Speedup {
    pub scene: String,
    pub structure: String,
    /// `build`, or the kind of rays.
    pub what: String,
    /// By growing number of threads, beginning with 1.
    pub points: Vec<Point>,
    /// Amdahl's serial share f, of which the time with n threads is f + (1 - f) / n of that with one: least squares over all
    /// numbers of threads. Below 0 where n threads are more than n times as fast.
    pub serial: Estimate,
}

/// A number of threads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    pub threads: usize,
    /// Of the build, or of a ray.
    pub ns: f64,
    /// Times as fast as one thread.
    pub speedup: Estimate,
}

/// Those of all scenes and structures that are timed with one thread and with more.
pub fn speedups(cases: &[ThreadsEpoch]) -> Vec<Speedup> {
    let noise = twins(cases.iter().filter(|case| case.threads == 1).map(|case| &case.epoch));
    let mut numbers: Vec<usize> = cases.iter().map(|case| case.threads).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let with = |threads: usize| lines(cases.iter().filter(|case| case.threads == threads).map(|case| &case.epoch));
    let all: Vec<(usize, Vec<Line>)> = numbers.into_iter().map(|threads| (threads, with(threads))).collect();
    let Some((1, ones)) = all.first() else { return vec![] };

    let mut found = vec![];
    for scene in distinct(ones.iter().map(|line| &line.scene)) {
        for structure in distinct(ones.iter().filter(|line| line.scene == scene).map(|line| &line.structure)) {
            let own: Vec<(usize, Vec<&Line>)> = all
                .iter()
                .map(|(n, lines)| (*n, lines.iter().filter(|l| l.scene == scene && l.structure == structure).collect()))
                .collect();
            let mut add = |what: &str, logs: &[(usize, Vec<f64>)], noise: Variance| {
                let (scene, structure) = (scene.clone(), structure.clone());
                found.extend(speedup(logs, noise).map(|(points, serial)| Speedup {
                    scene,
                    structure,
                    what: what.into(),
                    points,
                    serial,
                }));
            };
            let of = |pick: &dyn Fn(&[&Line]) -> Option<Vec<f64>>| -> Vec<(usize, Vec<f64>)> {
                own.iter().filter_map(|(n, lines)| Some((*n, pick(lines)?))).collect()
            };
            add("build", &of(&|lines| Some(middles(&lines.first()?.build))), noise.build.of_ratio());
            for line in &own[0].1 {
                let same = |lines: &[&Line]| {
                    let line = lines.iter().find(|other| other.workload == line.workload)?;
                    Some(middles(&line.trace))
                };
                add(&line.workload, &of(&same), noise.trace.of_ratio());
            }
        }
    }
    found
}

/// Points and serial share of times, logarithms of nanoseconds of each epoch, by number of threads. Nothing without a time
/// with one thread and another.
fn speedup(logs: &[(usize, Vec<f64>)], noise: Variance) -> Option<(Vec<Point>, Estimate)> {
    let (1, one) = logs.first()? else { return None };
    let more = logs.get(1..).filter(|more| !more.is_empty())?;
    let epochs = logs.iter().map(|(_, logs)| logs.len()).min()?;
    let mean = |logs: &[f64]| logs[..epochs].iter().sum::<f64>() / epochs as f64;
    let mut points = vec![];
    for (threads, own) in logs {
        let ratios: Vec<f64> = one.iter().zip(own).take(epochs).map(|(one, own)| one - own).collect();
        let speedup = if *threads == 1 { Estimate::exact(1.0) } else { Rerun::of(&ratios, noise)?.ratio() };
        points.push(Point { threads: *threads, ns: libm::exp(mean(own)), speedup });
    }
    let serial = |epoch: usize| {
        let shares: Vec<(usize, f64)> =
            more.iter().map(|(threads, own)| (*threads, libm::exp(own[epoch] - one[epoch]))).collect();
        serial_share(&shares)
    };
    // To first order the share errs as the time with the most threads does.
    let serials: Vec<f64> = (0..epochs).map(serial).collect();
    let last = points.last().map_or(1.0, |point| 1.0 / point.speedup.estimate);
    Some((points, Rerun::of(&serials, noise.times(last))?.plain()))
}

/// The f for which f + (1 - f) / n comes nearest to the times with n threads, as multiples of that with one.
pub(super) fn serial_share(times: &[(usize, f64)]) -> f64 {
    // The time less 1 / n is f times 1 - 1 / n.
    let sums = times.iter().fold((0.0, 0.0), |(over, under), &(threads, time)| {
        let ideal = 1.0 / threads as f64;
        (over + (time - ideal) * (1.0 - ideal), under + (1.0 - ideal) * (1.0 - ideal))
    });
    sums.0 / sums.1
}
