//! The table of a scene: one row for each structure.

use std::fmt;

use crate::geometry::Ray;
use crate::registry::Choice;
use crate::report::number::{count, plural};
use crate::report::{Cell, Table, Tone};
use crate::scene::Scene;
use crate::validate::Validation;

pub fn scene_table(
    scene: &Scene,
    rays: &[Ray],
    reference: &dyn fmt::Display,
    rows: Vec<Vec<Cell>>,
    notes: Vec<String>,
) -> Table {
    let stand_in = if scene.stand_ins.is_empty() { "" } else { ", stand-in" };
    let (triangles, rays) = (plural(scene.mesh.len(), "triangle"), plural(rays.len(), "ray"));
    let title = format!("{}: {triangles}{stand_in}; {rays} against {reference}", scene.name);
    Table::new(title, COLUMNS, rows).noted(notes)
}

const COLUMNS: [&str; 8] =
    ["structure", "triangle test", "hits", "structure errors", "answer errors", "coarse", "test errors", "ties"];

/// Where the reference has another triangle test, exact arithmetic may find either of the two wrong.
pub fn note_on_reference(name: &str, found: &Validation) -> Option<String> {
    let rays = plural(found.reference_errors as usize, "ray");
    (found.reference_errors > 0).then(|| format!("On {rays} the reference is wrong and not {name}: no errors of it."))
}

pub const LEGEND: [&str; 4] = [
    "hits: rays that hit something by the reference. structure errors: hits lost or invented although the structure's own \
     triangle test, run over all triangles, says otherwise, contradictions, panics and queries that never return; none in a \
     correct structure. answer errors: wrong hits where the reference has another triangle test.",
    "A depth is wrong if it is off by more than 4 ulps and more than 1e-6. coarse: the answer errors that remain if up to 1 %, \
     or 0.1 % on another triangle, is allowed; the others are common where tests in f32 meet grazing rays, and without \
     --against they do not change the exit status.",
    "test errors: those that the triangle test causes, not the structure. ties: hits on another triangle at the same depth; no \
     errors.",
    "To trace a ray again: sahara validate SCENE --structure NAME --ray \"ox,oy,oz dx,dy,dz\"",
];

pub fn failure_row(choice: &Choice, why: &str) -> Vec<Cell> {
    let mut row = vec![Cell::empty(); COLUMNS.len()];
    row[0] = choice.label.as_str().into();
    row[1] = choice.triangle_test().into();
    row[2] = Cell::from(why).with(Tone::Wrong);
    row
}

pub fn row(label: &str, test: &str, found: &Validation) -> Vec<Cell> {
    let errors = |n: u64| Cell::from(count(n)).with(if n > 0 { Tone::Wrong } else { Tone::Plain });
    let own = found.errors() - found.answer_errors;
    let hits = if found.rays == 0 && found.declined > 0 { "declined".into() } else { count(found.hits) };
    vec![
        label.into(),
        test.into(),
        hits.into(),
        errors(own),
        errors(found.answer_errors + found.depth_errors),
        count(found.answer_errors).into(),
        count(found.test_errors).into(),
        count(found.ties).into(),
    ]
}
