//! The growth as tables for people.

use super::{Growth, Point};
use crate::measure::Estimate;
use crate::report::number::{bytes, count, duration, figures};
use crate::report::words::{explained, written};
use crate::report::{Cell, Table};
use crate::study::grouped::grouped;

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
    let over = |growth: &&Growth| {
        let fitted: Vec<usize> = growth.points.iter().filter(|p| p.fitted).map(|p| p.triangles).collect();
        match (fitted.first(), fitted.last()) {
            (Some(&first), Some(&last)) => {
                format!("{}: {} to {}", fitted.len(), count(first as u64), count(last as u64))
            }
            _ => "0".into(),
        }
    };
    let table = Table::of(
        title(group, "powers of the number of triangles"),
        group.iter().copied(),
        &[
            ("structure", &|growth| growth.structure.as_str().into()),
            ("time a ray", &|growth| power(growth.time)),
            ("+-", &|growth| growth.scatter.map(|half| format!("{half:.2}")).into()),
            ("build", &|growth| power(growth.build)),
            ("memory", &|growth| power(growth.bytes)),
            ("tests", &|growth| power(growth.tests)),
            ("steps", &|growth| power(growth.steps)),
            ("meshes: triangles", &|growth| over(growth).into()),
        ],
    );
    explained(table.noted(vec![
            "Least squares on logarithms over the meshes on which the structure has more than one leaf, with 95 % intervals for another run \
             on these meshes; counts and memory do not vary. +-: half of the 95 % interval of the power of time by the scatter of the meshes \
             about it."
                .into(),
        ]))
}

pub(super) fn points(group: &[&Growth]) -> Table {
    let known = |x: Option<f64>| Cell::from(x.map(figures));
    let one_leaf = |p: &Point| if p.fitted { "" } else { " (one leaf)" };
    let points = group.iter().flat_map(|growth| growth.points.iter().map(|point| (&growth.structure, point)));
    Table::of(
        title(group, "what was measured"),
        points,
        &[
            ("structure", &|(structure, p)| format!("{structure}{}", one_leaf(p)).into()),
            ("mesh", &|(_, p)| p.scene.as_str().into()),
            ("triangles", &|(_, p)| count(p.triangles as u64).into()),
            ("time a ray", &|(_, p)| duration(p.ns_per_ray).into()),
            ("tests", &|(_, p)| known(p.tests_per_ray)),
            ("steps", &|(_, p)| known(p.steps_per_ray)),
            ("build", &|(_, p)| duration(p.build_ns).into()),
            ("memory a triangle", &|(_, p)| bytes(p.bytes_per_triangle as usize).into()),
        ],
    )
}
