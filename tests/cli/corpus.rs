//! Tests the files that `rays corpus` writes.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use sahara::scene::files::RayFile;

use super::command::{Folder, RIGHT, SQUARE, ends, output_texts};

pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())).collect()
}

/// The output of `sha256sum -c`. `None` if `sha256sum` is missing.
fn checked(folder: &Path) -> Option<String> {
    let mut sha256sum = Command::new("sha256sum");
    sha256sum.args(["-c", "--strict", "SHA256SUMS"]).env("LC_ALL", "C").current_dir(folder);
    let output = sha256sum.output().ok()?;
    let [text, messages] = output_texts(&output);
    assert!(output.status.success(), "{text}{messages}");
    Some(text)
}

#[test]
fn a_corpus_is_the_same_again_and_what_it_says() {
    let folder = Folder::new();
    let corpus = || files(&folder.path("d"));
    let printed = folder.shows("rays corpus cube -o d --rays 40", &["Cube", "320"]);
    assert!(!printed.contains("published"), "{printed}");
    let first = corpus();
    // One mesh, eight files of rays, eight files of exact hits, and two lists.
    assert_eq!(first.len(), 1 + 2 * 8 + 2, "{:?}", first.keys());
    if let Some(text) = checked(&folder.path("d")) {
        let names: Vec<&str> = text.lines().map(|line| line.strip_suffix(": OK").unwrap()).collect();
        let expected: Vec<&str> = first.keys().map(String::as_str).filter(|name| name.contains("cube")).collect();
        assert!(names.is_sorted() && names == expected, "{names:?}");
    } else {
        println!("not checked: there is no sha256sum here");
    }

    // Thread count and SIMD level do not change the corpus. A repeated scene is written only once.
    let mut again = folder.command("rays corpus CUBE cube -o d --rays 40 --level portable");
    let [again, _] = ends(RIGHT, again.env("RAYON_NUM_THREADS", "1"));
    assert!(again == printed && corpus() == first, "it is another one: {again}");
    folder.prints("rays corpus cube -o d --rays 40 --seed 2");
    assert!(corpus() != first, "the seed changes nothing");

    folder.prints("validate d/cube.ply --rays d/cube-edge.rays -s sah-kd");
    let rays = RayFile::read(&folder.path("d/cube-edge.rays")).unwrap();
    let truth = fs::read(folder.path("d/cube-edge.truth")).unwrap();
    assert_eq!((rays.workload.rays.len(), &truth[16..24]), (40, &40_u64.to_le_bytes()[..]));
    let hash: String = truth[24..32].iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(hash, rays.workload.hash());

    // The corpora `d` and `e` have the same rays, except camera rays. A `.truth` file contains the hash of its rays.
    folder.prints("rays corpus d/cube.ply -o e --rays 40 --seed 2");
    for name in ["cube.ply", "cube-vertex.truth", "cube-offset.truth"] {
        assert!(corpus()[name] == files(&folder.path("e"))[name], "{name}");
    }
}

#[test]
fn what_a_corpus_cannot_be_made_of_is_refused_and_nothing_of_others_is_replaced() {
    let folder = Folder::new();
    for (options, part) in [
        ("", "--output"),
        ("-o d --rays 0", "--rays"),
        ("-o d --rays many", "--rays"),
        ("-o d --rays 99999999", "--rays"),
    ] {
        folder.refuses(&format!("rays corpus cube {options}"), &[part]);
    }
    fs::create_dir(folder.path("theirs")).unwrap();
    folder.write("theirs/notes.txt", "mine");
    for name in ["cube.obj", "a square.obj", "a-square.obj", "square.obj"] {
        folder.write(name, SQUARE);
    }
    for (options, parts) in [
        ("cubee -o d", &["cubee", "did you mean Cube?"][..]),
        ("no/mesh.ply -o d", &["no/mesh.ply", "check that it exists"]),
        ("cube cube.obj -o d", &["two different scenes have the name cube"]),
        ("'a square.obj' a-square.obj -o d --rays 3", &["write the same file, a-square-"]),
        ("cube -o theirs", &["notes.txt", "another folder"]),
        ("cube -o theirs/notes.txt", &["notes.txt", "it is a file"]),
    ] {
        folder.refuses_in_a_line(&format!("rays corpus {options}"), parts);
    }
    assert!(!folder.path("d").exists(), "a refused command created a folder");
    assert_eq!(files(&folder.path("theirs")).len(), 1);

    // The command must not replace an input file.
    folder.prints("rays corpus square.obj -o d --rays 3");
    let before = files(&folder.path("d"));
    folder.refuses_in_a_line("rays corpus d/square.ply -o d", &["square.ply", "an input file"]);
    assert!(files(&folder.path("d")) == before);
}

#[test]
#[ignore = "long: the exact answers to all rays of all twelve scenes"]
fn the_whole_corpus_is_as_published() {
    let folder = Folder::new();
    let printed = folder.prints("rays corpus -o d");
    let last = printed.lines().last().unwrap();
    assert!(last.starts_with("SHA-256 of SHA256SUMS: ") && last.ends_with(", as published"), "{last}");
    checked(&folder.path("d"));
}
