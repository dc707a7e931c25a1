//! The data of a scatter plot as its script reads them.

use serde::Serialize;

use super::json::json;
use crate::report::plot::palette::roles_of;
use crate::report::plot::{Scatter, ScatterCase, ScatterPoint};
use crate::report::words::distinct;

#[derive(Serialize)]
struct CaseData<'a> {
    scene: &'a str,
    rays: &'a str,
    points: Vec<PointData<'a>>,
}

#[derive(Serialize)]
struct PointData<'a> {
    label: &'a str,
    /// Name of the custom property with its colour.
    colour: String,
    bytes: f64,
    build: f64,
    ray: f64,
    ratio: &'a str,
}

/// As JSON that may stand in a script element.
pub fn data(scatter: &Scatter) -> String {
    // A structure has one colour in all cases.
    let all: Vec<String> = scatter.cases.iter().flat_map(|case| &case.points).map(|p| p.label.clone()).collect();
    let labels = distinct(all.iter());
    let roles = roles_of(&labels);
    let colour = |label: &String| {
        let place = labels.iter().position(|other| other == label).expect("all labels are listed");
        format!("--{}", roles[place].name())
    };
    json(&cases(scatter, &colour))
}

fn cases<'a>(scatter: &'a Scatter, colour: &dyn Fn(&String) -> String) -> Vec<CaseData<'a>> {
    let point = |p: &'a ScatterPoint| PointData {
        label: &p.label,
        colour: colour(&p.label),
        bytes: p.bytes,
        build: p.build_ns,
        ray: p.ns_per_ray,
        ratio: &p.ratio,
    };
    let case = |case: &'a ScatterCase| CaseData {
        scene: &case.scene,
        rays: &case.rays,
        points: case.points.iter().map(point).collect(),
    };
    scatter.cases.iter().map(case).collect()
}
