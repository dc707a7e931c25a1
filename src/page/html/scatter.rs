//! The data of a scatter plot for its script.

use serde_json::{Value, json};

use super::in_script;
use crate::report::plot::palette::roles_of;
use crate::report::plot::{Tradeoff, TradeoffCase, TradeoffPoint};
use crate::report::words::distinct;

pub fn data(tradeoff: &Tradeoff) -> String {
    // A structure has one colour in all cases.
    let all: Vec<String> = tradeoff.cases.iter().flat_map(|case| &case.points).map(|p| p.label.clone()).collect();
    let labels = distinct(all.iter());
    let roles = roles_of(&labels);
    let colour = |label: &String| {
        let place = labels.iter().position(|other| other == label).expect("all labels are listed");
        format!("--{}", roles[place].name)
    };
    let point = |p: &TradeoffPoint| {
        json!({
            "label": p.label,
            // Name of the custom property with its colour.
            "colour": colour(&p.label),
            "bytes": p.bytes,
            "build": p.build_ns,
            "ray": p.ns_per_ray,
            "ratio": p.ratio,
        })
    };
    let case = |case: &TradeoffCase| {
        let points: Vec<Value> = case.points.iter().map(point).collect();
        json!({ "scene": case.scene, "rays": case.workload, "points": points })
    };
    in_script(&tradeoff.cases.iter().map(case).collect::<Vec<Value>>())
}
