//! The tables of the command `validate` for one scene.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use super::outcome::{BuildFailure, Outcome};
use crate::accel::DynAccel;
use crate::geometry::{Mesh, Ray};
use crate::report::number::{count, plural};
use crate::report::{Cell, Table, Tone};
use crate::scene::Scene;
use crate::scene::offset::barycentrics;
use crate::study::Verdict;
use crate::validate::{Validation, has_replied, watched};

pub fn scene_table(
    scene: &Scene,
    rays: &[Ray],
    reference: &dyn fmt::Display,
    outcomes: &[Outcome],
    notes: Vec<String>,
) -> Table {
    let stand_in = if scene.stand_ins.is_empty() { "" } else { ", stand-in" };
    let (triangles, rays) = (plural(scene.mesh.len(), "triangle"), plural(rays.len(), "ray"));
    let title = format!("{}: {triangles}{stand_in}; {rays} against {reference}", scene.name);
    let row = |own: &Outcome| COLUMNS.iter().map(|(_, cell)| cell(own)).collect();
    let table = Table::new(title, COLUMNS.map(|(name, _)| name), outcomes.iter().map(row));
    table.with_details(COLUMNS.iter().skip(5).map(|(name, _)| *name)).noted(notes)
}

type OutcomeColumn = (&'static str, fn(&Outcome) -> Cell);

const COLUMNS: [OutcomeColumn; 10] = [
    ("structure", |own| own.label.as_str().into()),
    ("triangle test", |own| own.triangle_test.as_str().into()),
    ("hits", hits),
    ("wrong", |own| errors(own, |found| Verdict::from(found).wrong)),
    ("rounded", |own| number(own, |found| Verdict::from(found).rounded)),
    ("structure errors", |own| errors(own, |found| found.errors() - found.answer_errors)),
    ("answer errors", |own| errors(own, |found| found.answer_errors)),
    ("depth errors", |own| number(own, |found| found.depth_errors)),
    ("test errors", |own| number(own, |found| found.test_errors)),
    ("ties", |own| number(own, |found| found.ties)),
];

fn hits(own: &Outcome) -> Cell {
    match &own.found {
        Err(BuildFailure::Hangs(_)) => Cell::from("hangs").with(Tone::Wrong),
        Err(BuildFailure::Refused(_)) => Cell::from("refused").with(Tone::Wrong),
        Ok(found) if found.rays == 0 && found.declined > 0 => "declined".into(),
        Ok(found) => count(found.hits).into(),
    }
}

fn number(own: &Outcome, of: fn(&Validation) -> u64) -> Cell {
    own.found.as_ref().map_or(Cell::empty(), |found| count(of(found)).into())
}

fn errors(own: &Outcome, of: fn(&Validation) -> u64) -> Cell {
    let is_wrong = own.found.as_ref().is_ok_and(|found| of(found) > 0);
    number(own, of).with(if is_wrong { Tone::Wrong } else { Tone::Plain })
}

pub fn note_on_reference(name: &str, found: &Validation) -> Option<String> {
    let rays = plural(found.reference_errors as usize, "ray");
    (found.reference_errors > 0).then(|| format!("On {rays} the reference is wrong, not {name}."))
}

pub const RETRACE: &str = "Trace a ray again, with its interval if it has one: sahara validate SCENE --structure NAME --ray \"ox,oy,oz dx,dy,dz [t_min,t_max]\" \
     (a program: --runner COMMAND instead of --structure NAME)";

pub const LEGEND: [&str; 3] = [
    "hits: rays with a hit in the reference. wrong: hits that no rounding of the triangle test explains, contradictions, panics \
     and queries that never return; a correct structure has none. rounded: hits that differ from the reference because the \
     triangle test rounds; they change the exit status only with --strict.",
    "structure errors: hits that the structure lost or invented; its triangle test, run over all triangles, has other \
     results. answer errors: wrong hits of a structure whose triangle test sahara does not have; exact arithmetic \
     finds them, and no rounding explains them. depth errors: depths of such a structure that are off by more than 4 \
     ulps and more than 1e-6, but within the bound on rounding.",
    "test errors: errors of the triangle test, not of the structure. ties: hits on another triangle at the same t; not \
     errors.",
];

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
        Ok(Some(hit)) if has_replied(accel.as_ref()).is_ok() => {
            let index = hit.prim.index();
            let weights = ((index as usize) < mesh.len()).then(|| barycentrics(&ray, mesh.corners(index)));
            let [u, v] = [weights.map(|w| w.y), weights.map(|w| w.z)].map(|x| x.map(|x| format!("{x:.9}")).into());
            vec![hit.t.to_string().into(), index.to_string().into(), u, v]
        }
        Ok(None) if has_replied(accel.as_ref()).is_ok() => vec!["no hit".into()],
        _ => vec![Cell::from("no answer").with(Tone::Wrong)],
    }
}

const ANSWERS: [&str; 6] = ["structure", "ray", "t", "triangle", "u", "v"];

pub fn answer_table(scene: &str, of_structures: &[Vec<Vec<Cell>>]) -> Table {
    let rays = of_structures.first().map_or(0, Vec::len);
    let rows = (0..rays).flat_map(|ray| of_structures.iter().map(move |rows| rows[ray].clone()));
    let note = "u, v: barycentric weights of the second and third corner where the ray meets the triangle's plane, in f64. \
                Triangle numbers start at 0.";
    Table::new(format!("{scene}: hits"), ANSWERS, rows).noted([note])
}
