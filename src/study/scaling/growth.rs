//! Powers of the number of triangles, fitted to what was measured.

use serde::{Deserialize, Serialize};

use crate::measure::{AaNoise, Estimate, Rerun, Variance};
use crate::names::named_enum;
use crate::report::words::each_once;
use crate::study::epoch::{Epoch, Line, Twins, lines, middles, twins};
use crate::study::least_squares;

named_enum! {
    /// What grows.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Family {
        /// One sphere, divided more and more finely.
        Spheres = "icospheres",
        /// Different meshes.
        Meshes = "meshes",
    }
}

/// One epoch of one mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FamilyEpoch {
    pub family: Family,
    pub epoch: Epoch,
}

/// Triangles of the icosphere of level 8.
pub const LEVEL_8: usize = 20 << 16;

/// How one structure grows on one family and one kind of rays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Growth {
    pub family: Family,
    /// As chosen.
    pub structure: String,
    pub workload: String,
    /// From the fewest triangles to the most.
    pub points: Vec<Point>,
    /// Time a ray grows like this power of the number of triangles. Nothing with fewer than three meshes of more than
    /// one leaf.
    pub time: Option<Estimate>,
    /// Likewise over the meshes of at most [`LEVEL_8`] triangles: what a claim about these is judged by.
    pub time_to_level_8: Option<Estimate>,
    /// Half of the 95 % interval that this power would have by the scatter of the meshes about it alone, were they
    /// drawn from a family at random.
    pub scatter: Option<f64>,
    /// Likewise the build.
    pub build: Option<Estimate>,
    /// Likewise memory.
    pub bytes: Option<Estimate>,
    /// Likewise triangle tests a ray, which no machine changes.
    pub tests: Option<Estimate>,
    /// Likewise nodes and leaves entered.
    pub steps: Option<Estimate>,
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

/// The growth of every structure. The intervals hold what another run finds of these meshes; how well a power describes
/// them is told by their scatter about it.
pub fn result(cases: &[FamilyEpoch]) -> Vec<Growth> {
    let twins = twins(cases.iter().map(|case| &case.epoch));
    let mut growths = vec![];
    for family in [Family::Spheres, Family::Meshes] {
        let of_family = cases.iter().filter(|case| case.family == family).map(|case| &case.epoch);
        let mut all = lines(of_family);
        all.sort_by_key(|line| line.triangles);
        let mut kinds = each_once(all.iter().map(|line| (line.workload.as_str(), line.structure.as_str())));
        // Kind of rays by kind of rays, structures in the order in which they were asked.
        let order: Vec<&str> = cases.iter().flat_map(|case| &case.epoch.structures).map(|s| s.label.as_str()).collect();
        kinds.sort_by_key(|&(workload, structure)| {
            let first = all.iter().position(|line| line.workload == workload);
            (first, order.iter().position(|&label| label == structure))
        });
        for (workload, structure) in kinds {
            let own: Vec<&Line> =
                all.iter().filter(|line| line.workload == workload && line.structure == structure).collect();
            growths.push(growth(family, &own, &twins));
        }
    }
    growths
}

/// That of the lines of one structure and one kind of rays, from the fewest triangles to the most.
fn growth(family: Family, lines: &[&Line], twins: &Twins) -> Growth {
    let fitted: Vec<&Line> = lines.iter().copied().filter(|line| line.leaves > 1).collect();
    let coarser: Vec<&Line> = fitted.iter().copied().filter(|line| line.triangles <= LEVEL_8).collect();
    let measured = |lines: &[&Line], logs: fn(&Line) -> &[Vec<f64>], noise: &AaNoise| {
        power(lines, &|line| Some(middles(logs(line))), |weights| noise.weighted(weights)).map(|rerun| rerun.plain())
    };
    // Counts and bytes do not vary.
    let counted = |value: &dyn Fn(&Line) -> Option<f64>| {
        let log = |line: &Line| value(line).filter(|&x| x > 0.0).map(|x| vec![libm::log(x)]);
        power(&fitted, &log, |_| Variance::NONE).map(|rerun| Estimate::exact(rerun.plain().estimate))
    };
    let points: Vec<(f64, f64)> =
        fitted.iter().map(|line| (libm::log(line.triangles as f64), libm::log(line.ns_per_ray()))).collect();
    Growth {
        family,
        structure: lines[0].structure.clone(),
        workload: lines[0].workload.clone(),
        points: lines.iter().map(|line| point(line)).collect(),
        time: measured(&fitted, |line| &line.trace, &twins.trace),
        time_to_level_8: measured(&coarser, |line| &line.trace, &twins.trace),
        scatter: least_squares::scatter(&points),
        build: measured(&fitted, |line| &line.build, &twins.build),
        bytes: counted(&|line| Some(line.bytes as f64)),
        tests: counted(&|line| line.tests),
        steps: counted(&|line| line.steps),
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

/// The slope of `value`, logarithms of each epoch, over the logarithm of the number of triangles; `noise` is what the
/// A/A noise adds to a sum of them with these weights. Nothing where it is not known of every mesh, or of fewer than
/// three.
fn power(
    lines: &[&Line],
    value: &dyn Fn(&Line) -> Option<Vec<f64>>,
    noise: impl Fn(&[f64]) -> Variance,
) -> Option<Rerun> {
    let values: Vec<Vec<f64>> = lines.iter().map(|line| value(line)).collect::<Option<_>>()?;
    let places: Vec<f64> = lines.iter().map(|line| libm::log(line.triangles as f64)).collect();
    let weights = least_squares::slope_weights(&places).filter(|weights| weights.len() > 2)?;
    // Meshes are measured in the same epochs; of one that has more of them those that all have count.
    let epochs = values.iter().map(Vec::len).min()?;
    let slope = |e: usize| weights.iter().zip(&values).map(|(weight, logs)| weight * logs[e]).sum();
    Rerun::of(&(0..epochs).map(slope).collect::<Vec<f64>>(), noise(&weights))
}
