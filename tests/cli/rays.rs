//! Files of rays and hits from outside: recorded rays are replayed to the bit, and damaged files are rejected.

use std::fs;
use std::process::Command;

use tempfile::TempDir;

use super::command::{WRONG, command, printed, refused_in_a_line, stdout};
use super::journal::rows;

fn sahara(folder: &TempDir, args: &[&str]) -> Command {
    let mut command = command(args);
    command.current_dir(folder);
    command
}

/// The output of the command; it must succeed.
#[track_caller]
fn right(folder: &TempDir, args: &[&str]) -> String {
    printed(&mut sahara(folder, args))
}

/// Checks that the command rejects in one line that contains all of `parts`.
#[track_caller]
fn refuses(folder: &TempDir, args: &[&str], parts: &[&str]) {
    refused_in_a_line(&sahara(folder, args).output().unwrap(), parts);
}

#[test]
fn a_replayed_workload_is_the_workload() {
    let folder = tempfile::tempdir().unwrap();
    let common = ["--runs", "2", "--budget", "2", "-s", "sah-kd", "-s", "brute-force"];
    for kind in ["diffuse", "shadow"] {
        let printed = right(&folder, &["rays", "record", "torus", "-w", kind, "-o", "f.rays"]);
        // The number of timed rays does not change the workload.
        let mut made = vec!["compare", "torus", "-w", kind, "--rays", "900", "--export-json", "made.json"];
        made.extend(common);
        right(&folder, &made);
        let mut replayed = vec!["compare", "--rays", "f.rays", "--export-json", "replayed.json"];
        replayed.extend(common);
        right(&folder, &replayed);

        let (made, replayed) = (rows(folder.path().join("made.json")), rows(folder.path().join("replayed.json")));
        assert_eq!((made.len(), replayed.len()), (2, 2));
        for (made, replayed) in made.iter().zip(&replayed) {
            for field in ["scene", "scene_hash", "workload", "query", "hash", "all"] {
                assert_eq!(made[field], replayed[field], "{kind} {field}");
            }
            assert_eq!(made["counts"]["hits"], replayed["counts"]["hits"], "{kind}");
            assert!(printed.contains(made["hash"].as_str().unwrap()), "{printed}");
        }
    }
    right(&folder, &["rays", "record", "torus", "-w", "shadow", "-o", "f.rays", "--rays", "900"]);
    right(&folder, &["validate", "--rays", "f.rays", "-s", "sah-kd"]);
    let printed =
        right(&folder, &["study", "accuracy", "torus", "--rays", "f.rays", "-s", "sah-kd:test=exact", "--runs", "1"]);
    assert!(printed.contains("rays of a file"), "{printed}");
}

#[test]
fn answers_go_out_and_come_back_and_wrong_ones_are_found() {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["primary", "shadow"] {
        right(&folder, &["rays", "record", "torus", "-w", kind, "-o", "f.rays", "--rays", "900"]);
        let exchange = ["validate", "--rays", "f.rays"];
        right(&folder, &[&exchange[..], &["-s", "sah-kd", "--export-hits", "f.hits"]].concat());
        let same = right(&folder, &[&exchange[..], &["--hits", "f.hits", "--test", "exact"]].concat());
        assert!(same.contains("against brute force with exact"), "{same}");
        let own = right(&folder, &[&exchange[..], &["--hits", "f.hits"]].concat());
        assert!(own.contains("f.hits is right on 900 rays."), "{own}");

        // Remove one hit.
        let path = folder.path().join("f.hits");
        let mut bytes = fs::read(&path).unwrap();
        let hit = bytes[32..].chunks_exact(8).position(|answer| answer[4..] != [0xff; 4]).unwrap();
        bytes[32 + 8 * hit + 4..32 + 8 * hit + 8].fill(0xff);
        fs::write(&path, bytes).unwrap();
        for test in [&["--test", "exact"][..], &[]] {
            let args = [&exchange[..], &["--hits", "f.hits"], test].concat();
            let output = sahara(&folder, &args).output().unwrap();
            assert_eq!(output.status.code(), Some(WRONG));
            assert!(stdout(&output).contains("lost on ray \""), "{}", stdout(&output));
        }
    }
    refuses(&folder, &["validate", "torus", "--hits", "f.hits"], &["--rays F.rays"]);
    refuses(&folder, &["validate", "--rays", "f.rays", "--export-hits", "g.hits"], &["--structure"]);
    refuses(&folder, &["validate", "--rays", "f.hits"], &["f.hits", "SAHARAYS"]);
    refuses(&folder, &["validate", "--rays", "f.rays", "--hits", "f.rays"], &["f.rays", "SAHAHITS"]);
    right(&folder, &["rays", "record", "torus", "-o", "g.rays", "--rays", "500"]);
    refuses(&folder, &["validate", "--rays", "g.rays", "--hits", "f.hits"], &["f.hits", "hash"]);
}

#[test]
fn rays_of_a_mesh_file_ask_for_it_and_nothing_that_is_read_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    fs::write(folder.path().join("mine.obj"), mesh).unwrap();
    let text = "0,0,1 0,0,-1\n";
    fs::write(folder.path().join("rays.txt"), text).unwrap();
    right(&folder, &["rays", "record", "mine.obj", "-o", "f.rays", "--rays", "100"]);
    refuses(&folder, &["validate", "--rays", "f.rays"], &["f.rays", "\"mine\"", "scene file"]);
    right(&folder, &["validate", "mine.obj", "--rays", "f.rays", "-s", "sah-kd"]);

    let rays = fs::read(folder.path().join("f.rays")).unwrap();
    let replay = ["mine.obj", "--rays", "f.rays", "-s", "sah-kd"];
    let overwriting: [&[&str]; 8] = [
        &["rays", "record", "mine.obj", "-o", "mine.obj"],
        &["rays", "import", "rays.txt", "-o", "rays.txt"],
        &["rays", "import", "rays.txt", "--scene", "mine.obj", "-o", "./mine.obj"],
        &["render", "mine.obj", "-o", "mine.obj"],
        &[&["validate"], &replay[..], &["--export-hits", "f.rays"]].concat(),
        &[&["validate"], &replay[..], &["--export-hits", "mine.obj"]].concat(),
        &[&["compare"], &replay[..], &["--export-csv", "f.rays"]].concat(),
        &[&["study", "accuracy"], &replay[..], &["--export-json", "mine.obj"]].concat(),
    ];
    for args in overwriting {
        refuses(&folder, args, &["an input file"]);
    }
    let now = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(now("mine.obj") == mesh.as_bytes() && now("rays.txt") == text.as_bytes() && now("f.rays") == rays);
}

#[test]
fn text_becomes_rays_and_rays_become_text() {
    let folder = tempfile::tempdir().unwrap();
    let text = "# two rays\n0,0,5 0,0,-1\n\n0.5,0,5 0,0,-1 [0.25,7.0] # bounded\n";
    fs::write(folder.path().join("rays.txt"), text).unwrap();
    right(&folder, &["rays", "import", "rays.txt", "-o", "f.rays", "--scene", "torus"]);
    let shown = right(&folder, &["rays", "show", "f.rays"]);
    assert!(shown.contains("2 rays") && shown.contains("Torus") && shown.contains("closest"), "{shown}");
    let shown = right(&folder, &["rays", "show", "f.rays", "--text"]);
    assert_eq!(shown, "0.0,0.0,5.0 0.0,0.0,-1.0\n0.5,0.0,5.0 0.0,0.0,-1.0 [0.25,7.0]\n");
    right(&folder, &["validate", "--rays", "f.rays", "-s", "sah-kd"]);
    refuses(&folder, &["validate", "cube", "--rays", "f.rays"], &["Torus", "Cube", "hash"]);
    refuses(&folder, &["validate", "cube", "torus", "--rays", "f.rays"], &["one scene"]);
    refuses(&folder, &["compare", "--rays", "f.rays", "-w", "primary"], &["--workload"]);
    refuses(&folder, &["compare", "--rays", "no.rays"], &["no.rays", "check that it exists"]);
    right(&folder, &["rays", "import", "rays.txt", "-o", "free.rays", "--any"]);
    refuses(&folder, &["validate", "--rays", "free.rays"], &["names no scene"]);
    right(&folder, &["validate", "cube", "--rays", "free.rays", "-s", "sah-kd"]);

    fs::write(folder.path().join("blanks.txt"), "0 0 5 0 0 -1\n0.5, 0, 5  0, 0, -1 [0.25 7]\n").unwrap();
    right(&folder, &["rays", "import", "blanks.txt", "-o", "blanks.rays", "--scene", "torus"]);
    assert_eq!(right(&folder, &["rays", "show", "blanks.rays", "--text"]), shown);
    let coarse = right(&folder, &["compare", "--rays", "f.rays", "--quick", "--verbose", "-s", "sah-kd"]);
    assert!(coarse.contains("Coarse") && coarse.contains("Torus"), "{coarse}");

    refuses(&folder, &["rays", "import", "rays.txt", "-o", "bad.rays", "--name", "a\nb"], &["control character"]);
    for (line, part) in [
        ("1,2,3 nan,0,1", "line 1: the ray"),
        ("0 0 1 0 0 -1\n\n0 0 0 0 -0 0", "line 3: the ray \"0 0 0 0 -0 0\" cannot hit anything: its direction is zero"),
        ("1 2 3 4 5 6 [2, 1] # back", "its interval is empty"),
        ("1,2 3,4,5", "line 1"),
        ("# none", "no ray"),
    ] {
        fs::write(folder.path().join("bad.txt"), line).unwrap();
        refuses(&folder, &["rays", "import", "bad.txt", "-o", "bad.rays"], &["bad.txt", part]);
        assert!(!folder.path().join("bad.rays").exists());
    }
    let bytes = fs::read(folder.path().join("f.rays")).unwrap();
    fs::write(folder.path().join("cut.rays"), &bytes[..bytes.len() - 3]).unwrap();
    refuses(&folder, &["rays", "show", "cut.rays"], &["cut.rays", "truncated"]);
}
