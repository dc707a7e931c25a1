//! Imports go downward only, between modules of the crate and between their files: no circles, whatever path an import takes.

use std::collections::{BTreeMap, BTreeSet};
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

/// What each imports.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// Source files by module path, `bvh8::node`; a folder's `mod.rs` is the folder. Without comments, and without what is
/// compiled for tests alone.
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
        sources
            .retain(|module, _| !tests.iter().any(|test| module == test || module.starts_with(&format!("{test}::"))));
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
                // A name that the module only hands on is at home elsewhere.
                let exports = imports(self.0.get(&module)?).into_iter().filter(|used| used.public && rounds < 8);
                let mut targets = exports.filter_map(|used| self.absolute(&module, &used.path));
                let target = targets.find(|target| target.rsplit("::").next() == Some(segment));
                return target.map_or(Some(module), |target| self.home(&join(&target, after), rounds + 1));
            }
            (module, rest) = (below, after);
        }
        (!module.is_empty()).then_some(module)
    }

    /// The path from the root of the crate that a path written in `module` stands for; none for other crates.
    fn absolute(&self, module: &str, path: &str) -> Option<String> {
        let mut own: Vec<&str> = module.split("::").filter(|segment| !segment.is_empty()).collect();
        let mut segments = path.split("::").peekable();
        match segments.peek().copied()? {
            "crate" | "sahara_core" => own.clear(),
            "self" | "super" => {}
            child if self.0.contains_key(&join(module, child)) => {}
            _ => return None,
        }
        for segment in segments {
            match segment {
                "crate" | "sahara_core" | "self" => {}
                "super" => _ = own.pop(),
                segment => own.push(segment),
            }
        }
        Some(own.join("::"))
    }

    /// Which files each file imports.
    fn graph(&self) -> Graph {
        let mut graph = Graph::new();
        for (module, text) in self.0.iter().filter(|(module, _)| !["", "lib", "main"].contains(&module.as_str())) {
            // What a folder hands on of its files is no import of its own.
            let used = imports(text).into_iter().filter(|used| !used.public);
            let homes = used.filter_map(|used| self.home(&self.absolute(module, &used.path)?, 0));
            graph.insert(module.clone(), homes.filter(|home| home != module).collect());
        }
        graph
    }
}

fn join(module: &str, name: &str) -> String {
    [module, name].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("::")
}

/// The module of the crate that a file belongs to.
fn top(module: &str) -> &str {
    module.split("::").next().unwrap_or(module)
}

fn collect(folder: &Path, module: &str, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            // The core is a crate of its own; the suite re-exports its modules under their names.
            let is_core = module.is_empty() && stem == "core";
            collect(&path, &if is_core { String::new() } else { join(module, &stem) }, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = if stem == "mod" { module.to_owned() } else { join(module, &stem) };
            found.push((name, fs::read_to_string(&path).unwrap()));
        }
    }
}

/// The text without the items that are compiled for tests alone, and these items.
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

/// One path of a `use`, or a path in code.
struct Import {
    public: bool,
    path: String,
}

/// All paths of all `use` items, and the paths in code that begin with `crate` or `super`.
fn imports(text: &str) -> Vec<Import> {
    let mut found = vec![];
    for (at, _) in text.match_indices("use ") {
        let line = text[..at].rsplit('\n').next().unwrap_or("").trim();
        if let (true, Some((tree, _))) = (line.is_empty() || line.starts_with("pub"), text[at + 4..].split_once(';')) {
            let public = line.starts_with("pub");
            found.extend(expanded("", tree).into_iter().map(|path| Import { public, path }));
        }
    }
    let is_of_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    for (at, _) in ["crate::", "super::"].iter().flat_map(|start| text.match_indices(start)) {
        let end = text[at..].find(|c: char| !is_of_path(c)).map_or(text.len(), |end| at + end);
        // A longer word that ends so is another one; `super::super` begins before. Lists are those of `use`.
        if !text[..at].ends_with(is_of_path) && !text[end..].starts_with('{') {
            found.push(Import { public: false, path: text[at..end].trim_end_matches(':').into() });
        }
    }
    found
}

/// The paths of a list, its braces written out.
fn expanded(prefix: &str, list: &str) -> Vec<String> {
    let (mut found, mut depth, mut start) = (vec![], 0, 0);
    for (at, c) in list.char_indices().chain([(list.len(), ',')]) {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c != ',' || depth > 0 {
            continue;
        }
        let item = list[start..at].trim();
        start = at + 1;
        match item.strip_suffix('}').and_then(|item| item.split_once('{')) {
            Some((head, inner)) => found.extend(expanded(&format!("{prefix}{}", head.trim()), inner)),
            None if item.is_empty() => {}
            None => found.push(format!("{prefix}{}", item.split(" as ").next().unwrap_or(item))),
        }
    }
    found
}

/// What is wrong between modules of the crate: as their places are in one order, none import each other in circles.
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

/// The names of a graph that are in circles, or lie between two: those left when what imports nothing of the rest, and what
/// nothing of the rest imports, is taken away again and again.
fn circles(graph: &Graph) -> Vec<&str> {
    let mut left: Vec<&str> = graph.keys().map(String::as_str).collect();
    loop {
        let imports = |from: &str, to: &str| graph[from].contains(to);
        let is_bound = |name: &&str| {
            left.iter().any(|other| imports(name, other)) && left.iter().any(|other| imports(other, name))
        };
        let bound: Vec<&str> = left.iter().copied().filter(is_bound).collect();
        if bound.len() == left.len() {
            return left;
        }
        left = bound;
    }
}

#[test]
fn imports_go_downward_without_circles() {
    let graph = Sources::of_the_crate().graph();
    assert!(graph.len() > 300, "the files of both crates are found");
    let faults = upward(&graph);
    assert!(faults.is_empty(), "imports must go downward:\n{}", faults.join("\n"));
    let circles = circles(&graph);
    assert!(circles.is_empty(), "files import each other in circles:\n{circles:#?}");
}

/// A small crate: each file's module and text.
fn planted(files: &[(&str, &str)]) -> Graph {
    Sources::new(files.iter().map(|(module, text)| (module.to_string(), text.to_string())).collect()).graph()
}

#[test]
fn planted_upward_imports_are_found() {
    let modules = ["kdtree", "bvh8", "registry", "scene", "geometry", "cli"].map(|name| (name, ""));
    for (source, count) in [
        ("use crate::geometry::Ray;\nuse super::geometry::Mesh;", 0),
        ("use crate::kdtree::KdTree;", 1),
        ("use super::kdtree::KdTree;", 1),
        ("fn f() { let x = crate::registry::Registry::builtin(); }", 1),
        ("use crate::{geometry::{Mesh, Ray}, scene::Model, triangle};", 1),
        ("use crate::{\n    kdtree,\n    cli::main,\n};", 2),
        ("/// See [`crate::registry`].\n// use crate::cli;\nuse my_crate::cli;", 0),
        ("#[cfg(test)]\nmod tests {\n    use crate::registry::Registry;\n}\n", 0),
    ] {
        assert_eq!(upward(&planted(&[&modules[..], &[("accel", source)]].concat())).len(), count, "{source}");
    }
    assert_eq!(upward(&planted(&[("attic", "")])).len(), 1, "a module without a layer is not overlooked");
    let sideways = [("bvh8", "use crate::kdtree::KdTree;"), ("kdtree", "")];
    assert_eq!(upward(&planted(&sideways)), ["bvh8 imports kdtree"], "structures do not know each other");
    let modules = planted(&[("scene", "use crate::oracle::Tree;"), ("oracle", "use crate::scene::Model;")]);
    assert_eq!(upward(&modules), ["scene imports oracle"], "no circles between modules");
    let below = [("build::sah_cost", "use crate::bvh8::node::Node;"), ("build", ""), ("bvh8", ""), ("bvh8::node", "")];
    assert_eq!(upward(&planted(&below)), ["build::sah_cost imports bvh8::node"]);
}

#[test]
fn planted_circles_are_found() {
    const FOLDER: &str = "mod node;\nmod stack;\npub use node::Node;\npub(crate) use stack::Stack;\n";
    let of_two = |node: &str, stack: &str| planted(&[("bvh8", FOLDER), ("bvh8::node", node), ("bvh8::stack", stack)]);
    for (node, stack, circle) in [
        ("use super::stack::DEPTH;", "use super::node::Node;", true),
        // What a folder re-exports is at home in its file.
        ("use super::Stack;", "use crate::bvh8::Node;", true),
        ("fn f() { super::stack::g() }", "use super::{node::Node};", true),
        ("", "use crate::bvh8::Node;", false),
    ] {
        let expected = if circle { &["bvh8::node", "bvh8::stack"][..] } else { &[] };
        assert_eq!(circles(&of_two(node, stack)), expected, "{node} {stack}");
    }
    let with_folder = [("bvh8", "mod node;\nuse node::Node;\nstruct Tree;"), ("bvh8::node", "use super::Tree;")];
    assert_eq!(circles(&planted(&with_folder)), ["bvh8", "bvh8::node"], "a folder's own items count");
    let in_tests = [
        ("bvh8", "mod node;\n#[cfg(test)]\nmod tests;\n"),
        ("bvh8::node", "#[cfg(test)]\nuse super::tests::mesh;"),
        ("bvh8::tests", "use super::node::Node;"),
    ];
    assert_eq!(circles(&planted(&in_tests)), [""; 0]);
}
