//! What each structure returns for rays that are given one by one.

use std::sync::Arc;
use std::time::Duration;

use crate::accel::DynAccel;
use crate::geometry::{Mesh, Ray};
use crate::report::{Cell, Table, Tone};
use crate::scene::offset::barycentrics;
use crate::validate::watched;

/// One row per ray: number of the ray, t, triangle, and where on it.
pub fn answers(label: &str, accel: &Arc<dyn DynAccel>, rays: &[Ray], mesh: &Mesh, limit: Duration) -> Vec<Vec<Cell>> {
    let row = |(i, ray): (usize, &Ray)| {
        let mut row: Vec<Cell> = vec![label.into(), format!("{} ({ray})", i + 1).into()];
        row.extend(answer(accel, ray, mesh, limit));
        row.resize(COLUMNS.len(), Cell::empty());
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

const COLUMNS: [&str; 6] = ["structure", "ray", "t", "triangle", "u", "v"];

pub fn table(scene: &str, of_structures: &[Vec<Vec<Cell>>]) -> Table {
    let rays = of_structures.first().map_or(0, Vec::len);
    let rows = (0..rays).flat_map(|ray| of_structures.iter().map(move |rows| rows[ray].clone()));
    let note = "u, v: weights of the second and third corner of the triangle where the ray meets its plane, in f64. \
                Triangles count from 0.";
    Table::new(format!("{scene}: answers"), COLUMNS, rows).noted(vec![note.into()])
}
