//! Checks the imports between modules against a list of layers.
//!
//! Also checks that only the folder `scene::load` imports the crates `gltf` and `tobj`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The modules of the suite, lowest layer first. ARCHITECTURE.md draws the layers. A module may import only modules
/// that are listed before it.
///
/// The modules of the layer `STRUCTURES` must not import each other.
const LAYERS: [&[&str]; 9] = [
    &["escaped", "geometry", "names", "output", "panics", "plural", "simd"],
    &["exact", "triangle", "accel"],
    &["traversal", "build"],
    &["brute_force", "bvh8", "kdtree", "external"],
    &["offered", "scene", "oracle"],
    &["render", "golden", "builtin", "measure", "fetch", "runner", "validate"],
    &["registry", "report", "request", "study"],
    &["page"],
    &["cli", "build_info"],
];

/// `LAYERS[STRUCTURES]` lists the modules of the acceleration structures.
const STRUCTURES: usize = 3;

/// External crates, each with the only folder that may import the crate.
const ENCLOSED: [(&str, &str); 2] = [("gltf", "scene::load"), ("tobj", "scene::load")];

/// A map from module paths, such as `bvh8::node`, to source code without comments and `#[cfg(test)]` items.
struct Sources(BTreeMap<String, String>);

impl Sources {
    fn of_the_crates() -> Self {
        let mut found = vec![];
        collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), "", &mut found);
        Self::new(found)
    }

    fn new(files: Vec<(String, String)>) -> Self {
        let (mut sources, mut tests) = (BTreeMap::new(), vec![]);
        for (module, text) in files {
            let lines: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap_or("")).collect();
            let code = lines.join("\n");
            let (left, items) = without_test_items(&code);
            // `#[cfg(test)] mod tests;` declares a file that is compiled only for tests.
            let names = items.iter().filter_map(|item| item.strip_suffix(';')?.rsplit_once("mod "));
            tests.extend(names.map(|(_, name)| join(&module, name)));
            sources.insert(module, left);
        }
        sources.retain(|module, _| !tests.iter().any(|test| is_in(module, test)));
        Self(sources)
    }

    fn faults(&self) -> BTreeSet<String> {
        let mut faults = BTreeSet::new();
        for (file, text) in &self.0 {
            let module = file.split("::").next().unwrap();
            // Crate roots have no layer.
            let is_root = ["", "lib", "main"].contains(&module);
            if !is_root && place(module).is_none() {
                faults.insert(format!("the module {module:?} has no layer: add it to tests/layers.rs"));
            }
            for path in paths(text) {
                let name = path.trim_start_matches(':').split("::").next().unwrap();
                if ENCLOSED.iter().any(|(enclosed, folder)| *enclosed == name && !is_in(file, folder)) {
                    faults.insert(format!("{file} imports {name}"));
                }
                let Some(other) = imported(file, path).filter(|other| *other != module && !is_root) else { continue };
                let is_module = place(other).is_some() || self.0.contains_key(other);
                if other.is_empty() {
                    faults.insert(format!("{file} imports a list of modules: import each by itself"));
                } else if is_module && !may_import(module, other) {
                    faults.insert(format!("{file} imports {other}"));
                }
            }
        }
        faults
    }
}

fn join(module: &str, name: &str) -> String {
    [module, name].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("::")
}

fn is_in(module: &str, folder: &str) -> bool {
    module.strip_prefix(folder).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

fn collect(folder: &Path, module: &str, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            // `core` and `images` are separate crates, so the modules in these folders are top-level modules.
            let is_crate = module.is_empty() && ["core", "images"].contains(&stem.as_str());
            collect(&path, &if is_crate { String::new() } else { join(module, &stem) }, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = if stem == "mod" { module.to_owned() } else { join(module, &stem) };
            found.push((name, fs::read_to_string(&path).unwrap()));
        }
    }
}

/// Removes the `#[cfg(test)]` items from a text. Returns the remaining text and the removed items.
fn without_test_items(text: &str) -> (String, Vec<&str>) {
    let (mut left, mut items, mut rest) = (String::new(), vec![], text);
    while let Some((before, after)) = rest.split_once("#[cfg(test)]") {
        left.push_str(before);
        let mut depth = 0;
        let ends = |c: char| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            depth == 0 && (c == '}' || c == ';')
        };
        let end = after.find(ends).map_or(after.len(), |at| at + 1);
        items.push(after[..end].trim());
        rest = &after[end..];
    }
    (left + rest, items)
}

/// All paths with `::` in a text, and all names directly after `use`.
fn paths(text: &str) -> impl Iterator<Item = &str> {
    let mut last = "";
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':').filter(|word| !word.is_empty());
    words.filter(move |word| word.contains("::") || std::mem::replace(&mut last, word) == "use")
}

/// Returns the top-level module to which `path` refers. Returns an empty string for a list, such as
/// `crate::{accel, cli}`.
fn imported<'a>(file: &str, path: &'a str) -> Option<&'a str> {
    let (first, rest) = path.split_once("::")?;
    if ["crate", "sahara_core", "sahara_images"].contains(&first) {
        return rest.split("::").next();
    }
    let above = path.split("::").take_while(|name| *name == "super").count();
    if above == file.split("::").count() { path.split("::").nth(above) } else { None }
}

/// The index of the layer of a module, and the index of the module within the layer.
fn place(module: &str) -> Option<[usize; 2]> {
    let mut places = LAYERS.iter().enumerate();
    places.find_map(|(layer, names)| Some([layer, names.iter().position(|name| *name == module)?]))
}

fn may_import(module: &str, other: &str) -> bool {
    let is_below = |(own, other): ([usize; 2], [usize; 2])| other < own && [other[0], own[0]] != [STRUCTURES; 2];
    place(module).zip(place(other)).is_some_and(is_below)
}

#[test]
fn imports_go_downward() {
    let sources = Sources::of_the_crates();
    assert!(sources.0.len() > 300, "the files of all crates are found");
    let faults = sources.faults();
    assert!(faults.is_empty(), "imports must go downward, and these crates into their folders: {faults:#?}");
}

#[test]
fn planted_faults_are_found() {
    let test_file = [("bvh8", "#[cfg(test)]\nmod tests;\n"), ("bvh8::tests", "use crate::registry::Registry;")];
    for (files, expected) in [
        (&[("accel", "use crate::geometry::Ray;\nuse super::geometry::Mesh;")][..], &[][..]),
        (&[("accel", "use crate::kdtree::KdTree as Tree;")], &["accel imports kdtree"]),
        (&[("accel", "pub use super::kdtree::KdTree;")], &["accel imports kdtree"]),
        (&[("accel::counts", "use super::super::kdtree::KdTree;")], &["accel::counts imports kdtree"]),
        (&[("accel::counts", "use super::kdtree::KdTree;")], &[]),
        (&[("accel", "fn f() { let x = crate::registry::builtin(); }")], &["accel imports registry"]),
        (&[("accel", "use crate::{geometry::Ray, cli};")], &["accel imports a list of modules: import each by itself"]),
        (&[("accel", "/// See [`crate::registry`].\n// use crate::cli;\nuse my_crate::cli;")], &[]),
        (&[("accel", "#[cfg(test)]\nmod tests {\n    use crate::registry::Registry;\n}\n")], &[]),
        (&test_file, &[]),
        (&[("attic", "")], &["the module \"attic\" has no layer: add it to tests/layers.rs"]),
        (&[("bvh8", "use crate::kdtree::KdTree;")], &["bvh8 imports kdtree"]),
        (&[("scene", "use crate::oracle::Tree;")], &["scene imports oracle"]),
        (&[("scene::loaded", "use gltf::{Document, json};")], &["scene::loaded imports gltf"]),
        (&[("scene", "use ::gltf as reader;\nuse gltf;")], &["scene imports gltf"]),
        (&[("cli", "fn f() { tobj::load_obj(path) }")], &["cli imports tobj"]),
        (&[("cli", "use super::gltf;\nfn f(gltf: u32) { g(\"gltf\", gltf) }")], &[]),
        (&[("scene::load", "use gltf::Document;"), ("scene::load::obj", "fn f() { tobj::load_obj(path) }")], &[]),
    ] {
        let own = files.iter().map(|(module, text)| (module.to_string(), text.to_string()));
        let faults = Sources::new(own.collect()).faults();
        assert!(faults.iter().eq(expected), "{files:?}: {faults:?}");
    }
}
