//! The loaders, and views, on meshes as they are found in the world, which the suite does not carry. The environment variable
//! `SAHARA_DATA` names a folder with the files; without it these tests say that they were skipped.

#![expect(clippy::excessive_precision, reason = "nine digits name an f32, fewer may too")]

use std::path::{Path, PathBuf};

use sahara::accel::Accel;
use sahara::bvh8::{Bvh8, Bvh8Config};
use sahara::geometry::{Aabb, Mesh};
use sahara::scene::format::SceneFile;
use sahara::scene::{Model, Scene, SceneError, View, load};
use sahara::triangle::MollerTrumbore;

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
    let (min, max) = ([-7.0467, 0.0, -3.15129995], [7.0467, 9.9399004, 3.15129995]);
    check("dragon.obj", Expected { triangles: 100_000, vertices: 50_000, degenerate: 0, materials: 1, min, max });
}

#[test]
fn lucy() {
    let max = [464.913574, 798.450562, 266.838562];
    let min = max.map(|c: f32| -c);
    check("lucy.ply", Expected { triangles: 100_000, vertices: 50_002, degenerate: 0, materials: 1, min, max });
}

#[test]
fn sponza() {
    let (min, max) = ([-1920.94592, -126.442497, -1182.80713], [1799.90808, 1429.43323, 1105.42603]);
    check("sponza.obj", Expected { triangles: 262_267, vertices: 145_185, degenerate: 1, materials: 25, min, max });
}

#[test]
fn sponza_dabrovic() {
    let (min, max) = ([-17.4027596, -0.906688988, -7.79851198], [17.4172401, 15.6533117, 7.80148888]);
    check(
        "sponza_dabrovic.obj",
        Expected { triangles: 66_454, vertices: 39_999, degenerate: 1, materials: 1, min, max },
    );
}

#[test]
fn teapot() {
    let (min, max) = ([-3.0, 0.0, -2.0], [3.43400002, 3.1500001, 2.0]);
    check("teapot.obj", Expected { triangles: 6320, vertices: 3644, degenerate: 0, materials: 1, min, max });
}

#[test]
fn teapot_4032() {
    let (min, max) = ([-23.096241, -9.32857513, -15.1232462], [26.321558, 15.076026, 15.0983648]);
    check("teapot_4032.obj", Expected { triangles: 4032, vertices: 2082, degenerate: 0, materials: 1, min, max });
}

#[test]
fn bunny() {
    let (min, max) = ([-0.0946898982, 0.0329874001, -0.0618735999], [0.0610091016, 0.187321007, 0.0587996989]);
    check("bunny.ply", Expected { triangles: 69_451, vertices: 35_947, degenerate: 0, materials: 1, min, max });
}

#[test]
fn kitchen() {
    let (min, max) = ([-1.930758, -0.0342309996, -2.479913], [3.61457396, 2.52319098, 2.59347892]);
    check("kitchen.obj", Expected { triangles: 56_939, vertices: 74_303, degenerate: 25, materials: 33, min, max });
}

#[test]
fn two_cylinder_engine() {
    let (min, max) = ([-371.692261, -180.971558, -140.0], [371.692169, 92.0415649, 128.0]);
    check(
        "two_cylinder_engine.glb",
        Expected { triangles: 121_496, vertices: 84_657, degenerate: 11_160, materials: 34, min, max },
    );
}

#[test]
fn san_miguel_part() {
    let (min, max) = ([-37.9735985, -0.381559014, -36.9506989], [46.7743988, 53.5195999, 36.9362984]);
    check(
        "san_miguel_part.glb",
        Expected { triangles: 1_093_419, vertices: 691_308, degenerate: 239, materials: 117, min, max },
    );
}

/// How much of a picture of 128 x 128 pixels they fill, in percent.
const VIEWS: [(&str, std::ops::RangeInclusive<usize>); 6] = [
    ("bunny", 20..=30),
    ("dragon-scan", 22..=32),
    ("engine", 12..=22),
    ("kitchen", 95..=99),
    ("lucy-scan", 11..=21),
    ("sponza-nave", 97..=100),
];

#[test]
fn the_views_look_at_their_meshes() {
    let folder = std::env::var_os("SAHARA_DATA").map(PathBuf::from);
    for (name, filled) in VIEWS {
        let path = PathBuf::from(format!("scenes/views/{name}.toml"));
        let nowhere = Scene::read(&path, Some(Path::new("/nowhere"))).unwrap_err().to_string();
        assert!(nowhere.contains("is not in /nowhere: `sahara fetch scenes/views/"), "{nowhere}");
        let Some(folder) = &folder else {
            println!("{name}: only read, the environment variable SAHARA_DATA names no folder with meshes");
            continue;
        };
        let scene = match Scene::read(&path, Some(folder)) {
            Err(SceneError::Value { key, problem, .. }) if key.ends_with("real.file") => {
                println!("{name}: skipped, {problem}");
                continue;
            }
            scene => scene.unwrap(),
        };
        // What starts off the surface by its area would start behind the next wall.
        assert!(scene.name == name && !scene.shadow_terminator_fix);
        let tree = Bvh8::<MollerTrumbore>::build(&scene.mesh, &Bvh8Config::default()).unwrap();
        let view = scene.camera.view([128, 128]);
        let pixels = (0..128 * 128).map(|i| view.ray(i % 128, i / 128, View::CENTRE));
        let hits = pixels.filter(|ray| tree.any_hit(ray, &mut ())).count();
        assert!(filled.contains(&(hits * 100 / (128 * 128))), "{name}: {hits} pixels");
    }
}

/// The Dragon, Lucy and Sponza of the built-in scenes are the same files.
#[test]
fn the_views_name_the_meshes_of_the_built_in_scenes() {
    let real = |text: &str, file: &str| {
        let scene = SceneFile::parse(text, file).unwrap();
        scene.objects.into_iter().find_map(|object| object.real).unwrap()
    };
    for (name, view) in [("dragon", "dragon-scan"), ("lucy", "lucy-scan"), ("sponza", "sponza-nave")] {
        let [own, other] = [format!("scenes/{name}/scene.toml"), format!("scenes/views/{view}.toml")]
            .map(|file| real(&std::fs::read_to_string(&file).unwrap(), &file));
        assert_eq!((&own.file, &own.url, &own.licence), (&other.file, &other.url, &other.licence));
        assert_eq!((own.sha256, own.bytes, own.origin), (other.sha256, other.bytes, other.origin));
    }
}
