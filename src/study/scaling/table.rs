//! The growth as tables for people.

use super::Growth;
use crate::measure::Estimate;
use crate::report::number::{bytes, count, duration, figures};
use crate::report::words::{explained, written};
use crate::report::{Cell, Table};
use crate::study::grouped::grouped;

/// For each family and kind of rays the exponents, then the points they come from.
pub fn tables(growths: &[Growth]) -> Vec<Table> {
    groups(growths).iter().flat_map(|group| [exponents(group), points(group)]).collect()
}

pub(super) fn groups(growths: &[Growth]) -> Vec<Vec<&Growth>> {
    grouped(growths, |a, b| a.family == b.family && a.workload == b.workload)
}

fn power(x: Option<Estimate>) -> Cell {
    x.map(|x| written(x, |x| format!("{x:.2}"))).into()
}

fn title(group: &[&Growth], what: &str) -> String {
    format!("{}, {} rays: {what}", group[0].family.name(), group[0].workload)
}

pub(super) fn exponents(group: &[&Growth]) -> Table {
    let rows = group.iter().map(|growth| {
        let fitted: Vec<usize> = growth.points.iter().filter(|p| p.fitted).map(|p| p.triangles).collect();
        let over = match (fitted.first(), fitted.last()) {
            (Some(&first), Some(&last)) => {
                format!("{}: {} to {}", fitted.len(), count(first as u64), count(last as u64))
            }
            _ => "0".into(),
        };
        let scatter = growth.scatter.map(|half| format!("{half:.2}")).into();
        let powers = [growth.build, growth.bytes, growth.tests, growth.steps].map(power);
        [growth.structure.as_str().into(), power(growth.time), scatter]
            .into_iter()
            .chain(powers)
            .chain([over.into()])
            .collect()
    });
    explained(Table::new(title(group, "powers of the number of triangles"), ["structure", "time a ray", "+-", "build", "memory", "tests", "steps", "meshes: triangles"], rows).noted(vec![
            "Least squares on logarithms over the meshes on which the structure has more than one leaf, with 95 % intervals for another run \
             on these meshes; counts and memory do not vary. +-: half of the 95 % interval of the power of time by the scatter of the meshes \
             about it."
                .into(),
        ]))
}

pub(super) fn points(group: &[&Growth]) -> Table {
    let known = |x: Option<f64>| x.map(figures).into();
    let rows = group.iter().flat_map(|growth| {
        growth.points.iter().map(|point| {
            let of = format!("{}{}", growth.structure, if point.fitted { "" } else { " (one leaf)" });
            vec![
                of.into(),
                point.scene.as_str().into(),
                count(point.triangles as u64).into(),
                duration(point.ns_per_ray).into(),
                known(point.tests_per_ray),
                known(point.steps_per_ray),
                duration(point.build_ns).into(),
                bytes(point.bytes_per_triangle as usize).into(),
            ]
        })
    });
    Table::new(
        title(group, "what was measured"),
        ["structure", "mesh", "triangles", "time a ray", "tests", "steps", "build", "memory a triangle"],
        rows,
    )
}
