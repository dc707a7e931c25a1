//! How does time grow with the number of triangles?

use super::prediction;
use crate::measure::Interval;
use crate::report::number::{count, figures};
use crate::scene::WorkloadKind;
use crate::study::predictions::{Finding, Inputs, Prediction};
use crate::study::scaling::{Family, Growth, Point};
use crate::study::{REPORT_TREE, SAH_TREE};

/// The least power expected of the report's tree, and the most of the SAH tree.
const LEAST: f64 = 0.8;
const MOST_OF_SAH: f64 = 0.2;

pub(super) fn growth(inputs: &Inputs) -> Prediction {
    let claim = "Time per ray grows like n^b: with b near 1 by the report's rule on one mesh refined, with b at most 0.2 in a proper SAH tree.";
    let of = |structure: &str| {
        let spheres = inputs.scaling.iter().filter(|g| g.family == Family::Spheres && g.structure == structure);
        spheres.into_iter().find(|g| g.workload == WorkloadKind::Primary.name())
    };
    let (report, sah) = (of(REPORT_TREE), of(SAH_TREE));
    let mut findings = vec![];
    let mut why = String::new();
    if let Some(time) = report.and_then(|g| g.time) {
        findings.push(Finding::within("b of the report's tree", time, LEAST, 1.2));
    }
    if let Some(time) = sah.and_then(|g| g.time) {
        findings.push(Finding::within("b of the SAH tree", time, f64::NEG_INFINITY, MOST_OF_SAH));
    }
    if let (Some(report), Some(sah)) = (report, sah) {
        let power = |x: Option<Interval>| x.map_or("?".into(), |x| figures(x.estimate));
        why = format!(
            "Tests per ray grow like n^{} in the report's tree and n^{} in the SAH tree, steps like n^{} and n^{}.",
            power(report.tests),
            power(sah.tests),
            power(report.steps),
            power(sah.steps)
        );
        if report.time.is_some_and(|time| time.estimate < LEAST) {
            why += &refined(report);
        }
        let counts = |g: &Growth| [g.tests, g.steps].into_iter().flatten().map(|x| x.high).fold(0.0, f64::max);
        if sah.time.is_some_and(|time| time.estimate > MOST_OF_SAH && time.low > counts(sah)) {
            why += " Time in the SAH tree grows faster than either count: a step or a test takes longer in a larger tree. Why is not measured \
                    here.";
        }
    }
    let complete = findings.len() == 2;
    prediction(4, claim, findings, complete, why, "sahara study scaling")
}

/// What the finest mesh of a family asks of a tree, against the coarsest.
fn refined(growth: &Growth) -> String {
    let mut fitted = growth.points.iter().filter(|point| point.fitted);
    let (Some(first), Some(last)) = (fitted.next(), fitted.next_back()) else { return String::new() };
    let tests = |point: &Point| point.tests_per_ray.map_or("?".into(), figures);
    format!(
        " From {} to {} triangles the report's tree goes from {} to {} tests a ray, with {} and {} triangles a leaf.",
        count(first.triangles as u64),
        count(last.triangles as u64),
        tests(first),
        tests(last),
        figures(first.triangles as f64 / first.leaves.max(1) as f64),
        figures(last.triangles as f64 / last.leaves.max(1) as f64),
    )
}
