//! Fits powers of the number of triangles to the measurements.

use crate::measure::{AaNoise, Estimate, Rerun, Variance};
use crate::report::words::each_once;
use crate::study::Dataset;
use crate::study::measurement::{Measurement, build_noise, measurements, of_scene, trace_noise};

/// The key of a case label. The value of the label is [`SPHERES`] or [`MESHES`].
pub const FAMILY: &str = "family";
/// The key of a case label. The value of the label is the subdivision level of an icosphere.
pub const LEVEL: &str = "level";

pub const SPHERES: &str = "icospheres";

pub const MESHES: &str = "meshes";

/// The number of triangles of the icosphere of level 8.
pub const LEVEL_8: usize = 20 << 16;

#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    pub family: &'static str,
    pub label: String,
    pub workload: String,
    /// Sorted by the number of triangles.
    pub points: Vec<Point>,
    /// The exponent of the time per ray. Every exponent is `None` if the fit has fewer than three meshes.
    pub time: Option<Estimate>,
    /// Like `time`, but fitted only to meshes with at most [`LEVEL_8`] triangles.
    pub time_to_level_8: Option<Estimate>,
    pub build: Option<Estimate>,
    pub bytes: Option<Estimate>,
    /// The exponent of triangle tests per ray.
    pub tests: Option<Estimate>,
    /// The exponent of inner nodes and leaves entered per ray.
    pub steps: Option<Estimate>,
}

/// `ns_per_ray` and `build_ns` are geometric means over the epochs.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub measurement: Measurement,
    pub ns_per_ray: f64,
    pub build_ns: f64,
}

impl Point {
    fn new(measurement: Measurement) -> Option<Self> {
        let mean = |logs: Vec<f64>| libm::exp(logs.iter().sum::<f64>() / logs.len() as f64);
        let (ns_per_ray, build_ns) = (mean(measurement.log_paces()?), mean(measurement.log_builds()));
        Some(Self { measurement, ns_per_ray, build_ns })
    }

    pub fn triangles(&self) -> usize {
        self.measurement.triangles
    }

    /// Whether the fit includes the point. A structure with a single leaf is brute force.
    pub fn is_fitted(&self) -> bool {
        self.measurement.shape.leaves > 1
    }

    pub fn bytes_per_triangle(&self) -> f64 {
        self.measurement.shape.bytes as f64 / self.triangles() as f64
    }
}

pub fn growths(dataset: &Dataset) -> Vec<Growth> {
    let all = measurements(dataset);
    let noises = [trace_noise(&all), build_noise(&all)];
    let workloads = each_once(all.iter().map(|own| &own.workload));
    let labels = each_once(all.iter().map(|own| &own.label));
    let mut growths = vec![];
    for family in [SPHERES, MESHES] {
        let scenes = dataset.scenes();
        let own = scenes.iter().filter(|scene| scene.case.labels.get(FAMILY).is_some_and(|own| own == family));
        let mut points: Vec<Point> = own.flat_map(of_scene).filter_map(Point::new).collect();
        points.sort_by_key(Point::triangles);
        for workload in &workloads {
            for label in &labels {
                let is = |own: &Measurement| (&own.workload, &own.label) == (*workload, *label);
                let own: Vec<Point> = points.iter().filter(|point| is(&point.measurement)).cloned().collect();
                growths.extend((!own.is_empty()).then(|| growth(family, own, &noises)));
            }
        }
    }
    growths
}

/// `points` must be sorted by the number of triangles.
fn growth(family: &'static str, points: Vec<Point>, [trace, build]: &[AaNoise; 2]) -> Growth {
    let fitted: Vec<&Point> = points.iter().filter(|point| point.is_fitted()).collect();
    let coarser: Vec<&Point> = fitted.iter().copied().filter(|point| point.triangles() <= LEVEL_8).collect();
    let measured = |points: &[&Point], logs: fn(&Measurement) -> Option<Vec<f64>>, noise: &AaNoise| {
        power(points, &logs, |weights| noise.weighted(weights)).map(|rerun| rerun.plain())
    };
    // Counts and bytes have no variance.
    let counted = |value: fn(&Measurement) -> Option<f64>| {
        let log = |own: &Measurement| value(own).filter(|&x| x > 0.0).map(|x| vec![libm::log(x)]);
        power(&fitted, &log, |_| Variance::NONE).map(|rerun| Estimate::exact(rerun.plain().estimate))
    };
    Growth {
        family,
        label: points[0].measurement.label.clone(),
        workload: points[0].measurement.workload.clone(),
        time: measured(&fitted, Measurement::log_paces, trace),
        time_to_level_8: measured(&coarser, Measurement::log_paces, trace),
        build: measured(&fitted, |own| Some(own.log_builds()), build),
        bytes: counted(|own| Some(own.shape.bytes as f64)),
        tests: counted(|own| own.counts.tests_per_ray()),
        steps: counted(|own| own.counts.steps_per_ray()),
        points,
    }
}

/// Returns the slope of `value` over ln(triangles). `value` returns the logarithm of a time for each epoch, or one
/// logarithm of a count or size. `noise` returns the A/A variance of a sum with the given weights.
fn power(
    points: &[&Point],
    value: &dyn Fn(&Measurement) -> Option<Vec<f64>>,
    noise: impl Fn(&[f64]) -> Variance,
) -> Option<Rerun> {
    let values: Vec<Vec<f64>> = points.iter().map(|point| value(&point.measurement)).collect::<Option<_>>()?;
    let places: Vec<f64> = points.iter().map(|point| libm::log(point.triangles() as f64)).collect();
    let weights = slope_weights(&places).filter(|weights| weights.len() > 2)?;
    let epochs = values.iter().map(Vec::len).min()?;
    let slope = |e: usize| weights.iter().zip(&values).map(|(weight, logs)| weight * logs[e]).sum();
    Rerun::of(&(0..epochs).map(slope).collect::<Vec<f64>>(), noise(&weights))
}

/// The sum of `w * y` with the returned weights `w` is the least-squares slope of `y` over `x`.
fn slope_weights(x: &[f64]) -> Option<Vec<f64>> {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    let squares: f64 = x.iter().map(|x| (x - mean) * (x - mean)).sum();
    (squares > 0.0).then(|| x.iter().map(|x| (x - mean) / squares).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_where_points_lie_on_one() {
        assert_eq!(slope_weights(&[1.0; 3]), None);
        let x = [1.0, 2.0, 5.0];
        let weights = slope_weights(&x).unwrap();
        let slope: f64 = weights.iter().zip(x).map(|(weight, x)| weight * (3.0 + 0.5 * x)).sum();
        assert!((slope - 0.5).abs() < 1e-12);
    }
}
