//! Tests files of rays and hits.

use std::fs;

use super::command::{Folder, WRONG};
use super::journal::rows;

#[test]
fn a_replayed_workload_is_the_workload() {
    let folder = Folder::new();
    let common = "--runs 2 --budget 2 -s sah-kd -s brute-force";
    for kind in ["diffuse", "shadow"] {
        let printed = folder.prints(&format!("rays record torus -w {kind} -o f.rays"));
        // `--rays` of `compare` limits only the number of timed rays.
        folder.prints(&format!("compare torus -w {kind} --rays 900 --export-json made.json {common}"));
        folder.prints(&format!("compare --rays f.rays --export-json replayed.json {common}"));
        let [made, replayed] = ["made.json", "replayed.json"].map(|name| rows(folder.path(name)));
        assert_eq!((made.len(), replayed.len()), (2, 2));
        for (made, replayed) in made.iter().zip(&replayed) {
            for field in ["scene", "scene_hash", "workload", "query", "hash", "all"] {
                assert_eq!(made[field], replayed[field], "{kind} {field}");
            }
            assert_eq!(made["counts"]["hits"], replayed["counts"]["hits"], "{kind}");
            assert!(printed.contains(made["hash"].as_str().unwrap()), "{printed}");
        }
    }
    folder.prints("rays record torus -w shadow -o f.rays --rays 900");
    folder.prints("validate --rays f.rays -s sah-kd");
    folder.shows("study accuracy torus --rays f.rays -s sah-kd:test=exact --runs 1", &["rays of a file"]);
}

#[test]
fn answers_go_out_and_come_back_and_wrong_ones_are_found() {
    let folder = Folder::new();
    let [own, exact] = ["", " --test exact"].map(|test| format!("validate --rays f.rays --hits f.hits{test}"));
    for kind in ["primary", "shadow"] {
        folder.prints(&format!("rays record torus -w {kind} -o f.rays --rays 900"));
        folder.prints("validate --rays f.rays -s sah-kd --export-hits f.hits");
        folder.shows(&exact, &["against brute force with exact"]);
        folder.shows(&own, &["f.hits is right on 900 rays."]);

        // Replace one hit with a miss.
        let mut bytes = fs::read(folder.path("f.hits")).unwrap();
        let hit = bytes[32..].chunks_exact_mut(8).find(|hit| hit[4..] != [0xff; 4]).unwrap();
        hit[4..].fill(0xff);
        folder.write("f.hits", bytes);
        for line in [&exact, &own] {
            let [text, _] = folder.ends(WRONG, line);
            assert!(text.contains("lost on ray \""), "{text}");
        }
    }
    folder.prints("rays record torus -o g.rays --rays 500");
    for (line, parts) in [
        ("validate torus --hits f.hits", &["--rays F.rays"][..]),
        ("validate --rays f.rays --export-hits g.hits", &["--structure"]),
        ("validate --rays f.hits", &["f.hits", "SAHARAYS"]),
        ("validate --rays f.rays --hits f.rays", &["f.rays", "SAHAHITS"]),
        ("validate --rays g.rays --hits f.hits", &["f.hits", "hash"]),
    ] {
        folder.refuses_in_a_line(line, parts);
    }
}

#[test]
fn rays_of_a_mesh_file_ask_for_it_and_nothing_that_is_read_is_written() {
    let folder = Folder::new();
    folder.write("mine.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("rays.txt", "0,0,1 0,0,-1\n");
    folder.prints("rays record mine.obj -o f.rays --rays 100");
    folder.refuses_in_a_line("validate --rays f.rays", &["f.rays", "\"mine\"", "scene file"]);
    folder.prints("validate mine.obj --rays f.rays -s sah-kd");

    let all = || ["mine.obj", "rays.txt", "f.rays"].map(|name| fs::read(folder.path(name)).unwrap());
    let before = all();
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
        folder.refuses_in_a_line(line, &["an input file"]);
    }
    assert!(all() == before);
}

#[test]
fn text_becomes_rays_and_rays_become_text() {
    let folder = Folder::new();
    folder.write("rays.txt", "# two rays\n0,0,5 0,0,-1\n\n0.5,0,5 0,0,-1 [0.25,7.0] # bounded\n");
    folder.prints("rays import rays.txt -o f.rays --scene torus");
    folder.shows("rays show f.rays", &["2 rays", "Torus", "closest"]);
    let shown = folder.prints("rays show f.rays --text");
    assert_eq!(shown, "0.0,0.0,5.0 0.0,0.0,-1.0\n0.5,0.0,5.0 0.0,0.0,-1.0 [0.25,7.0]\n");
    folder.prints("validate --rays f.rays -s sah-kd");
    folder.prints("rays import rays.txt -o free.rays --any");
    folder.prints("validate cube --rays free.rays -s sah-kd");
    folder.shows("compare --rays f.rays --quick --verbose -s sah-kd", &["Coarse", "Torus"]);
    for (line, parts) in [
        ("validate cube --rays f.rays", &["Torus", "Cube", "hash"][..]),
        ("validate cube torus --rays f.rays", &["one scene"]),
        ("compare --rays f.rays -w primary", &["--workload"]),
        ("compare --rays no.rays", &["no.rays", "check that it exists"]),
        ("validate --rays free.rays", &["names no scene"]),
        ("rays import rays.txt -o bad.rays --name 'a\nb'", &["control character"]),
    ] {
        folder.refuses_in_a_line(line, parts);
    }
    for (text, part) in [
        ("1,2,3 nan,0,1", "line 1: the ray"),
        ("0 0 1 0 0 -1\n\n0 0 0 0 -0 0", "line 3: the ray \"0 0 0 0 -0 0\" cannot hit anything: its direction is zero"),
        ("1 2 3 4 5 6 [2, 1] # back", "its interval is empty"),
        ("# none", "no ray"),
    ] {
        folder.write("bad.txt", text);
        folder.refuses_in_a_line("rays import bad.txt -o bad.rays", &["bad.txt", part]);
    }
    assert!(!folder.path("bad.rays").exists());
}
