//! Imports go downward only, between rooms and between the files of a room: no circles, whatever path an import takes.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The rooms by layer, as ARCHITECTURE.md draws them. Those of one layer may import each other in one direction, unless they are structures.
const LAYERS: [(&str, u32); 30] = [
    ("escaped", 0),
    ("geometry", 0),
    ("names", 0),
    ("output", 0),
    ("panics", 0),
    ("simd", 0),
    ("exact", 1),
    ("triangle", 1),
    ("accel", 1),
    ("traversal", 2),
    ("build", 2),
    ("brute_force", STRUCTURES),
    ("bvh8", STRUCTURES),
    ("kdtree", STRUCTURES),
    ("external", STRUCTURES),
    ("offered", 4),
    ("scene", 4),
    ("oracle", 4),
    ("render", 5),
    ("measure", 5),
    ("golden", 5),
    ("validate", 5),
    ("fetch", 5),
    ("runner", 5),
    ("registry", 6),
    ("study", 6),
    ("report", 6),
    ("page", 7),
    ("cli", 8),
    ("build_info", 8),
];

/// No structure imports another.
const STRUCTURES: u32 = 3;

/// Source files by module path, `bvh8::node`; a folder's `mod.rs` is the folder. Without comments, and without what is compiled for tests alone.
struct Sources(BTreeMap<String, String>);

impl Sources {
    fn of_the_crate() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut found = vec![];
        collect(&root, "", &mut found);
        Self::new(found)
    }

    fn new(files: impl IntoIterator<Item = (String, String)>) -> Self {
        let mut files: BTreeMap<_, _> = files.into_iter().map(|(module, text)| (module, code(&text))).collect();
        // Whole files for tests.
        let tests: Vec<String> = files.iter().flat_map(|(module, text)| test_modules(module, text)).collect();
        files.retain(|module, _| !tests.iter().any(|test| module == test || module.starts_with(&format!("{test}::"))));
        for text in files.values_mut() {
            *text = without_test_items(text);
        }
        Self(files)
    }

    /// The file in which the item of a path is defined; re-exports are followed, `rounds` of them so far.
    fn home(&self, path: &[String], rounds: usize) -> Option<String> {
        let mut module = String::new();
        for (i, segment) in path.iter().enumerate() {
            let below = join(&module, segment);
            if self.0.contains_key(&below) {
                module = below;
                continue;
            }
            let text = self.0.get(&module)?;
            // A name that the module only hands on is at home elsewhere.
            for export in uses(text).into_iter().filter(|used| used.public && rounds < 8) {
                let target = self.absolute(&module, &export.path).filter(|target| target.last() == Some(segment));
                if let Some(target) = target {
                    return self.home(&[&target[..], &path[i + 1..]].concat(), rounds + 1);
                }
            }
            return Some(module);
        }
        (!module.is_empty()).then_some(module)
    }

    /// Paths from the root of the crate that a path written in `module` stands for; none for other crates.
    fn absolute(&self, module: &str, path: &[String]) -> Option<Vec<String>> {
        let mut own: Vec<String> = module.split("::").filter(|s| !s.is_empty()).map(str::to_owned).collect();
        let mut rest = path;
        match rest.first()?.as_str() {
            "crate" | "sahara_core" => {
                own.clear();
                rest = &rest[1..];
            }
            "self" => rest = &rest[1..],
            "super" => {}
            child if self.0.contains_key(&join(module, child)) => {}
            _ => return None,
        }
        while rest.first().is_some_and(|segment| segment == "super") {
            own.pop();
            rest = &rest[1..];
        }
        own.extend(rest.iter().filter(|segment| *segment != "self").cloned());
        Some(own)
    }

    /// Which files each file imports.
    fn imports(&self) -> BTreeMap<String, BTreeSet<String>> {
        let mut imports = BTreeMap::new();
        for (module, text) in self.0.iter().filter(|(module, _)| !["", "lib", "main"].contains(&module.as_str())) {
            // What a folder hands on of its files is no import of its own.
            let used = uses(text).into_iter().filter(|used| !used.public).map(|used| used.path);
            let homes = used.chain(paths(text)).filter_map(|path| self.home(&self.absolute(module, &path)?, 0));
            imports.insert(module.clone(), homes.filter(|home| home != module).collect());
        }
        imports
    }
}

fn join(module: &str, name: &str) -> String {
    if module.is_empty() { name.to_owned() } else { format!("{module}::{name}") }
}

fn room(module: &str) -> &str {
    module.split("::").next().unwrap_or(module)
}

fn collect(folder: &Path, module: &str, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            // The core is a crate of its own; the suite hands on its rooms under the names that they have there.
            let is_core = module.is_empty() && stem == "core";
            collect(&path, &if is_core { String::new() } else { join(module, &stem) }, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = if stem == "mod" { module.to_owned() } else { join(module, &stem) };
            found.push((name, fs::read_to_string(&path).unwrap()));
        }
    }
}

/// A source text without comments.
fn code(source: &str) -> String {
    source.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// The modules with files of their own that are compiled for tests alone.
fn test_modules(module: &str, text: &str) -> Vec<String> {
    let after = text.match_indices("#[cfg(test)]").map(|(at, mark)| text[at + mark.len()..].trim_start());
    let name = |item: &str| {
        let (head, _) = item.split_once(';')?;
        let (_, name) = head.split_once("mod ")?;
        (!head.contains(['{', '('].as_slice()) || head.starts_with("pub(")).then(|| join(module, name.trim()))
    };
    after.filter_map(name).filter(|name| name.chars().all(|c| c.is_alphanumeric() || "_:".contains(c))).collect()
}

/// The text without items that are compiled for tests alone.
fn without_test_items(text: &str) -> String {
    let mut left = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("#[cfg(test)]") {
        left.push_str(before);
        let (mut depth, mut end) = (0, after.len());
        for (at, c) in after.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                _ => {}
            }
            if depth == 0 && (c == '}' || c == ';') {
                end = at + 1;
                break;
            }
        }
        rest = &after[end..];
    }
    left + rest
}

/// One path of a `use`.
struct Use {
    public: bool,
    path: Vec<String>,
}

/// All paths of all `use` items.
fn uses(text: &str) -> Vec<Use> {
    let mut found = vec![];
    for (at, _) in text.match_indices("use ") {
        let line = text[..at].rsplit('\n').next().unwrap_or("").trim();
        if !(line.is_empty() || line.starts_with("pub")) {
            continue;
        }
        let Some((list, _)) = text[at + 4..].split_once(';') else { continue };
        let mut paths = vec![];
        expand(&[], list, &mut paths);
        found.extend(paths.into_iter().map(|path| Use { public: line.starts_with("pub"), path }));
    }
    found
}

/// Writes out the braces of a list of paths.
fn expand(prefix: &[String], list: &str, found: &mut Vec<Vec<String>>) {
    let (mut depth, mut start, mut items) = (0, 0, vec![]);
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                items.push(&list[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    items.push(&list[start..]);
    for item in items.into_iter().map(str::trim).filter(|item| !item.is_empty()) {
        let (head, inner) = match item.split_once('{') {
            Some((head, inner)) => (head, Some(inner.trim_end().trim_end_matches('}'))),
            None => (item.split(" as ").next().unwrap_or(item), None),
        };
        let segments = head.split("::").map(str::trim).filter(|segment| !segment.is_empty()).map(str::to_owned);
        let path: Vec<String> = prefix.iter().cloned().chain(segments).collect();
        match inner {
            Some(inner) => expand(&path, inner, found),
            None => found.push(path),
        }
    }
}

/// Paths in code that begin with `crate` or `super`.
fn paths(text: &str) -> Vec<Vec<String>> {
    let mut found = vec![];
    for start in ["crate::", "super::"] {
        for (at, _) in text.match_indices(start) {
            // A longer word that ends so is another one; `super::super` begins before.
            let before = &text[..at];
            if before.ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
                continue;
            }
            let end = text[at..].find(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'));
            let path = &text[at..end.map_or(text.len(), |end| at + end)];
            let list = text[at + path.len()..].starts_with('{');
            if !list {
                found.push(path.split("::").filter(|s| !s.is_empty()).map(str::to_owned).collect());
            }
        }
    }
    found
}

/// What is wrong between rooms.
fn upward(imports: &BTreeMap<String, BTreeSet<String>>) -> Vec<String> {
    let layer = |room: &str| LAYERS.iter().find(|(name, _)| *name == room).map(|(_, layer)| *layer);
    let mut faults = BTreeSet::new();
    for (file, homes) in imports {
        let Some(own) = layer(room(file)) else {
            faults.insert(format!("the room {:?} has no layer: add it to tests/layers.rs", room(file)));
            continue;
        };
        for home in homes.iter().filter(|home| room(home) != room(file)) {
            let is_right = match layer(room(home)) {
                Some(other) if own == STRUCTURES => other < own,
                Some(other) => other <= own,
                None => false,
            };
            if !is_right {
                faults.insert(format!("{file} imports {home}"));
            }
        }
    }
    faults.into_iter().collect()
}

/// The circles of a graph: sets of names of which each reaches each.
fn circles(graph: &BTreeMap<String, BTreeSet<String>>) -> Vec<Vec<String>> {
    let reach = |from: &String| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(next) = open.pop() {
            for target in graph.get(next).into_iter().flatten() {
                if seen.insert(target) {
                    open.push(target);
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&String, BTreeSet<&String>> = graph.keys().map(|name| (name, reach(name))).collect();
    let mut found: Vec<Vec<String>> = vec![];
    for name in graph.keys().filter(|name| reached[*name].contains(*name)) {
        let circle: Vec<String> = graph
            .keys()
            .filter(|other| reached[name].contains(other) && reached[*other].contains(name))
            .cloned()
            .collect();
        if !found.contains(&circle) {
            found.push(circle);
        }
    }
    found
}

fn between_rooms(imports: &BTreeMap<String, BTreeSet<String>>) -> BTreeMap<String, BTreeSet<String>> {
    let mut rooms: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (file, homes) in imports {
        let others = homes.iter().map(|home| room(home).to_owned()).filter(|other| other != room(file));
        rooms.entry(room(file).to_owned()).or_default().extend(others);
    }
    rooms
}

#[test]
fn imports_go_downward_between_rooms() {
    let imports = Sources::of_the_crate().imports();
    assert!(imports.len() > 300, "the files of both crates are found");
    let faults = upward(&imports);
    assert!(faults.is_empty(), "imports must go downward:\n{}", faults.join("\n"));
    let circles = circles(&between_rooms(&imports));
    assert!(circles.is_empty(), "rooms import each other in circles: {circles:?}");
}

#[test]
fn files_do_not_import_each_other_in_circles() {
    let circles = circles(&Sources::of_the_crate().imports());
    assert!(circles.is_empty(), "files import each other in circles:\n{circles:#?}");
}

/// A small crate: each file's module and text.
fn planted(files: &[(&str, &str)]) -> BTreeMap<String, BTreeSet<String>> {
    Sources::new(files.iter().map(|(module, text)| (module.to_string(), text.to_string()))).imports()
}

#[test]
fn planted_upward_imports_are_found() {
    let count = |source: &str| {
        let rest = [("kdtree", ""), ("bvh8", ""), ("registry", ""), ("scene", ""), ("geometry", ""), ("cli", "")];
        upward(&planted(&[&rest[..], &[("accel", source)]].concat())).len()
    };
    assert_eq!(count("use crate::geometry::Ray;\nuse super::geometry::Mesh;"), 0);
    assert_eq!(count("use crate::kdtree::KdTree;"), 1);
    assert_eq!(count("use super::kdtree::KdTree;"), 1, "by `super` as well");
    assert_eq!(count("fn f() { let x = crate::registry::Registry::builtin(); }"), 1);
    assert_eq!(count("use crate::{geometry::{Mesh, Ray}, scene::Model, triangle};"), 1);
    assert_eq!(count("use crate::{\n    kdtree,\n    cli::main,\n};"), 2);
    assert_eq!(count("/// See [`crate::registry`].\n// use crate::cli;\nuse my_crate::cli;"), 0);
    assert_eq!(count("#[cfg(test)]\nmod tests {\n    use crate::registry::Registry;\n}\n"), 0, "tests may look up");
    assert_eq!(upward(&planted(&[("attic", "")])).len(), 1, "a room without a layer is not overlooked");
    let sideways = planted(&[("bvh8", "use crate::kdtree::KdTree;"), ("kdtree", "")]);
    assert_eq!(upward(&sideways), ["bvh8 imports kdtree"], "structures do not know each other");
    let below = planted(&[
        ("build::sah_cost", "use crate::bvh8::node::Node;"),
        ("build", ""),
        ("bvh8", ""),
        ("bvh8::node", ""),
    ]);
    assert_eq!(upward(&below), ["build::sah_cost imports bvh8::node"]);
}

#[test]
fn planted_circles_are_found() {
    let of = |files: &[(&str, &str)]| circles(&planted(files));
    let room = ("bvh8", "mod node;\nmod stack;\npub use node::Node;\npub(crate) use stack::Stack;\n");
    let by_super = [room, ("bvh8::node", "use super::stack::DEPTH;"), ("bvh8::stack", "use super::node::Node;")];
    assert_eq!(of(&by_super), [["bvh8::node", "bvh8::stack"]]);
    let by_folder = [room, ("bvh8::node", "use super::Stack;"), ("bvh8::stack", "use crate::bvh8::Node;")];
    assert_eq!(of(&by_folder), [["bvh8::node", "bvh8::stack"]], "what a folder hands on is at home in its file");
    let one_way = [room, ("bvh8::node", ""), ("bvh8::stack", "use crate::bvh8::Node;")];
    assert_eq!(of(&one_way), [[""; 0]; 0]);
    let with_folder = [("bvh8", "mod node;\nuse node::Node;\nstruct Tree;"), ("bvh8::node", "use super::Tree;")];
    assert_eq!(of(&with_folder), [["bvh8", "bvh8::node"]], "a folder's own items count");
    let in_code = [room, ("bvh8::node", "fn f() { super::stack::g() }"), ("bvh8::stack", "use super::{node::Node};")];
    assert_eq!(of(&in_code).len(), 1);
    let in_tests = [
        ("bvh8", "mod node;\n#[cfg(test)]\nmod tests;\n"),
        ("bvh8::node", "#[cfg(test)]\nuse super::tests::mesh;"),
        ("bvh8::tests", "use super::node::Node;"),
    ];
    assert_eq!(of(&in_tests), [[""; 0]; 0]);
    let rooms = planted(&[("scene", "use crate::oracle::Tree;"), ("oracle", "use crate::scene::Model;")]);
    assert_eq!(circles(&between_rooms(&rooms)), [["oracle", "scene"]]);
}
