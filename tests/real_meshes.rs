//! Tests the loaders and views on real meshes, which are not in the repository.
//!
//! The environment variable `SAHARA_DATA` names the folder of the meshes. Without this variable, the tests skip all
//! meshes.

use std::path::{Path, PathBuf};

use sahara::accel::Accel;
use sahara::bvh8::{Bvh8, Bvh8Config};
use sahara::geometry::{Aabb, Mesh};
use sahara::scene::{Model, Scene, SceneError, View, load};
use sahara::triangle::MollerTrumbore;

fn folder(name: &str, treated: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("SAHARA_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("{name}: {treated}, the environment variable SAHARA_DATA names no folder with meshes");
    }
    folder
}

/// Returns `None` if `SAHARA_DATA` is not set or the file is missing.
fn real(name: &str) -> Option<(Model, Mesh)> {
    let path = folder(name, "skipped")?.join(name);
    if !path.is_file() {
        println!("{name}: skipped, there is no {}", path.display());
        return None;
    }
    let mut model = load(&path).unwrap();
    println!("{name}: {:?}", model.notes);
    let (positions, triangles) = (std::mem::take(&mut model.positions), std::mem::take(&mut model.triangles));
    Some((model, Mesh::new(positions, triangles).unwrap()))
}

/// Columns: file, triangles, vertices, degenerate triangles, materials, minimum x y z, maximum x y z.
const MESHES: &str = "
    dragon.obj 100000 50000 0 1 -7.0467 0 -3.15129995 7.0467 9.9399004 3.15129995
    lucy.ply 100000 50002 0 1 -464.913574 -798.450562 -266.838562 464.913574 798.450562 266.838562
    sponza.obj 262267 145185 1 25 -1920.94592 -126.442497 -1182.80713 1799.90808 1429.43323 1105.42603
    sponza_dabrovic.obj 66454 39999 1 1 -17.4027596 -0.906688988 -7.79851198 17.4172401 15.6533117 7.80148888
    teapot.obj 6320 3644 0 1 -3 0 -2 3.43400002 3.1500001 2
    teapot_4032.obj 4032 2082 0 1 -23.096241 -9.32857513 -15.1232462 26.321558 15.076026 15.0983648
    bunny.ply 69451 35947 0 1 -0.0946898982 0.0329874001 -0.0618735999 0.0610091016 0.187321007 0.0587996989
    kitchen.obj 56939 74303 25 33 -1.930758 -0.0342309996 -2.479913 3.61457396 2.52319098 2.59347892
    two_cylinder_engine.glb 121496 84657 11160 34 -371.692261 -180.971558 -140 371.692169 92.0415649 128
    san_miguel_part.glb 1093419 691308 239 117 -37.9735985 -0.381559014 -36.9506989 46.7743988 53.5195999 36.9362984
";

#[test]
fn the_loaders_find_what_is_in_them() {
    for line in MESHES.trim().lines() {
        let (name, numbers) = line.trim().split_once(' ').unwrap();
        let Some((model, mesh)) = real(name) else { continue };
        let Aabb { min, max } = mesh.bounds();
        let counts = [mesh.len(), mesh.positions().len(), mesh.degenerate().len(), model.materials.len()];
        let found = counts.map(|n| n as f32).into_iter().chain(min.to_array()).chain(max.to_array());
        let expected: Vec<f32> = numbers.split(' ').map(|number| number.parse().unwrap()).collect();
        assert_eq!(found.collect::<Vec<_>>(), expected, "{name}");
    }
}

/// Views, each with the allowed percentage of pixels that show the mesh.
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
    // The view `on-floor` needs no mesh file.
    let scene = Scene::read(Path::new("scenes/views/on-floor.toml"), Some(Path::new("/nowhere"))).unwrap();
    assert!(scene.name == "on-floor" && scene.mesh.bounds().min.y == 0.0 && !scene.shadow_terminator_fix);
    for (name, filled) in VIEWS {
        let path = PathBuf::from(format!("scenes/views/{name}.toml"));
        let nowhere = Scene::read(&path, Some(Path::new("/nowhere"))).unwrap_err().to_string();
        assert!(nowhere.contains("is not in /nowhere: `sahara fetch scenes/views/"), "{nowhere}");
        let Some(folder) = folder(name, "only read") else { continue };
        let scene = match Scene::read(&path, Some(&folder)) {
            Err(SceneError::Value { key, problem, .. }) if key.ends_with("real.file") => {
                println!("{name}: skipped, {problem}");
                continue;
            }
            scene => scene.unwrap(),
        };
        // A shadow terminator fix could move the origins of shadow rays behind another wall.
        assert!(scene.name == name && !scene.shadow_terminator_fix);
        let tree = Bvh8::<MollerTrumbore>::build(&scene.mesh, &Bvh8Config::default()).unwrap();
        let view = scene.camera.view([128, 128]);
        let pixels = (0..128 * 128).map(|i| view.ray(i % 128, i / 128, View::CENTRE));
        let hits = pixels.filter(|ray| tree.any_hit(ray, &mut ())).count();
        assert!(filled.contains(&(hits * 100 / (128 * 128))), "{name}: {hits} pixels");
    }
}
