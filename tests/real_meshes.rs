//! The loaders on meshes as they are found in the world, which the suite does not carry. The environment variable
//! `SAHARA_DATA` names a folder with the files; without it these tests say that they were skipped.

use std::path::PathBuf;

use sahara::geometry::{Aabb, Mesh};
use sahara::scene::{Model, load};

/// The model and mesh of a file, nothing when there is no such file.
fn real(name: &str) -> Option<(Model, Mesh)> {
    let Some(folder) = std::env::var_os("SAHARA_DATA") else {
        println!("{name}: skipped, the environment variable SAHARA_DATA names no folder with meshes");
        return None;
    };
    let path = PathBuf::from(folder).join(name);
    if !path.is_file() {
        println!("{name}: skipped, there is no {}", path.display());
        return None;
    }
    let mut model = load(&path).unwrap();
    println!("{name}: {:?}", model.notes);
    let (positions, triangles) = (std::mem::take(&mut model.positions), std::mem::take(&mut model.triangles));
    Some((model, Mesh::new(positions, triangles).unwrap()))
}

struct Expected {
    triangles: usize,
    vertices: usize,
    degenerate: usize,
    materials: usize,
    min: [f32; 3],
    max: [f32; 3],
}

fn check(name: &str, expected: Expected) {
    let Some((model, mesh)) = real(name) else { return };
    let Expected { triangles, vertices, degenerate, materials, min, max } = expected;
    let found = (mesh.len(), mesh.positions().len(), mesh.degenerate().len(), model.materials.len());
    assert_eq!(found, (triangles, vertices, degenerate, materials), "triangles, vertices, degenerate, materials");
    assert_eq!(mesh.bounds(), Aabb { min: min.into(), max: max.into() });
}

#[test]
fn dragon() {
    let (min, max) = ([-7.0467, 0.0, -3.151_299_95], [7.0467, 9.939_900_4, 3.151_299_95]);
    check("dragon.obj", Expected { triangles: 100_000, vertices: 50_000, degenerate: 0, materials: 1, min, max });
}

#[test]
fn lucy() {
    let max = [464.913_574, 798.450_562, 266.838_562];
    let min = max.map(|c: f32| -c);
    check("lucy.ply", Expected { triangles: 100_000, vertices: 50_002, degenerate: 0, materials: 1, min, max });
}

#[test]
fn sponza() {
    let (min, max) = ([-1920.945_92, -126.442_497, -1182.807_13], [1799.908_08, 1429.433_23, 1105.426_03]);
    check("sponza.obj", Expected { triangles: 262_267, vertices: 145_185, degenerate: 1, materials: 25, min, max });
}

#[test]
fn sponza_dabrovic() {
    let (min, max) = ([-17.402_759_6, -0.906_688_988, -7.798_511_98], [17.417_240_1, 15.653_311_7, 7.801_488_88]);
    check(
        "sponza_dabrovic.obj",
        Expected { triangles: 66_454, vertices: 39_999, degenerate: 1, materials: 1, min, max },
    );
}

#[test]
fn teapot() {
    let (min, max) = ([-3.0, 0.0, -2.0], [3.434_000_02, 3.150_000_1, 2.0]);
    check("teapot.obj", Expected { triangles: 6320, vertices: 3644, degenerate: 0, materials: 1, min, max });
}

#[test]
fn teapot_4032() {
    let (min, max) = ([-23.096_241, -9.328_575_13, -15.123_246_2], [26.321_558, 15.076_026, 15.098_364_8]);
    check("teapot_4032.obj", Expected { triangles: 4032, vertices: 2082, degenerate: 0, materials: 1, min, max });
}

#[test]
fn bunny() {
    let (min, max) =
        ([-0.094_689_898_2, 0.032_987_400_1, -0.061_873_599_9], [0.061_009_101_6, 0.187_321_007, 0.058_799_698_9]);
    check("bunny.ply", Expected { triangles: 69_451, vertices: 35_947, degenerate: 0, materials: 1, min, max });
}

#[test]
fn kitchen() {
    let (min, max) = ([-1.930_758, -0.034_230_999_6, -2.479_913], [3.614_573_96, 2.523_190_98, 2.593_478_92]);
    check("kitchen.obj", Expected { triangles: 56_939, vertices: 74_303, degenerate: 25, materials: 33, min, max });
}

#[test]
fn two_cylinder_engine() {
    let (min, max) = ([-371.692_261, -180.971_558, -140.0], [371.692_169, 92.041_564_9, 128.0]);
    check(
        "two_cylinder_engine.glb",
        Expected { triangles: 121_496, vertices: 84_657, degenerate: 11_160, materials: 34, min, max },
    );
}

#[test]
fn san_miguel_part() {
    let (min, max) = ([-37.973_598_5, -0.381_559_014, -36.950_698_9], [46.774_398_8, 53.519_599_9, 36.936_298_4]);
    check(
        "san_miguel_part.glb",
        Expected { triangles: 1_093_419, vertices: 691_308, degenerate: 239, materials: 117, min, max },
    );
}
