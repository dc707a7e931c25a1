//! `rays corpus` from outside: the same files on every machine, readable for other programs and for this command.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use sahara::scene::files::RayFile;

use super::command::{
    RIGHT, SQUARE, at, command, ends, path_text, prints, refuses, refuses_in_a_line, stderr, stdout, write,
};

/// All files of a folder.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())).collect()
}

/// The output of `sha256sum -c` for the files of a folder; `None` if the program is missing.
fn checked(folder: &Path) -> Option<String> {
    let mut sha256sum = Command::new("sha256sum");
    sha256sum.args(["-c", "--strict", "SHA256SUMS"]).env("LC_ALL", "C").current_dir(folder);
    let output = sha256sum.output().ok()?;
    assert!(output.status.success(), "{}{}", stdout(&output), stderr(&output));
    Some(stdout(&output))
}

#[test]
fn a_corpus_is_the_same_again_and_what_it_says() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("d");
    let out = path_text(&folder);
    let printed = prints(&["rays", "corpus", "cube", "-o", &out, "--rays", "40"]);
    assert!(printed.contains("Cube") && printed.contains("320") && !printed.contains("published"), "{printed}");
    let first = files(&folder);
    // A mesh, eight kinds of rays with their exact hits, the hashes and the list of stand-ins.
    assert_eq!(first.len(), 1 + 2 * 8 + 2, "{:?}", first.keys());
    if let Some(said) = checked(&folder) {
        let names: Vec<&str> = said.lines().map(|line| line.strip_suffix(": OK").unwrap()).collect();
        let owed: Vec<&str> = first.keys().map(String::as_str).filter(|name| name.contains("cube")).collect();
        assert!(names.is_sorted() && names == owed, "{names:?}");
    } else {
        println!("not checked: there is no sha256sum here");
    }

    // Replaces the old one, with another number of threads and other instructions; a repeated scene counts once.
    let mut again = command(&["rays", "corpus", "CUBE", "cube", "-o", &out, "--rays", "40", "--level", "portable"]);
    assert_eq!(ends(RIGHT, again.env("RAYON_NUM_THREADS", "1")).0, printed);
    assert!(files(&folder) == first, "it is another one");
    prints(&["rays", "corpus", "cube", "-o", &out, "--rays", "40", "--seed", "2"]);
    assert!(files(&folder) != first, "the seed changes nothing");

    let (mesh, rays) = (path_text(&folder.join("cube.ply")), path_text(&folder.join("cube-edge.rays")));
    prints(&["validate", &mesh, "--rays", &rays, "-s", "sah-kd"]);
    let (rays, truth) = (RayFile::read(Path::new(&rays)).unwrap(), fs::read(folder.join("cube-edge.truth")).unwrap());
    assert_eq!((rays.workload.rays.len(), &truth[16..24]), (40, &40_u64.to_le_bytes()[..]));
    let hash: String = truth[24..32].iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(hash, rays.workload.hash());

    // From the mesh of a corpus: the same rays, whose hash is in the exact hits, except those from the camera.
    let beside = at(&parent, "e");
    prints(&["rays", "corpus", &mesh, "-o", &beside, "--rays", "40", "--seed", "2"]);
    for name in ["cube.ply", "cube-vertex.truth", "cube-offset.truth"] {
        assert!(files(&folder)[name] == files(Path::new(&beside))[name], "{name}");
    }
}

#[test]
fn what_a_corpus_cannot_be_made_of_is_refused_and_nothing_of_others_is_replaced() {
    let parent = tempfile::tempdir().unwrap();
    let out = at(&parent, "d");
    refuses(&["rays", "corpus", "cube"], &["--output"]);
    for count in ["0", "many", "99999999"] {
        refuses(&["rays", "corpus", "cube", "-o", &out, "--rays", count], &["--rays"]);
    }
    refuses_in_a_line(&["rays", "corpus", "cubee", "-o", &out], &["cubee", "did you mean Cube?"]);
    refuses_in_a_line(&["rays", "corpus", "no/mesh.ply", "-o", &out], &["no/mesh.ply", "check that it exists"]);
    let other = write(&parent, "cube.obj", SQUARE);
    refuses_in_a_line(&["rays", "corpus", "cube", &other, "-o", &out], &["two different scenes have the name cube"]);
    let [spaced, joined] = ["a square.obj", "a-square.obj"].map(|name| write(&parent, name, SQUARE));
    let both = ["rays", "corpus", &spaced, &joined, "-o", &out, "--rays", "3"];
    refuses_in_a_line(&both, &["write the same file, a-square-"]);
    assert!(!Path::new(&out).exists(), "what was refused has left a folder");

    let foreign = tempfile::tempdir().unwrap();
    let notes = write(&foreign, "notes.txt", "mine");
    let theirs = path_text(foreign.path());
    refuses_in_a_line(&["rays", "corpus", "cube", "-o", &theirs], &["notes.txt", "another folder"]);
    refuses_in_a_line(&["rays", "corpus", "cube", "-o", &notes], &["notes.txt", "it is a file"]);
    assert_eq!(files(foreign.path()).len(), 1);

    // A corpus must not be made from files that it replaces.
    let square = write(&parent, "square.obj", SQUARE);
    prints(&["rays", "corpus", &square, "-o", &out, "--rays", "3"]);
    let before = files(Path::new(&out));
    let inside = path_text(&Path::new(&out).join("square.ply"));
    refuses_in_a_line(&["rays", "corpus", &inside, "-o", &out], &["square.ply", "an input file"]);
    assert!(files(Path::new(&out)) == before);
}

#[test]
#[ignore = "long: the exact answers to all rays of all twelve scenes"]
fn the_whole_corpus_is_as_published() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("d");
    let printed = prints(&["rays", "corpus", "-o", &path_text(&folder)]);
    let last = printed.lines().last().unwrap();
    assert!(last.starts_with("SHA-256 of SHA256SUMS: ") && last.ends_with(", as published"), "{last}");
    checked(&folder);
}
