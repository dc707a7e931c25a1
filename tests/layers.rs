//! Checks that imports go downward only, between modules of the crate and between their files, without circles, under
//! any path of an import. Some other crates may be imported in only one folder.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The modules of the crate by layer, as ARCHITECTURE.md draws them. Within a layer a module may import those before it,
/// unless they are structures.
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

/// No structure imports another.
const STRUCTURES: usize = 3;

/// Other crates, and the only folder that may import them; other modules use that folder.
const ENCLOSED: [(&str, &str); 2] = [("gltf", "scene::load"), ("tobj", "scene::load")];

/// The imports of each module.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// Source files by module path, `bvh8::node`; a folder's `mod.rs` is the folder. Without comments, and without items
/// that are compiled only for tests.
struct Sources(BTreeMap<String, String>);

impl Sources {
    fn of_the_crate() -> Self {
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
            // `mod tests;`: a whole file for tests.
            let names = items.iter().filter_map(|item| item.strip_suffix(';')?.rsplit_once("mod "));
            tests.extend(names.map(|(_, name)| join(&module, name)));
            sources.insert(module, left);
        }
        sources.retain(|module, _| !tests.iter().any(|test| is_in(module, test)));
        Self(sources)
    }

    /// The file in which the item of a path is defined; re-exports are followed, `rounds` of them so far.
    fn home(&self, path: &str, rounds: usize) -> Option<String> {
        let mut module = String::new();
        let mut rest = path;
        while !rest.is_empty() {
            let (segment, after) = rest.split_once("::").unwrap_or((rest, ""));
            let below = join(&module, segment);
            if !self.0.contains_key(&below) {
                // A name that the module only re-exports is defined elsewhere.
                let exports =
                    imports(self.0.get(&module)?).into_iter().filter(|used| used.public == Some(true) && rounds < 8);
                let mut targets = exports.filter_map(|used| self.absolute(&module, &used.path));
                let target = targets.find(|target| target.rsplit("::").next() == Some(segment));
                return target.map_or(Some(module), |target| self.home(&join(&target, after), rounds + 1));
            }
            (module, rest) = (below, after);
        }
        (!module.is_empty()).then_some(module)
    }

    /// The path from the root of the crate for a path written in `module`; `None` for other crates.
    fn absolute(&self, module: &str, path: &str) -> Option<String> {
        let base = match top(path) {
            "crate" | "sahara_core" | "sahara_images" => "",
            "self" | "super" => module,
            child if self.0.contains_key(&join(module, child)) => module,
            _ => return None,
        };
        let mut own: Vec<&str> = base.split("::").filter(|segment| !segment.is_empty()).collect();
        for segment in path.split("::") {
            match segment {
                "crate" | "sahara_core" | "sahara_images" | "self" => {}
                "super" => _ = own.pop(),
                segment => own.push(segment),
            }
        }
        Some(own.join("::"))
    }

    /// All faults, one line each.
    fn faults(&self) -> Vec<String> {
        let (mut faults, mut graph) = (vec![], Graph::new());
        for (module, text) in &self.0 {
            let mut homes = BTreeSet::new();
            for Import { public, path } in imports(text) {
                let first = top(path.trim_start_matches(':'));
                if ENCLOSED.iter().any(|(name, folder)| *name == first && !is_in(module, folder)) {
                    faults.push(format!("{module} imports {first}"));
                }
                // A re-export of a folder's files is not its own import, and calls of its code into them have a `mod`.
                let is_own = public.map_or(["crate", "super"].contains(&first), |public| !public);
                let home = self.absolute(module, &path).filter(|_| is_own).and_then(|path| self.home(&path, 0));
                homes.extend(home.filter(|home| home != module));
            }
            // The roots of the crates have no layer.
            if !["", "lib", "main"].contains(&module.as_str()) {
                graph.insert(module.clone(), homes);
            }
        }
        faults.extend(upward(&graph));
        faults.extend(circles(&graph).into_iter().map(|file| format!("{file} is in a circle")));
        faults.dedup();
        faults
    }
}

fn join(module: &str, name: &str) -> String {
    [module, name].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("::")
}

/// The first name of a path: for a file, its module of the crate.
fn top(path: &str) -> &str {
    path.split("::").next().unwrap_or(path)
}

/// Whether a file is the file of a folder or lies in it.
fn is_in(module: &str, folder: &str) -> bool {
    module.strip_prefix(folder).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

fn collect(folder: &Path, module: &str, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            // These are separate crates; the suite re-exports their modules under their names.
            let is_crate = module.is_empty() && ["core", "images"].contains(&stem.as_str());
            collect(&path, &if is_crate { String::new() } else { join(module, &stem) }, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = if stem == "mod" { module.to_owned() } else { join(module, &stem) };
            found.push((name, fs::read_to_string(&path).unwrap()));
        }
    }
}

/// The text without items that are compiled only for tests, and these items.
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

/// One path of a `use`, which may be public, or a path in code.
struct Import {
    public: Option<bool>,
    path: String,
}

/// All paths of all `use` items, their lists written out, and the paths in code.
fn imports(text: &str) -> Vec<Import> {
    let is_of_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let mut found = vec![];
    // Whether the current `use` is public, the prefixes of its open lists, and the previous word.
    let (mut public, mut heads, mut last, mut at) = (None, vec![String::new()], "", 0);
    for piece in text.split_inclusive(|c| !is_of_path(c)) {
        let word = piece.trim_end_matches(|c| !is_of_path(c));
        let line = text[..at].rsplit('\n').next().unwrap_or("").trim();
        at += piece.len();
        if public.is_none() {
            if word == "use" && (line.is_empty() || line.starts_with("pub")) {
                public = Some(line.starts_with("pub"));
            } else if word.contains("::") {
                found.push(Import { public, path: word.trim_end_matches(':').into() });
            }
            continue;
        }
        let path = format!("{}{word}", heads.last().expect("braces are paired"));
        match &piece[word.len()..] {
            "{" => heads.push(path),
            _ if word.is_empty() || word == "as" || last == "as" => {}
            _ => found.push(Import { public, path: path.trim_end_matches(':').into() }),
        }
        match &piece[word.len()..] {
            "}" => _ = heads.pop(),
            ";" => public = None,
            _ => {}
        }
        if !word.is_empty() {
            last = word;
        }
    }
    found
}

/// Faults between modules of the crate: because the modules have one order, none may import each other in circles.
fn upward(graph: &Graph) -> Vec<String> {
    let place = |module: &str| {
        let mut places = LAYERS.iter().enumerate();
        places.find_map(|(layer, names)| Some([layer, names.iter().position(|name| *name == module)?]))
    };
    let mut faults = BTreeSet::new();
    for (file, homes) in graph {
        let Some(own) = place(top(file)) else {
            faults.insert(format!("the module {:?} has no layer: add it to tests/layers.rs", top(file)));
            continue;
        };
        for home in homes.iter().filter(|home| top(home) != top(file)) {
            let is_right = |other: [usize; 2]| other < own && [other[0], own[0]] != [STRUCTURES; 2];
            if !place(top(home)).is_some_and(is_right) {
                faults.insert(format!("{file} imports {home}"));
            }
        }
    }
    faults.into_iter().collect()
}

/// The files that import each other in circles, or lie between two circles: those that remain after repeatedly removing
/// files that import none of the remaining ones, and files that none of them imports.
fn circles(graph: &Graph) -> BTreeSet<&str> {
    let mut left: BTreeSet<&str> = graph.keys().map(String::as_str).collect();
    loop {
        let imported: BTreeSet<&str> = left.iter().flat_map(|name| &graph[*name]).map(String::as_str).collect();
        let is_bound = |name: &&&str| imported.contains(**name) && graph[**name].iter().any(|to| left.contains(&**to));
        let bound: BTreeSet<&str> = left.iter().filter(is_bound).copied().collect();
        if bound.len() == left.len() {
            return left;
        }
        left = bound;
    }
}

#[test]
fn imports_go_downward_without_circles() {
    let sources = Sources::of_the_crate();
    assert!(sources.0.len() > 300, "the files of all crates are found");
    let faults = sources.faults();
    assert!(faults.is_empty(), "imports must go downward, and these crates into their folders:\n{}", faults.join("\n"));
}

/// Modules and their texts.
type Files<'a> = &'a [(&'a str, &'a str)];

#[test]
fn planted_faults_are_found() {
    const NODE: (&str, &str) = ("bvh8", "mod node;\nmod stack;\npub use node::Node;\npub(crate) use stack::Stack;\n");
    const OF_TWO: &[&str] = &["bvh8::node is in a circle", "bvh8::stack is in a circle"];
    let cases: [(Files, &[&str]); 26] = [
        (&[("accel", "use crate::geometry::Ray;\nuse super::geometry::Mesh;")], &[]),
        (&[("accel", "use crate::kdtree::KdTree as Tree;")], &["accel imports kdtree"]),
        (&[("accel", "use super::kdtree::KdTree;")], &["accel imports kdtree"]),
        (&[("accel", "fn f() { let x = crate::registry::builtin(); }")], &["accel imports registry"]),
        (&[("accel", "use crate::{geometry::{Mesh, Ray}, scene::Model, exact};")], &["accel imports scene"]),
        (&[("accel", "use crate::{\n    kdtree,\n    cli::f,\n};")], &["accel imports cli", "accel imports kdtree"]),
        (&[("accel", "/// See [`crate::registry`].\n// use crate::cli;\nuse my_crate::cli;")], &[]),
        (&[("accel", "#[cfg(test)]\nmod tests {\n    use crate::registry::Registry;\n}\n")], &[]),
        (&[("attic", "")], &["the module \"attic\" has no layer: add it to tests/layers.rs"]),
        // Structures do not import each other, and modules of one layer import one way.
        (&[("bvh8", "use crate::kdtree::KdTree;")], &["bvh8 imports kdtree"]),
        (&[("scene", "use crate::oracle::Tree;"), ("oracle", "")], &["scene imports oracle"]),
        (&[("build", "use crate::bvh8::node::Node;"), ("bvh8::node", "")], &["build imports bvh8::node"]),
        // Crates that only one folder may import.
        (&[("scene::loaded", "use gltf::{Document, json};")], &["scene::loaded imports gltf"]),
        (&[("scene", "use ::gltf as reader;")], &["scene imports gltf"]),
        (&[("cli", "use std::{fs, io};\nfn f() { ::gltf::Gltf::open(path) }")], &["cli imports gltf"]),
        (&[("cli", "fn f() { tobj::load_obj(path) }")], &["cli imports tobj"]),
        (&[("cli", "use super::gltf;\nfn f(gltf: u32) { g(\"gltf\", gltf) }")], &[]),
        (&[("cli", "#[cfg(test)]\nuse tobj::Model;")], &[]),
        (&[("scene::load", "use gltf::Document;"), ("scene::load::obj", "fn f() { tobj::load_obj(path) }")], &[]),
        // Files of one folder; its re-exports are defined in their files, and its own items count.
        (&[NODE, ("bvh8::node", "use super::stack::DEPTH;"), ("bvh8::stack", "use super::node::Node;")], OF_TWO),
        (&[NODE, ("bvh8::node", "use super::Stack;"), ("bvh8::stack", "use crate::bvh8::Node;")], OF_TWO),
        (&[NODE, ("bvh8::node", "fn f() { super::stack::g() }"), ("bvh8::stack", "use super::{node::Node};")], OF_TWO),
        (&[NODE, ("bvh8::node", ""), ("bvh8::stack", "use crate::bvh8::Node;")], &[]),
        (
            &[("bvh8", "mod node;\nuse node::Node;\nstruct Tree;"), ("bvh8::node", "use super::Tree;")],
            &["bvh8 is in a circle", "bvh8::node is in a circle"],
        ),
        (&[("bvh8", "mod node;\nfn f() { node::g() }"), ("bvh8::node", "")], &[]),
        (
            &[
                ("bvh8", "mod node;\n#[cfg(test)]\nmod tests;\n"),
                ("bvh8::node", "#[cfg(test)]\nuse super::tests::mesh;"),
                ("bvh8::tests", "use super::node::Node;"),
            ],
            &[],
        ),
    ];
    for (files, expected) in cases {
        let others = ["kdtree", "bvh8", "registry", "scene", "geometry", "exact", "cli"].map(|name| (name, ""));
        let all = others.iter().chain(files).map(|(module, text)| (module.to_string(), text.to_string()));
        assert_eq!(Sources::new(all.collect()).faults(), expected, "{files:?}");
    }
}
