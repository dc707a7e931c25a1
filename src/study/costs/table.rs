//! The costs as tables for people.

use super::{Family, Observation, Off};
use crate::kdtree::KdConfig;
use crate::measure::Estimate;
use crate::report::Table;
use crate::report::number::{duration, figures};
use crate::report::words::interval;
use crate::study::SAH_TREE;

/// What the columns mean.
pub const LEGEND: [&str; 2] = [
    "Time of a ray = K_0 + K_T steps + K_B blocks, no cost below 0, by the ratios of predicted to measured time, so that slow cases do not \
     rule. A block: triangles that are tested at once, eight or, in obvhs, one. 95 % intervals for as many other scenes, jackknifed over \
     scenes. R2: share of the variance of ln time that is explained.",
    "off: median and largest of the factors between predicted and measured time, on the scenes that the costs were found on and, left out, on \
     each scene by the costs of all others. What the heuristic should be told on this machine: with a step at 1, a block costs K_B / K_T.",
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

fn cost(x: Estimate) -> String {
    match x.interval {
        Some(_) => interval(x),
        None => figures(x.estimate),
    }
}

fn costs(families: &[Family]) -> Table {
    let rows = families.iter().map(|family| {
        let off = |off: Option<Off>| off.map(|off| format!("{:.2}, {:.2}", off.median, off.worst)).into();
        vec![
            family.family.as_str().into(),
            format!("{}, {}", family.observations.len(), family.scenes).into(),
            cost(family.ray_ns).into(),
            cost(family.step_ns).into(),
            cost(family.block_ns).into(),
            family.steps_per_block.map(cost).into(),
            format!("{:.3}", family.r_squared).into(),
            off(family.known),
            off(family.foreseen),
        ]
    });
    let mut notes = vec![format!(
        "{SAH_TREE} is built as if a block cost {} steps.",
        KdConfig::SAH.intersection_cost / KdConfig::SAH.traversal_cost
    )];
    if families.iter().any(|family| family.block_ns.interval.is_none()) {
        notes.push("Without an interval: of one scene, or known from too few without each of them.".into());
    }
    Table::new(
        "What a ray, a step and a block of triangles cost, nanoseconds",
        ["family", "cases, scenes", "K_0", "K_T", "K_B", "K_B / K_T", "R2", "off", "off, left out"],
        rows,
    )
    .noted(notes)
}

/// Cases of each family that are shown.
const SHOWN: usize = 3;

fn worst(families: &[Family]) -> Table {
    let mut rows = vec![];
    for family in families {
        // Out of sample, where there is another scene.
        let predicted = |o: &Observation| o.foreseen_ns.unwrap_or(o.predicted_ns);
        let mut cases: Vec<_> = family.observations.iter().map(|o| (predicted(o) / o.ns_per_ray, o)).collect();
        cases.sort_by(|a, b| libm::fabs(libm::log(b.0)).total_cmp(&libm::fabs(libm::log(a.0))));
        rows.extend(cases.into_iter().take(SHOWN).map(|(factor, case)| {
            vec![
                family.family.as_str().into(),
                format!("{}, {}, {}", case.structure, case.scene, case.workload).into(),
                figures(case.steps_per_ray).into(),
                figures(case.blocks_per_ray).into(),
                duration(case.ns_per_ray).into(),
                duration(predicted(case)).into(),
                format!("{factor:.2}").into(),
            ]
        }));
    }
    Table::new(
        "The cases that are predicted worst by the costs of the other scenes",
        ["family", "case", "steps", "blocks", "measured", "predicted", "predicted / measured"],
        rows,
    )
}
