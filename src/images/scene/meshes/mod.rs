//! Mesh generators. The meshes are bit-identical on every machine.

mod catmull_clark;
mod coincident;
mod creatures;
mod dragon;
mod fit;
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
mod turned;

#[cfg(test)]
mod tests;

use glam::{DVec3, Vec3};

use super::Model;

pub use coincident::fan;
pub use icosphere::icosphere;
pub use teapot::teapot;
pub use terrain::Terrain;
pub use turned::uv_sphere;

pub struct Generator {
    pub name: &'static str,
    pub make: fn() -> Model,
}

pub const GENERATORS: &[Generator] = &[
    Generator { name: "cube", make: plane::cube },
    Generator { name: "plane_y", make: plane::plane_y },
    Generator { name: "cornellbox", make: plane::cornellbox },
    Generator { name: "icosahedron", make: icosphere::icosahedron },
    Generator { name: "inside_out_icosahedron", make: icosphere::inside_out_icosahedron },
    Generator { name: "icosphere", make: || icosphere(8) },
    Generator { name: "uv_sphere", make: || uv_sphere(40, 26) },
    Generator { name: "torus", make: turned::torus },
    Generator { name: "teapot", make: teapot },
    Generator { name: "rabbit", make: creatures::rabbit },
    Generator { name: "fox", make: creatures::fox },
    Generator { name: "elephant", make: creatures::elephant },
    Generator { name: "dragon", make: dragon::dragon },
    Generator { name: "lucy", make: lucy::lucy },
    Generator { name: "sponza", make: sponza::sponza },
    Generator { name: "two_cities", make: coincident::two_cities },
    Generator { name: "shared_faces", make: coincident::shared_faces },
    Generator { name: "tiled_floor", make: coincident::tiled_floor },
    Generator { name: "fan", make: || fan(1500) },
    Generator { name: "near_duplicates", make: coincident::near_duplicates },
    Generator { name: "growing_shells", make: coincident::growing_shells },
];

pub fn by_name(name: &str) -> Option<Model> {
    GENERATORS.iter().find(|g| g.name == name).map(|g| (g.make)())
}

fn smooth(points: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Model {
    Model {
        normals: normals::by_angle_quantised(&points, &triangles),
        positions: points.into_iter().map(|p| p.as_vec3()).collect(),
        normal_indices: triangles.clone(),
        triangles,
        ..Model::default()
    }
}

fn flat(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Model {
    Model { positions, triangles, ..Model::default() }
}

/// `quad(row, column)` returns the four corners of one quadrilateral, in order around its boundary.
fn net(rows: u32, columns: u32, quad: impl Fn(u32, u32) -> [u32; 4]) -> Vec<[u32; 3]> {
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    cells.flat_map(|(row, column)| halves(quad(row, column))).collect()
}

fn halves([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, c], [a, c, d]]
}
