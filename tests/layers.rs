//! Imports between the modules of the crate go downward only, without circles.

use std::fs;
use std::path::Path;

/// The modules of the crate by layer, as ARCHITECTURE.md draws them. Within a layer a module may import those before it,
/// unless they are structures.
const LAYERS: [&[&str]; 9] = [
    &["escaped", "geometry", "names", "output", "panics", "simd"],
    &["exact", "triangle", "accel"],
    &["traversal", "build"],
    &["brute_force", "bvh8", "kdtree", "external"],
    &["offered", "scene", "oracle"],
    &["measure", "fetch", "runner", "validate", "render", "golden"],
    &["registry", "report", "request", "study"],
    &["page"],
    &["cli", "build_info"],
];

/// No structure imports another.
const STRUCTURES: usize = 3;

/// The layer of a module, and its place in the layer.
fn place(module: &str) -> Option<[usize; 2]> {
    let mut layers = LAYERS.iter().enumerate();
    layers.find_map(|(layer, names)| Some([layer, names.iter().position(|name| *name == module)?]))
}

/// The text without comments and without items that are compiled for tests only.
fn shipped(text: &str) -> String {
    let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or("")).collect();
    let code = code.join("\n");
    let mut parts = code.split("#[cfg(test)]");
    let mut left = parts.next().unwrap_or("").to_owned();
    for part in parts {
        let mut depth = 0;
        let ends = |c: char| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            depth == 0 && (c == '}' || c == ';')
        };
        left += part.find(ends).map_or("", |end| &part[end + 1..]);
    }
    left
}

/// What is wrong with the imports of a file of `module`, a line for each fault.
fn faults(module: &str, text: &str) -> Vec<String> {
    let is_of_name = |c: char| c.is_alphanumeric() || c == '_';
    let Some(own) = place(module) else {
        return vec![format!("the module {module:?} has no layer: add it to tests/layers.rs")];
    };
    let is_right = |other: [usize; 2]| other < own && [other[0], own[0]] != [STRUCTURES; 2];
    let text = shipped(text);
    let mut faults = vec![];
    // `my_crate::` is another crate.
    for (at, root) in text.match_indices("crate::").filter(|(at, _)| !text[..*at].ends_with(is_of_name)) {
        let path = &text[at + root.len()..];
        let name = path.split(|c| !is_of_name(c)).next().unwrap_or("");
        if path.starts_with('{') {
            faults.push(format!("{module} imports a list from the root of the crate: write one `use` a module"));
        } else if name != module && place(name).is_some_and(|other| !is_right(other)) {
            faults.push(format!("{module} imports {name}"));
        }
    }
    faults
}

/// The Rust files below a folder, without those of tests, each with the module of the crate that it belongs to.
fn files(folder: &Path, module: &str, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let own = if module.is_empty() { &stem } else { module };
        if path.is_dir() && stem != "tests" {
            // The core is a crate of its own; the suite re-exports its modules under their names.
            files(&path, if own == "core" { "" } else { own }, found);
        } else if path.extension().is_some_and(|end| end == "rs") && !["tests", "lib", "main"].contains(&&*stem) {
            found.push((own.to_owned(), fs::read_to_string(&path).unwrap()));
        }
    }
}

#[test]
fn imports_go_downward_without_circles() {
    let mut found = vec![];
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), "", &mut found);
    assert!(found.len() > 300, "the files of both crates are found");
    let faults: Vec<String> = found.iter().flat_map(|(module, text)| faults(module, text)).collect();
    assert!(faults.is_empty(), "imports must go downward:\n{}", faults.join("\n"));
}

#[test]
fn planted_faults_are_found() {
    for (module, text, expected) in [
        ("accel", "use crate::geometry::Ray;\nuse super::Hit;", None),
        ("accel", "use crate::kdtree::KdTree as Tree;", Some("accel imports kdtree")),
        ("accel", "fn f() { let x = crate::registry::builtin(); }", Some("accel imports registry")),
        ("accel", "use crate::{geometry::Ray, exact};", Some("accel imports a list")),
        ("accel", "/// See [`crate::registry`].\n// use crate::cli;\nuse my_crate::cli;", None),
        ("accel", "#[cfg(test)]\nmod tests {\n    use crate::registry::Registry;\n}\n", None),
        ("attic", "", Some("the module \"attic\" has no layer")),
        // Structures do not know each other, and modules of one layer import one way.
        ("bvh8", "use crate::kdtree::KdTree;", Some("bvh8 imports kdtree")),
        ("scene", "use crate::oracle::Tree;", Some("scene imports oracle")),
        ("oracle", "use crate::scene::Scene;", None),
    ] {
        let found = faults(module, text);
        assert_eq!(found.len(), expected.iter().len(), "{text}: {found:?}");
        assert!(found.iter().zip(expected).all(|(found, start)| found.starts_with(start)), "{text}: {found:?}");
    }
}
