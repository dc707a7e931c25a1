//! Tests the loaders with files that the tests write.

mod gltf;
mod mutated;
mod obj;
mod ply;

use std::fs;
use std::path::Path;

use glam::Vec3;

use super::{LoadError, load};
use crate::scene::Model;

fn load_files(files: &[(&str, &[u8])]) -> Result<Model, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    load(&folder.path().join(files[0].0))
}

fn assert_refused(name: &str, bytes: &[u8], words: &[&str]) {
    assert_error(load_files(&[(name, bytes)]), name, words);
}

/// Skips the folder in the message, because the folder is random.
fn assert_error(result: Result<Model, LoadError>, name: &str, words: &[&str]) {
    let message = result.expect_err(&format!("{words:?}")).to_string();
    assert!(!message.contains('\n'), "{message:?}");
    let message = &message[message.find(name).expect("the message names the file")..];
    words.iter().for_each(|word| assert!(message.contains(word), "{message:?} does not contain {word:?}"));
}

fn corners(model: &Model) -> Vec<[Vec3; 3]> {
    model.triangles.iter().map(|t| t.map(|i| model.positions[i as usize])).collect()
}

/// The normals are not normalised.
fn face_normals(model: &Model) -> Vec<Vec3> {
    corners(model).iter().map(|[a, b, c]| (b - a).cross(c - a)).collect()
}

#[test]
fn the_extension_determines_the_format_in_any_case() {
    let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(load_files(&[("A.OBJ", file)]).unwrap().triangles, [[0, 1, 2]]);
    for name in ["mesh.stl", "mesh", "obj"] {
        let error = load_files(&[(name, file)]).unwrap_err();
        assert!(matches!(error, LoadError::UnknownFormat { .. }), "{error}");
    }
}

#[test]
fn paths_that_are_no_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("folder.obj")).unwrap();
    let error = |name: &str| load(&folder.path().join(name)).unwrap_err();
    assert!(matches!(error("missing.obj"), LoadError::Unreadable { file, .. } if file.ends_with("missing.obj")));
    assert!(matches!(error("folder.obj"), LoadError::Folder { file } if file.ends_with("folder.obj")));
    assert!(load(Path::new("")).is_err());
}
