//! The tables of a scene: a row for each structure, and what each returns for rays that are given one by one.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use crate::accel::DynAccel;
use crate::geometry::{Mesh, Ray};
use crate::report::number::{count, plural};
use crate::report::{Cell, Table, Tone};
use crate::scene::Scene;
use crate::scene::offset::barycentrics;
use crate::validate::{Validation, watched};

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

/// What was found of a structure, or the word for why it was not built.
pub fn row(label: &str, test: &str, found: Result<&Validation, &str>) -> Vec<Cell> {
    let mut row: Vec<Cell> = vec![label.into(), test.into()];
    let errors = |n: u64| Cell::from(count(n)).with(if n > 0 { Tone::Wrong } else { Tone::Plain });
    match found {
        Ok(found) => row.extend([
            if found.rays == 0 && found.declined > 0 { "declined".into() } else { count(found.hits).into() },
            errors(found.errors() - found.answer_errors),
            errors(found.answer_errors + found.depth_errors),
            count(found.answer_errors).into(),
            count(found.test_errors).into(),
            count(found.ties).into(),
        ]),
        Err(why) => row.push(Cell::from(why).with(Tone::Wrong)),
    }
    row.resize(COLUMNS.len(), Cell::empty());
    row
}

/// One row per ray: number of the ray, t, triangle, and where on it.
pub fn answers(label: &str, accel: &Arc<dyn DynAccel>, rays: &[Ray], mesh: &Mesh, limit: Duration) -> Vec<Vec<Cell>> {
    let row = |(i, ray): (usize, &Ray)| {
        let mut row: Vec<Cell> = vec![label.into(), format!("{} ({ray})", i + 1).into()];
        row.extend(answer(accel, ray, mesh, limit));
        row.resize(ANSWERS.len(), Cell::empty());
        row
    };
    rays.iter().enumerate().map(row).collect()
}

fn answer(accel: &Arc<dyn DynAccel>, ray: &Ray, mesh: &Mesh, limit: Duration) -> Vec<Cell> {
    if let Some(what) = accel.capabilities().declines(ray) {
        return vec![format!("declines {what}").into()];
    }
    let (own, ray) = (Arc::clone(accel), *ray);
    match watched(limit, move || own.closest(&[ray])[0]) {
        Err(_) => vec![Cell::from("no answer").with(Tone::Wrong)],
        Ok(None) => vec!["no hit".into()],
        Ok(Some(hit)) => {
            let index = hit.prim.index();
            let weights = ((index as usize) < mesh.len()).then(|| barycentrics(&ray, mesh.corners(index)));
            let [u, v] = [weights.map(|w| w.y), weights.map(|w| w.z)].map(|x| x.map(|x| format!("{x:.9}")).into());
            vec![hit.t.to_string().into(), index.to_string().into(), u, v]
        }
    }
}

const ANSWERS: [&str; 6] = ["structure", "ray", "t", "triangle", "u", "v"];

pub fn answer_table(scene: &str, of_structures: &[Vec<Vec<Cell>>]) -> Table {
    let rays = of_structures.first().map_or(0, Vec::len);
    let rows = (0..rays).flat_map(|ray| of_structures.iter().map(move |rows| rows[ray].clone()));
    let note = "u, v: weights of the second and third corner of the triangle where the ray meets its plane, in f64. \
                Triangles count from 0.";
    Table::new(format!("{scene}: answers"), ANSWERS, rows).noted(vec![note.into()])
}
