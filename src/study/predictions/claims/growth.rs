//! How does time grow with the number of triangles?

use super::{Bounds, Claim, Figure, prediction};
use crate::measure::Estimate;
use crate::report::number::{count, figures};
use crate::scene::WorkloadKind;
use crate::study::predictions::{Inputs, Prediction, Verdict};
use crate::study::scaling::{Family, Growth, LEVEL_8, Point};
use crate::study::{REPORT_TREE, SAH_TREE};

/// What is near 1, and the most expected of the SAH tree.
const NEAR_ONE: [f64; 2] = [0.8, 1.2];
const MOST_OF_SAH: f64 = 0.2;

pub(super) fn growth(inputs: &Inputs) -> Prediction {
    let words = "Time per ray ~ n^b with the report's rule: b near 1 on one mesh refined (icosphere levels 0..8, same view); a proper SAH tree: b \
                 <= 0.2.";
    let of = |structure: &str| {
        let spheres = inputs.scaling.iter().filter(|g| g.family == Family::Spheres && g.structure == structure);
        spheres.into_iter().find(|g| g.workload == WorkloadKind::Primary.name())
    };
    let (report, sah) = (of(REPORT_TREE), of(SAH_TREE));
    // What is measured on fewer levels is shown, and not judged; level 8 is the finest of the claim.
    let judged =
        |growth: Option<&Growth>| growth.filter(|growth| finest(growth) >= LEVEL_8).and_then(|g| g.time_to_level_8);
    let [of_report, of_sah] = ["b of the report's tree", "b of the SAH tree"];
    let claims = vec![
        Claim::number(of_report, judged(report), Bounds::within(NEAR_ONE[0], NEAR_ONE[1])),
        Claim::number(of_sah, judged(sah), Bounds::at_most(MOST_OF_SAH)),
    ];
    let shown = [(of_report, report), (of_sah, sah)].into_iter().filter_map(|(what, growth)| {
        let growth = growth.filter(|growth| finest(growth) < LEVEL_8)?;
        let what = format!("{what} up to {} triangles", count(finest(growth) as u64));
        Some(Figure { what, value: growth.time? })
    });
    let shown: Vec<Figure> = shown.collect();
    let mut why = String::new();
    if let (Some(report), Some(sah)) = (report, sah) {
        let power = |x: Option<Estimate>| x.map_or("?".into(), |x| figures(x.estimate));
        why = format!(
            "Tests per ray grow like n^{} in the report's tree and n^{} in the SAH tree, steps like n^{} and n^{}.",
            power(report.tests),
            power(sah.tests),
            power(report.steps),
            power(sah.steps)
        );
        if claims[0].verdict == Verdict::Refuted {
            why += &refined(report);
        }
        let counts = [sah.tests, sah.steps].into_iter().flatten().map(|x| x.estimate).fold(0.0, f64::max);
        if claims[1].verdict == Verdict::Refuted && sah.time.is_some_and(|time| time.is_above(counts)) {
            why += " Time in the SAH tree grows faster than either count: a step or a test takes longer in a larger tree. Why is not measured \
                    here.";
        }
    }
    Prediction { figures: shown, ..prediction(4, words, claims, why, "sahara study scaling") }
}

/// Triangles of the finest mesh.
fn finest(growth: &Growth) -> usize {
    growth.points.iter().map(|point| point.triangles).max().unwrap_or(0)
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
