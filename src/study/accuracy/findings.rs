//! Findings: the wrong results of structures without known defects, by triangle test.

use super::judged::{Judged, JudgedRays};
use crate::report::Finding;
use crate::report::number::{count, figures};
use crate::report::words::{distinct, listed, slug};
use crate::request::known_defect;

/// `None` if every structure has a known defect.
pub fn finding(of_kind: &JudgedRays) -> Option<Finding> {
    let is_ours = |judged: &&Judged| known_defect(&judged.structure.name).is_none();
    let own: Vec<&Judged> = of_kind.structures.iter().filter(is_ours).collect();
    let (mut right, mut wrong) = (vec![], vec![]);
    for test in distinct(own.iter().map(|judged| &judged.structure.triangle_test)) {
        let of_test = || own.iter().filter(|judged| judged.structure.triangle_test == test).map(|judged| judged.error);
        let (least, most) = (of_test().fold(f64::INFINITY, f64::min), of_test().fold(0.0, f64::max));
        let [from, to] = [least, most].map(|error| figures(100.0 * error));
        match most {
            0.0 => right.push(test),
            _ if from != to => wrong.push(format!("{test} {from} to {to} %")),
            _ => wrong.push(format!("{test} {to} %")),
        }
    }
    let rays = count(own.iter().map(|judged| judged.errors.rays).max()?);
    let other = if right.is_empty() { "" } else { " with other tests" };
    let right = match &right[..] {
        [] => "with every triangle test, some of our structures return wrong results".to_owned(),
        [test] => format!("our structures return no wrong result with the {test} triangle test"),
        tests => format!("our structures return no wrong result with the triangle tests {}", listed(tests)),
    };
    let wrong = match &wrong[..] {
        [] => String::new(),
        wrong => format!("; share of wrong results{other}: {}", listed(wrong)),
    };
    let without = own.iter().filter(|judged| judged.errors.errors() == 0);
    let fastest = without.min_by(|one, other| one.ns_per_ray.total_cmp(&other.ns_per_ray));
    let fastest = fastest.map_or(String::new(), |judged| {
        format!("; our fastest structure without a wrong result is {}", judged.structure.label)
    });
    let (scene, kind) = (of_kind.epoch.title(), of_kind.kind);
    let key = slug(&format!("{} {kind}", of_kind.epoch.scene));
    Some(Finding::new(key, format!("{scene}, {rays} {kind} rays: {right}{wrong}{fastest}.")))
}
