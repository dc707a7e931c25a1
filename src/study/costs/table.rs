//! The costs as tables for people.

use super::Family;
use crate::measure::Interval;
use crate::report::number::{duration, figures};
use crate::report::{Cell, Table};
use crate::structures::KdConfig;
use crate::study::SAH_TREE;

/// What the columns mean.
pub const LEGEND: [&str; 2] = [
    "Time of a ray = K_0 + K_T steps + K_I tests, no cost below 0, by the ratios of predicted to measured time, so that slow cases do not \
     rule; 95 % intervals from drawing cases. R2: share of the variance of ln time that is explained. off: geometric mean of the factors between predicted and measured time; \
     worst: the largest.",
    "What the heuristic should be told on this machine: with a step at 1, a triangle costs K_I / K_T, and a full block of eight eight times \
     as much.",
];

/// The costs of all families, then how far the worst cases are off.
pub fn tables(families: &[Family]) -> Vec<Table> {
    if families.is_empty() {
        return vec![Table {
            title: "Too few cases to tell costs apart: name more scenes, structures or kinds of rays.".into(),
            ..Table::default()
        }];
    }
    vec![costs(families), worst(families)]
}

fn ns(x: Interval) -> String {
    format!("{} [{}, {}]", figures(x.estimate), figures(x.low), figures(x.high))
}

fn costs(families: &[Family]) -> Table {
    let rows = families.iter().map(|family| {
        let block = family.steps_per_test.filter(|ratio| ratio.estimate > 0.0 && ratio.low > 0.0).map(|ratio| {
            let block = |x: f64| 8.0 / x;
            ns(Interval { estimate: block(ratio.estimate), low: block(ratio.high), high: block(ratio.low) })
        });
        vec![
            family.family.as_str().into(),
            family.observations.len().to_string().into(),
            ns(family.ray_ns).into(),
            ns(family.step_ns).into(),
            ns(family.test_ns).into(),
            family.steps_per_test.map_or(Cell::blank(), |ratio| ns(ratio).into()),
            block.map_or(Cell::blank(), Cell::from),
            format!("{:.3}", family.r_squared).into(),
            format!("{:.2}", family.typical_factor).into(),
            format!("{:.2}", family.worst_factor).into(),
        ]
    });
    Table {
        title: "What a ray, a step and a triangle test cost, nanoseconds".into(),
        columns: ["family", "cases", "K_0", "K_T", "K_I", "K_T / K_I", "8 K_I / K_T", "R2", "off", "worst"]
            .map(String::from)
            .into(),
        rows: rows.collect(),
        notes: vec![format!(
            "{SAH_TREE} is built as if a block cost {} steps.",
            KdConfig::SAH.intersection_cost / KdConfig::SAH.traversal_cost
        )],
    }
}

/// Cases of each family that are shown.
const SHOWN: usize = 3;

fn worst(families: &[Family]) -> Table {
    let mut rows = vec![];
    for family in families {
        let mut cases: Vec<_> = family.observations.iter().map(|o| (o.predicted_ns / o.ns_per_ray, o)).collect();
        cases.sort_by(|a, b| libm::fabs(libm::log(b.0)).total_cmp(&libm::fabs(libm::log(a.0))));
        rows.extend(cases.into_iter().take(SHOWN).map(|(factor, case)| {
            vec![
                family.family.as_str().into(),
                format!("{}, {}, {}", case.structure, case.scene, case.workload).into(),
                figures(case.steps_per_ray).into(),
                figures(case.tests_per_ray).into(),
                duration(case.ns_per_ray).into(),
                duration(case.predicted_ns).into(),
                format!("{factor:.2}").into(),
            ]
        }));
    }
    Table {
        title: "The cases that are predicted worst".into(),
        columns: ["family", "case", "steps", "tests", "measured", "predicted", "predicted / measured"]
            .map(String::from)
            .into(),
        rows,
        notes: vec![],
    }
}
