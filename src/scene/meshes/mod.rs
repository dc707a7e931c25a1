//! Mesh generators; their meshes are the same bit for bit on every machine.

mod catmull_clark;
mod coincident;
mod creatures;
mod dragon;
mod fit;
mod icosahedron;
mod icosphere;
mod lucy;
mod noise;
mod normals;
mod patches;
mod plane;
mod sdf;
mod sponza;
mod teapot;
mod terrain;
mod torus;
mod uv_sphere;

#[cfg(test)]
mod tests;

use glam::{DVec3, Vec3};

use super::Model;

pub use coincident::{fan, growing_shells, near_duplicates, shared_faces, tiled_floor, two_cities};
pub use creatures::{elephant, fox, rabbit};
pub use dragon::dragon;
pub use icosahedron::{icosahedron, inside_out_icosahedron};
pub use icosphere::{divided_icosphere, icosphere};
pub use lucy::lucy;
pub use plane::{cornellbox, cube, plane_y};
pub use sponza::sponza;
pub use teapot::teapot;
pub use terrain::Terrain;
pub use torus::torus;
pub use uv_sphere::uv_sphere;

/// A mesh generator and its name in scene files.
pub struct Generator {
    pub name: &'static str,
    pub make: fn() -> Model,
}

/// All generators that a scene file can name.
pub const GENERATORS: &[Generator] = &[
    Generator { name: "cube", make: cube },
    Generator { name: "plane_y", make: plane_y },
    Generator { name: "cornellbox", make: cornellbox },
    Generator { name: "icosahedron", make: icosahedron },
    Generator { name: "inside_out_icosahedron", make: inside_out_icosahedron },
    Generator { name: "icosphere", make: || icosphere(3) },
    Generator { name: "uv_sphere", make: || uv_sphere(40, 26) },
    Generator { name: "torus", make: || torus(48, 24, 0.37) },
    Generator { name: "teapot", make: teapot },
    Generator { name: "rabbit", make: rabbit },
    Generator { name: "fox", make: fox },
    Generator { name: "elephant", make: elephant },
    Generator { name: "dragon", make: dragon },
    Generator { name: "lucy", make: lucy },
    Generator { name: "sponza", make: sponza },
    Generator { name: "two_cities", make: two_cities },
    Generator { name: "shared_faces", make: shared_faces },
    Generator { name: "tiled_floor", make: tiled_floor },
    Generator { name: "fan", make: || fan(1500) },
    Generator { name: "near_duplicates", make: near_duplicates },
    Generator { name: "growing_shells", make: growing_shells },
];

/// The mesh called `name`; `None` if there is no such generator.
pub fn by_name(name: &str) -> Option<Model> {
    GENERATORS.iter().find(|g| g.name == name).map(|g| (g.make)())
}

/// Cosine and sine of `step` of `steps` equal parts of a full turn, exact at the quarters.
fn on_circle(step: u32, steps: u32) -> (f64, f64) {
    match (4 * u64::from(step % steps), u64::from(steps)) {
        (0, _) => (1.0, 0.0),
        (s, n) if s == n => (0.0, 1.0),
        (s, n) if s == 2 * n => (-1.0, 0.0),
        (s, n) if s == 3 * n => (0.0, -1.0),
        _ => {
            let (sine, cosine) = libm::sincos(f64::from(step) * std::f64::consts::TAU / f64::from(steps));
            (cosine, sine)
        }
    }
}

/// A smooth model with the normals of the course's mesh files.
fn smooth(points: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Model {
    Model {
        normals: normals::of_the_course(&points, &triangles),
        positions: points.into_iter().map(|p| p.as_vec3()).collect(),
        normal_indices: triangles.clone(),
        triangles,
        ..Model::default()
    }
}

fn flat(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Model {
    Model { positions, triangles, ..Model::default() }
}

/// The triangles of a net of quadrilaterals, row by row; `quad` returns the corners for a row and a column.
fn net(rows: u32, columns: u32, quad: impl Fn(u32, u32) -> [u32; 4]) -> Vec<[u32; 3]> {
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    cells.flat_map(|(row, column)| halves(quad(row, column))).collect()
}

/// Both triangles of a quadrilateral, cut from its first corner to its third.
fn halves([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, c], [a, c, d]]
}
