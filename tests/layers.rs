//! Imports go downward only.

use std::fs;
use std::path::{Path, PathBuf};

/// The layers of the house, as ARCHITECTURE.md draws them.
const LAYERS: [(&str, u32); 22] = [
    ("geometry", 0),
    ("exact", 0),
    ("nearest", 0),
    ("output", 0),
    ("simd", 0),
    ("triangle", 0),
    ("accel", 1),
    ("structures", 2),
    ("scene", 3),
    ("workload", 3),
    ("oracle", 3),
    ("render", 4),
    ("measure", 4),
    ("golden", 4),
    ("validate", 4),
    ("fetch", 4),
    ("registry", 5),
    ("study", 5),
    ("report", 5),
    ("publish", 6),
    ("cli", 7),
    ("build_info", 7),
];

fn layer(module: &str) -> Option<u32> {
    LAYERS.iter().find(|(name, _)| *name == module).map(|(_, layer)| *layer)
}

/// The top-level modules that a source text names by `crate::name` or `crate::{name, ..}`, comments aside.
fn imports(source: &str) -> Vec<String> {
    let code: String = source.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n");
    let mut found = vec![];
    for (at, _) in code.match_indices("crate::") {
        // `$crate::` in a macro means the same; a longer word that ends so does not.
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &code[at + "crate::".len()..];
        match rest.strip_prefix('{') {
            Some(list) => found.extend(listed(list)),
            None => found.push(name(rest)),
        }
    }
    found.retain(|module| !module.is_empty());
    found
}

fn name(text: &str) -> String {
    text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// The first names of the items of a list, up to the brace that closes it.
fn listed(list: &str) -> Vec<String> {
    let (mut depth, mut items) = (0, vec![name(list)]);
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => items.push(name(&list[at + 1..])),
            _ => {}
        }
    }
    items
}

/// What is wrong with a file of the top-level module `module`.
fn faults(module: &str, file: &Path, source: &str) -> Vec<String> {
    let Some(own) = layer(module) else {
        return vec![format!("{}: the module {module:?} has no layer: add it to tests/layers.rs", file.display())];
    };
    let fault = |import: String| match layer(&import) {
        Some(other) if other <= own => None,
        Some(other) => Some(format!("{}: L{own} {module} imports L{other} {import}", file.display())),
        // A macro or an item of the crate root.
        None if import == "conformance" => None,
        None => Some(format!("{}: {import:?} has no layer: add it to tests/layers.rs", file.display())),
    };
    imports(source).into_iter().filter_map(fault).collect()
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn no_module_imports_a_higher_layer() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = vec![];
    files(&source, &mut found);
    found.sort();
    let mut faulty = vec![];
    for file in found {
        let inside = file.strip_prefix(&source).unwrap();
        let first = inside.components().next().unwrap().as_os_str().to_str().unwrap();
        let module = first.strip_suffix(".rs").unwrap_or(first);
        // The two roots name everything.
        if module != "lib" && module != "main" {
            faulty.extend(faults(module, inside, &fs::read_to_string(&file).unwrap()));
        }
    }
    assert!(faulty.is_empty(), "imports must go downward:\n{}", faulty.join("\n"));
}

#[test]
fn a_planted_upward_import_is_found() {
    let file = Path::new("accel/planted.rs");
    let count = |source: &str| faults("accel", file, source).len();
    assert_eq!(count("use crate::geometry::Ray;\nuse super::Counts;"), 0);
    assert_eq!(count("use crate::structures::KdTree;"), 1);
    assert_eq!(count("fn f() { let x = crate::registry::Registry::builtin(); }"), 1);
    assert_eq!(count("use crate::{geometry::{Mesh, Ray}, scene::Model, triangle};"), 1);
    assert_eq!(count("use crate::{\n    render,\n    cli::main,\n};"), 2);
    assert_eq!(count("/// See [`crate::registry`].\n// use crate::cli;\nuse my_crate::cli;"), 0);
    assert_eq!(count("use crate::attic::Box;"), 1, "a module without a layer is not overlooked");
    assert_eq!(faults("attic", file, "").len(), 1);
}
