//! `scaling`: how do time, build and memory grow with the number of triangles?
//!
//! Icospheres of 20 to 1.3 million triangles, seen alike, so that nothing changes but how finely one surface is divided; and the
//! meshes that are named, which differ in more than their number of triangles, so that their exponent says less. Powers are
//! fitted to medians on logarithms, over the meshes on which the structure has more than one leaf: a single leaf is brute force.

mod spheres;
mod table;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use super::epoch::{Draws, Epoch, Line, centre, lines};
use super::fit;
use crate::measure::Interval;

pub use spheres::{LEVELS, sphere};
pub use table::tables;

/// Name of the study, and of its journal.
pub const NAME: &str = "scaling";

/// The structures compared unless others are named.
pub const STRUCTURES: [&str; 7] =
    ["median-kd", "sah-kd", "sah-kd-wide", "sah-hybrid", "sah-bvh", "obvhs-bvh2", "obvhs-cwbvh"];

/// What grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// One sphere, divided more and more finely.
    Spheres,
    /// Different meshes.
    Meshes,
}

impl Family {
    /// As tables name it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Spheres => "icospheres",
            Self::Meshes => "meshes",
        }
    }
}

/// One epoch of one mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    pub family: Family,
    pub epoch: Epoch,
}

/// How one structure grows on one family and one kind of rays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Growth {
    pub family: Family,
    /// As chosen.
    pub structure: String,
    pub workload: String,
    /// From the fewest triangles to the most.
    pub points: Vec<Point>,
    /// Time a ray grows like this power of the number of triangles. Nothing with fewer than three meshes of more than one leaf.
    pub time: Option<Interval>,
    /// Likewise the build.
    pub build: Option<Interval>,
    /// Likewise memory.
    pub bytes: Option<Interval>,
    /// Likewise triangle tests a ray, which no machine changes.
    pub tests: Option<Interval>,
    /// Likewise nodes and leaves entered.
    pub steps: Option<Interval>,
}

/// One structure on one mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    pub scene: String,
    pub triangles: usize,
    /// Whether it takes part in the fit: the structure has more than one leaf.
    pub fitted: bool,
    pub leaves: usize,
    pub ns_per_ray: f64,
    pub build_ns: f64,
    pub bytes_per_triangle: f64,
    pub tests_per_ray: Option<f64>,
    pub steps_per_ray: Option<f64>,
}

/// The growth of every structure. The intervals hold what another run finds of these meshes, and what other meshes of the family
/// would give as far as the scatter about the power tells: the wider of a bootstrap, which draws meshes, then epochs and rounds, and
/// Student's t on the residuals.
pub fn result(cases: &[Case], seed: u64) -> Vec<Growth> {
    let mut growths = vec![];
    for family in [Family::Spheres, Family::Meshes] {
        let of_family = cases.iter().filter(|case| case.family == family).map(|case| &case.epoch);
        let mut all = lines(of_family);
        all.sort_by_key(|line| line.triangles);
        let mut kinds: Vec<(&str, &str)> = vec![];
        for line in &all {
            let kind = (line.workload.as_str(), line.structure.as_str());
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        // Kind of rays by kind of rays, structures in the order in which they were asked.
        let order: Vec<&str> = cases.iter().flat_map(|case| &case.epoch.structures).map(|s| s.label.as_str()).collect();
        kinds.sort_by_key(|&(workload, structure)| {
            let first = all.iter().position(|line| line.workload == workload);
            (first, order.iter().position(|&label| label == structure))
        });
        for (workload, structure) in kinds {
            let own: Vec<&Line> =
                all.iter().filter(|line| line.workload == workload && line.structure == structure).collect();
            growths.push(growth(family, &own, seed));
        }
    }
    growths
}

/// One point of one growth, for tables that machines read.
#[derive(Clone, Debug, Serialize)]
pub struct Row<'a> {
    pub family: Family,
    pub structure: &'a str,
    pub workload: &'a str,
    #[serde(flatten)]
    pub point: &'a Point,
}

/// All points.
pub fn rows(growths: &[Growth]) -> Vec<Row<'_>> {
    let mut rows = vec![];
    for Growth { family, structure, workload, points, .. } in growths {
        rows.extend(points.iter().map(|point| Row { family: *family, structure, workload, point }));
    }
    rows
}

/// That of the lines of one structure and one kind of rays, from the fewest triangles to the most.
fn growth(family: Family, lines: &[&Line], seed: u64) -> Growth {
    let fitted: Vec<&Line> = lines.iter().copied().filter(|line| line.leaves > 1).collect();
    let power = |value: &dyn Fn(&Line) -> Option<Vec<Vec<f64>>>| power(&fitted, value, seed);
    let known = |x: Option<f64>| x.filter(|&x| x > 0.0).map(|x| vec![vec![libm::log(x)]]);
    Growth {
        family,
        structure: lines[0].structure.clone(),
        workload: lines[0].workload.clone(),
        points: lines.iter().map(|line| point(line)).collect(),
        time: power(&|line| Some(line.trace.clone())),
        build: power(&|line| Some(line.build.clone())),
        bytes: power(&|line| known(Some(line.bytes as f64))),
        tests: power(&|line| known(line.tests)),
        steps: power(&|line| known(line.steps)),
    }
}

fn point(line: &Line) -> Point {
    Point {
        scene: line.scene.clone(),
        triangles: line.triangles,
        fitted: line.leaves > 1,
        leaves: line.leaves,
        ns_per_ray: line.ns_per_ray(),
        build_ns: line.build_ns(),
        bytes_per_triangle: line.bytes as f64 / line.triangles as f64,
        tests_per_ray: line.tests,
        steps_per_ray: line.steps,
    }
}

/// The slope of `value`, logarithms by epoch and round, over the logarithm of the number of triangles. Nothing where it is not known
/// of every mesh, or of fewer than three.
fn power(lines: &[&Line], value: &dyn Fn(&Line) -> Option<Vec<Vec<f64>>>, seed: u64) -> Option<Interval> {
    let values: Vec<(f64, Vec<Vec<f64>>)> =
        lines.iter().map(|line| Some((libm::log(line.triangles as f64), value(line)?))).collect::<Option<_>>()?;
    if values.len() < 3 {
        return None;
    }
    let points: Vec<(f64, f64)> = values.iter().map(|(x, epochs)| (*x, centre(epochs))).collect();
    let (_, slope) = fit::line(&points)?;

    let mut draws = Draws::new(seed);
    let mut drawn = || {
        let points: Vec<(f64, f64)> = (0..values.len())
            .map(|_| {
                let (x, epochs) = &values[draws.below(values.len())];
                (*x, draws.draw(epochs).centre(epochs))
            })
            .collect();
        fit::line(&points).map(|(_, slope)| slope)
    };
    // A draw of one mesh alone has no slope.
    let slopes: Vec<f64> = (0..fit::DRAWS).filter_map(|_| drawn()).collect();
    let bootstrap = fit::percentiles(slope, slopes)?;
    let half = fit::slope_error(&points).unwrap_or(0.0);
    Some(Interval { estimate: slope, low: bootstrap.low.min(slope - half), high: bootstrap.high.max(slope + half) })
}
