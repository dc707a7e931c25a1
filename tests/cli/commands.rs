//! Common properties of all commands: refusals, names, standard output; lists and completions.

use std::path::Path;

use super::command::{
    RIGHT, SQUARE, USAGE, at, command, ends, path_text, prints, refuses, refuses_in_a_line, sahara, small, stderr,
    unwrapped, words, write,
};

#[test]
#[cfg(target_os = "linux")]
fn messages_that_cannot_be_written_end_no_run() {
    let status = |args: &[&str]| {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        command(args).stderr(full).output().unwrap().status.code()
    };
    assert_eq!(status(&["compare", "cube", "-s", "sah-kd", "--quick"]), Some(RIGHT));
    assert_eq!(status(&["compare", "sponsa"]), Some(USAGE));
}

#[test]
fn what_is_not_known_is_refused_with_what_is() {
    refuses_in_a_line(&["compare", "sponsa"], &["sponsa", "did you mean Sponza", "Cube", "Lucy"]);
    refuses_in_a_line(&["compare", "cube", "--structure", "octree"], &["octree", "median-kd", "obvhs-bvh2"]);
    refuses_in_a_line(&["compare", "cube", "-s", "sah-hybird"], &["sah-hybird", "did you mean sah-hybrid?"]);
    refuses_in_a_line(&["compare", "cube", "--reference", "obvh-bvh2"], &["did you mean obvhs-bvh2?"]);
    let foo = refuses(&["golden", "check", "foo"], &["foo", "Cube, Sphere"]);
    assert!(!foo.contains("did you mean"), "{foo}");
    refuses_in_a_line(&["compare", "cube", "--structure", "median-kd:leef=3"], &["leef", "leaf, ", "threshold"]);
    refuses_in_a_line(&["compare", "cube", "-s", "sah-kd:leaf=abc"], &["sah-kd", "leaf=abc", "integer of at least 0"]);
    refuses_in_a_line(&["compare", "cube", "-s", "sah-kd:threshold=x"], &["threshold=x", "number"]);
    let plane = ["plane=sah-sweap", "did you mean sah-sweep?", "vertex-median, spatial-median"];
    refuses_in_a_line(&["compare", "cube", "-s", "sah-kd:mailbox=true,plane=sah-sweap"], &plane);
    refuses_in_a_line(&["compare", "cube", "--structure", "median-kd:leaf=0"], &["leaf must be at least 1"]);
    refuses_in_a_line(&["compare", "cube", "--structure", "median-kd:leaf"], &["key=value"]);
    refuses_in_a_line(&["compare", "cube", "-s", "sah-kd:test=woop"], &["the triangle test \"woop\"", "exact, moller"]);
    refuses(&["compare", "cube", "--workload", "primry"], &["primry", "did you mean primary?", "shadow"]);
    refuses(&["compare", "--frobnicate"], &["--frobnicate"]);
    refuses(&["compare", "cube", "--threads", "0"], &["0"]);
    for seconds in ["--budget", "--runner-limit"] {
        let sentence = "give seconds from 0.001 to 86400";
        refuses(&["compare", "cube", "--runner", "none", seconds, "-1"], &[seconds, "-1", sentence]);
    }
    refuses(&["compare", "cube", "--quality", "best"], &["best", "fast", "balanced", "high"]);
    refuses(&["frobnicate"], &["frobnicate"]);
    refuses_in_a_line(&["study", "foo"], &["foo", "compare", "attribution", "plan"]);
    refuses_in_a_line(&["study", "atribution", "cube"], &["did you mean attribution?"]);
    refuses(&["study", "scaling", "--finest", "11"], &["11", "10"]);
    refuses(&["study", "attribution", "cube", "--epochs", "0"], &["0"]);
    refuses_in_a_line(&["compare", "icosphere:99"], &["icosphere:99", "0 to 10"]);
    refuses_in_a_line(&["diff", "no/a.json", "no/b.json"], &["no/a.json", "--export-json"]);
    refuses(&["render", "cube"], &["--output"]);
    refuses(&["render", "cube", "-o", "x.png", "--view", "pretty"], &["pretty", "shaded", "heat"]);
    refuses(&["render", "cube", "-o", "x.png", "--view", "heta"], &["did you mean heat?"]);
    refuses_in_a_line(&["render", "cube", "-o", "x.jpg"], &["x.jpg", "PNG", ".png"]);
    refuses_in_a_line(&["compare", "cube", "--export-json", "-", "--export-csv", "-"], &["two results"]);
    for command in ["compare", "study accuracy"] {
        let twice = format!("{command} cube --export-json a.json --export-csv ./a.json");
        refuses_in_a_line(&words(&twice), &["two results", "a.json"]);
    }
    refuses_in_a_line(&["golden", "check", "my.toml"], &["my.toml", "No such file"]);
    refuses_in_a_line(&["render", "cube", "-o", "x.png", "--hottest", "10"], &["--hottest", "--view heat"]);
    refuses(&["render", "cube", "-o", "x.png", "--view", "heat", "--hottest", "0"], &["--hottest", "0"]);
    refuses(&["render", "cube", "-o", "x.png", "--size", "12"], &["WIDTHxHEIGHT"]);
    refuses(&["validate", "cube", "--ray", "1,2,3"], &["ox,oy,oz dx,dy,dz"]);
    for (ray, fault) in [
        ("0,0,0 0,-0,0", "direction is zero"),
        ("0,0,0 1,0,0 [2,2]", "t_max above 0 and above t_min"),
        ("0,0,0 1,0,0 [-2,0]", "t_max above 0 and above t_min"),
    ] {
        refuses(&["validate", "cube", "--ray", ray], &[ray, "--ray", fault]);
    }
    refuses_in_a_line(&["validate", "cube", "--against", "nothing"], &["nothing", "brute-force"]);
    refuses_in_a_line(&["study", "accuracy", "cube", "--test", "woop"], &["woop", "exact", "watertight"]);
    refuses_in_a_line(&["study", "accuracy", "cube", "-s", "obvhs-bvh2", "-t", "watertight"], &["sahara list"]);
    refuses_in_a_line(&["study", "accuracy", "cube", "--plot", "front.pdf"], &["front.pdf", ".svg"]);
    refuses_in_a_line(&["study", "accuracy", "cube", "--plot", "no/such/front.svg"], &["no/such/front.svg"]);
    refuses(&["study", "accuracy", "cube", "--workload", "edges"], &["edges", "uniform, edge"]);
}

#[test]
fn bad_files_are_named_with_the_place_of_the_fault() {
    let directory = tempfile::tempdir().unwrap();
    refuses_in_a_line(&["compare", "no/such/mesh.obj"], &["no/such/mesh.obj", "check that it exists"]);
    refuses_in_a_line(&["compare", &path_text(directory.path())], &["this is a folder", ".glb", ".toml"]);
    let unknown = write(&directory, "mesh.xyz", "");
    refuses_in_a_line(&["compare", &unknown], &["mesh.xyz", ".obj, .ply, .gltf or .glb"]);
    let range = write(&directory, "range.obj", &SQUARE.replace("f 1 2 3 4", "f 1 2 9"));
    refuses_in_a_line(&["validate", &range], &["range.obj", "9"]);
    let cut = write(
        &directory,
        "cut.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n",
    );
    refuses_in_a_line(&["render", &cut, "-o", &at(&directory, "x.png")], &["cut.ply"]);
    assert!(!directory.path().join("x.png").exists());
}

#[test]
fn what_cannot_be_written_is_refused_before_the_long_run() {
    let directory = tempfile::tempdir().unwrap();
    let missing = at(&directory, "no/r.json");
    for flag in ["--export-json", "--export-csv", "--export-markdown"] {
        refuses_in_a_line(&["compare", flag, &missing], &["no/r.json"]);
    }
    refuses_in_a_line(&["compare", "--export-json", &path_text(directory.path())], &["directory"]);
    refuses_in_a_line(&["study", "attribution", "cube", "--export-json", &missing], &["no/r.json"]);
    refuses_in_a_line(&["render", "cube", "-o", &missing], &["no/r.json"]);
}

#[test]
fn lists_and_completions_name_everything() {
    let list = prints(&["list"]);
    for name in words("Cube Sponza teapot median-kd image-shadow heat moller-trumbore rt-triangle attribution") {
        assert!(list.contains(name), "{name} is not in {list}");
    }
    assert!(list.lines().count() < 24, "it fits a screen: {list}");
    let keys = prints(&["list", "Median-KD"]);
    for words in ["threshold 0.7", "vertex-median, spatial-median", "split plane of a node", "exact, moller"] {
        assert!(unwrapped(&keys).contains(words), "{words} is not in {keys}");
    }
    refuses_in_a_line(&["list", "octree"], &["octree", "median-kd", "scenes"]);
    for kind in ["scenes", "structures", "studies"] {
        prints(&["list", kind]);
    }
    assert!(prints(&["completions", "zsh"]).contains("attribution"));
    for line in ["--help", "--version", "compare --help", "completions man"] {
        let (text, messages) = ends(RIGHT, &mut command(&words(line)));
        assert!(messages.is_empty() && text.contains("sahara"), "{line}");
    }
}

/// The lines of a help on a screen of 80 columns.
fn help(line: &str) -> Vec<String> {
    ends(RIGHT, command(&words(line)).env("COLUMNS", "80")).0.lines().map(String::from).collect()
}

#[test]
fn the_first_help_fits_a_screen_with_its_prompt_and_ends_with_examples() {
    for line in ["--help", "-h", "help"] {
        let lines = help(line);
        assert!(lines.len() < 24 && lines.iter().all(|line| line.chars().count() <= 80), "{line}: {lines:#?}");
        let examples = lines.iter().skip_while(|line| *line != "Examples:").skip(1);
        assert!(examples.clone().all(|line| line.starts_with("  sahara ")) && examples.count() >= 3, "{lines:#?}");
    }
}

#[test]
fn compare_has_a_short_help_and_a_whole_one_in_groups() {
    let options = |lines: &[String]| lines.iter().filter(|line| line.trim_start().starts_with('-')).count();
    let (short, long) = (help("compare -h"), help("compare --help"));
    assert!(short.len() <= 48 && (8..=12).contains(&options(&short)), "{short:#?}");
    assert!(options(&long) > 30, "{long:#?}");
    for heading in ["Scenes:", "Structures:", "Rays:", "Measuring:", "Output:"] {
        assert!(long.iter().any(|line| line == heading), "{heading} is not in {long:#?}");
    }
    assert!(long.iter().any(|line| line == "Exit status:") && !short.iter().any(|line| line == "Exit status:"));
}

#[test]
fn old_names_are_answered_with_the_new_ones() {
    for (old, new) in [
        ("bench", ["`bench` was removed; use `sahara", "--fail-on-regression"]),
        ("hard cube", ["", "validate --hard"]),
        ("compare-runs a b", ["", "diff"]),
        ("counts cube", ["", "compare --wide"]),
        ("study counts", ["`counts` was removed", "compare --wide"]),
        ("study predictions", ["`predictions` was removed", "study all"]),
        ("study crossover", ["", "sahara compare"]),
        ("study partitions cube --quick", ["", "sah-kd-tight"]),
        ("study plan threads", ["", "--threads"]),
        ("compare cube --save-baseline main", ["`--save-baseline` was removed; keep a run with", "sahara diff"]),
        ("compare cube --baseline=main", ["`--baseline` was removed", "sahara diff"]),
    ] {
        refuses_in_a_line(&words(old), &new);
    }
    refuses_in_a_line(&["accuracy", "--help"], &["`sahara study accuracy`"]);
}

#[test]
fn a_minus_stands_for_standard_output_and_case_does_not_matter() {
    // Standard output has only the result; messages for people have another place.
    for (line, magic, said) in [
        ("render CUBE -o - --view DEPTH -s Sah-KD:test=Exact --size 4x4", b"\x89PNG", "depth view of Cube"),
        ("rays record cube --workload PRIMARY --rays 4 -o -", b"SAHA", "4 rays"),
    ] {
        let output = sahara(&words(line));
        assert_eq!(output.status.code(), Some(RIGHT), "{}", stderr(&output));
        assert!(output.stdout.starts_with(magic) && stderr(&output).contains(said), "{}", stderr(&output));
    }
    let json = sahara(&[&small("cube")[..], &["-s", "sah-kd", "-s", "sah-bvh", "--export-json", "-"]].concat());
    let dataset: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON and nothing else");
    assert_eq!(dataset["measured"][0]["epoch"]["structures"].as_array().unwrap().len(), 3, "two and a twin: {dataset}");
    assert!(stderr(&json).contains("Cube: 12 triangles"));
    assert!(!Path::new("-").exists(), "a file of that name was made");
}
