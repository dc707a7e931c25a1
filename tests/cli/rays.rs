//! Files of rays and hits from outside: recorded rays are replayed to the bit, and damaged files are rejected.

use std::fs;
use std::process::Command;

use tempfile::TempDir;

use super::command::{RIGHT, WRONG, at, command, ends, refused_in_a_line, words, write};
use super::journal::rows;

fn sahara(folder: &TempDir, line: &str) -> Command {
    let mut command = command(&words(line));
    command.current_dir(folder);
    command
}

/// The output of the command; it must succeed.
#[track_caller]
fn right(folder: &TempDir, line: &str) -> String {
    ends(RIGHT, &mut sahara(folder, line)).0
}

/// Checks that the command rejects in one line that contains all of `parts`.
#[track_caller]
fn refuses(folder: &TempDir, line: &str, parts: &[&str]) {
    refused_in_a_line(&sahara(folder, line).output().unwrap(), parts);
}

#[test]
fn a_replayed_workload_is_the_workload() {
    let folder = tempfile::tempdir().unwrap();
    let common = "--runs 2 --budget 2 -s sah-kd -s brute-force";
    for kind in ["diffuse", "shadow"] {
        let printed = right(&folder, &format!("rays record torus -w {kind} -o f.rays"));
        // The number of timed rays does not change the workload.
        right(&folder, &format!("compare torus -w {kind} --rays 900 --export-json made.json {common}"));
        right(&folder, &format!("compare --rays f.rays --export-json replayed.json {common}"));
        let [made, replayed] = ["made.json", "replayed.json"].map(|name| rows(at(&folder, name)));
        assert_eq!((made.len(), replayed.len()), (2, 2));
        for (made, replayed) in made.iter().zip(&replayed) {
            for field in ["scene", "scene_hash", "workload", "query", "hash", "all"] {
                assert_eq!(made[field], replayed[field], "{kind} {field}");
            }
            assert_eq!(made["counts"]["hits"], replayed["counts"]["hits"], "{kind}");
            assert!(printed.contains(made["hash"].as_str().unwrap()), "{printed}");
        }
    }
    right(&folder, "rays record torus -w shadow -o f.rays --rays 900");
    right(&folder, "validate --rays f.rays -s sah-kd");
    let printed = right(&folder, "study accuracy torus --rays f.rays -s sah-kd:test=exact --runs 1");
    assert!(printed.contains("rays of a file"), "{printed}");
}

#[test]
fn answers_go_out_and_come_back_and_wrong_ones_are_found() {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["primary", "shadow"] {
        right(&folder, &format!("rays record torus -w {kind} -o f.rays --rays 900"));
        right(&folder, "validate --rays f.rays -s sah-kd --export-hits f.hits");
        let [own, exact] = ["", " --test exact"].map(|test| format!("validate --rays f.rays --hits f.hits{test}"));
        let same = right(&folder, &exact);
        assert!(same.contains("against brute force with exact"), "{same}");
        let text = right(&folder, &own);
        assert!(text.contains("f.hits is right on 900 rays."), "{text}");

        // Remove one hit.
        let path = folder.path().join("f.hits");
        let mut bytes = fs::read(&path).unwrap();
        let hit = bytes[32..].chunks_exact(8).position(|answer| answer[4..] != [0xff; 4]).unwrap();
        bytes[32 + 8 * hit + 4..32 + 8 * hit + 8].fill(0xff);
        fs::write(&path, bytes).unwrap();
        for line in [&exact, &own] {
            let (text, _) = ends(WRONG, &mut sahara(&folder, line));
            assert!(text.contains("lost on ray \""), "{text}");
        }
    }
    right(&folder, "rays record torus -o g.rays --rays 500");
    for (line, parts) in [
        ("validate torus --hits f.hits", &["--rays F.rays"][..]),
        ("validate --rays f.rays --export-hits g.hits", &["--structure"]),
        ("validate --rays f.hits", &["f.hits", "SAHARAYS"]),
        ("validate --rays f.rays --hits f.rays", &["f.rays", "SAHAHITS"]),
        ("validate --rays g.rays --hits f.hits", &["f.hits", "hash"]),
    ] {
        refuses(&folder, line, parts);
    }
}

#[test]
fn rays_of_a_mesh_file_ask_for_it_and_nothing_that_is_read_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let (mesh, text) = ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "0,0,1 0,0,-1\n");
    write(&folder, "mine.obj", mesh);
    write(&folder, "rays.txt", text);
    right(&folder, "rays record mine.obj -o f.rays --rays 100");
    refuses(&folder, "validate --rays f.rays", &["f.rays", "\"mine\"", "scene file"]);
    right(&folder, "validate mine.obj --rays f.rays -s sah-kd");

    let now = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let rays = now("f.rays");
    for line in [
        "rays record mine.obj -o mine.obj",
        "rays import rays.txt -o rays.txt",
        "rays import rays.txt --scene mine.obj -o ./mine.obj",
        "render mine.obj -o mine.obj",
        "validate mine.obj --rays f.rays -s sah-kd --export-hits f.rays",
        "validate mine.obj --rays f.rays -s sah-kd --export-hits mine.obj",
        "compare mine.obj --rays f.rays -s sah-kd --export-csv f.rays",
        "study accuracy mine.obj --rays f.rays -s sah-kd --export-json mine.obj",
    ] {
        refuses(&folder, line, &["an input file"]);
    }
    assert!(now("mine.obj") == mesh.as_bytes() && now("rays.txt") == text.as_bytes() && now("f.rays") == rays);
}

#[test]
fn text_becomes_rays_and_rays_become_text() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder, "rays.txt", "# two rays\n0,0,5 0,0,-1\n\n0.5,0,5 0,0,-1 [0.25,7.0] # bounded\n");
    right(&folder, "rays import rays.txt -o f.rays --scene torus");
    let shown = right(&folder, "rays show f.rays");
    assert!(shown.contains("2 rays") && shown.contains("Torus") && shown.contains("closest"), "{shown}");
    let shown = right(&folder, "rays show f.rays --text");
    assert_eq!(shown, "0.0,0.0,5.0 0.0,0.0,-1.0\n0.5,0.0,5.0 0.0,0.0,-1.0 [0.25,7.0]\n");
    right(&folder, "validate --rays f.rays -s sah-kd");
    right(&folder, "rays import rays.txt -o free.rays --any");
    right(&folder, "validate cube --rays free.rays -s sah-kd");
    let coarse = right(&folder, "compare --rays f.rays --quick --verbose -s sah-kd");
    assert!(coarse.contains("Coarse") && coarse.contains("Torus"), "{coarse}");
    for (line, parts) in [
        ("validate cube --rays f.rays", &["Torus", "Cube", "hash"][..]),
        ("validate cube torus --rays f.rays", &["one scene"]),
        ("compare --rays f.rays -w primary", &["--workload"]),
        ("compare --rays no.rays", &["no.rays", "check that it exists"]),
        ("validate --rays free.rays", &["names no scene"]),
        ("rays import rays.txt -o bad.rays --name a\nb", &["control character"]),
    ] {
        refuses(&folder, line, parts);
    }
    for (text, part) in [
        ("1,2,3 nan,0,1", "line 1: the ray"),
        ("0 0 1 0 0 -1\n\n0 0 0 0 -0 0", "line 3: the ray \"0 0 0 0 -0 0\" cannot hit anything: its direction is zero"),
        ("1 2 3 4 5 6 [2, 1] # back", "its interval is empty"),
        ("# none", "no ray"),
    ] {
        write(&folder, "bad.txt", text);
        refuses(&folder, "rays import bad.txt -o bad.rays", &["bad.txt", part]);
    }
    assert!(!folder.path().join("bad.rays").exists());
}
