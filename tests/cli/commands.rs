//! Tests error messages, lists, help texts and standard output.

use super::command::{Folder, RIGHT, SQUARE, assert_contains, command, ends, output_texts, unwrapped};

#[test]
fn what_is_not_known_is_refused_with_what_is() {
    for (line, parts) in [
        ("compare sponsa", &["sponsa", "did you mean Sponza", "Cube", "Lucy"][..]),
        ("compare cube --structure octree", &["octree", "median-kd", "obvhs-bvh2"]),
        ("compare cube -s sah-hybird", &["sah-hybird", "did you mean sah-hybrid?"]),
        ("compare cube --reference obvh-bvh2", &["did you mean obvhs-bvh2?"]),
        ("compare cube --structure median-kd:leef=3", &["leef", "leaf, ", "threshold"]),
        ("compare cube -s sah-kd:leaf=abc", &["sah-kd", "leaf=abc", "integer of at least 0"]),
        (
            "compare cube -s sah-kd:mailbox=true,plane=sah-sweap",
            &["plane=sah-sweap", "did you mean sah-sweep?", "vertex-median, spatial-median"],
        ),
        ("compare cube --structure median-kd:leaf=0", &["leaf must be at least 1"]),
        ("compare cube --structure median-kd:leaf", &["key=value"]),
        ("compare cube -s sah-kd:test=woop", &["the triangle test \"woop\"", "exact, moller"]),
        ("study foo", &["foo", "compare", "attribution", "plan"]),
        ("compare icosphere:99", &["icosphere:99", "0 to 10"]),
        ("diff no/a.json no/b.json", &["no/a.json", "--export-json"]),
        ("render cube -o x.jpg", &["x.jpg", "PNG", ".png"]),
        ("compare cube --export-json - --export-csv -", &["two results"]),
        ("compare cube --export-json a.json --export-csv ./a.json", &["two results", "a.json"]),
        ("golden check my.toml", &["my.toml", "No such file"]),
        ("render cube -o x.png --hottest 10", &["--hottest", "--view heat"]),
        ("validate cube --against nothing", &["nothing", "brute-force"]),
        ("study accuracy cube --test woop", &["woop", "exact", "watertight"]),
        ("study accuracy cube -s obvhs-bvh2 -t watertight", &["sahara list"]),
        ("study accuracy cube --plot front.pdf", &["front.pdf", ".svg"]),
        ("list octree", &["octree", "median-kd", "scenes"]),
    ] {
        Folder::new().refuses_in_a_line(line, parts);
    }
    for (line, parts) in [
        ("compare cube --workload primry", &["primry", "did you mean primary?", "shadow"][..]),
        ("compare cube --threads 0", &["0"]),
        ("compare cube --budget -1", &["--budget", "-1", "give seconds from 0.001 to 86400"]),
        ("compare cube --quality best", &["best", "fast", "balanced", "high"]),
        ("frobnicate", &["frobnicate"]),
        ("study scaling --finest 11", &["11", "10"]),
        ("render cube", &["--output"]),
        ("render cube -o x.png --view pretty", &["pretty", "shaded", "heat"]),
        ("render cube -o x.png --view heat --hottest 0", &["--hottest", "0"]),
        ("render cube -o x.png --size 12", &["WIDTHxHEIGHT"]),
        ("validate cube --ray 1,2,3", &["ox,oy,oz dx,dy,dz"]),
        ("validate cube --ray '0,0,0 0,-0,0'", &["0,0,0 0,-0,0", "--ray", "direction is zero"]),
        ("validate cube --ray '0,0,0 1,0,0 [2,2]'", &["[2,2]", "--ray", "t_max above 0 and above t_min"]),
        ("study accuracy cube --workload edges", &["edges", "uniform, edge"]),
    ] {
        Folder::new().refuses(line, parts);
    }
    let foo = Folder::new().refuses("golden check foo", &["foo", "Cube, Sphere"]);
    assert!(!foo.contains("did you mean"), "{foo}");
}

#[test]
fn bad_files_are_named_and_what_cannot_be_written_is_refused_before_the_long_run() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("folder")).unwrap();
    folder.write("mesh.xyz", "");
    folder.write("range.obj", SQUARE.replace("f 1 2 3 4", "f 1 2 9"));
    folder.write(
        "cut.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n",
    );
    for (line, parts) in [
        ("compare no/such/mesh.obj", &["no/such/mesh.obj", "check that it exists"][..]),
        ("compare ./folder", &["this is a folder", ".glb", ".toml"]),
        ("compare mesh.xyz", &["mesh.xyz", ".obj, .ply, .gltf or .glb"]),
        ("validate range.obj", &["range.obj", "9"]),
        ("render cut.ply -o x.png", &["cut.ply"]),
        ("compare --export-json no/r.json", &["no/r.json"]),
        ("compare --export-json folder", &["directory"]),
        ("study attribution cube --export-json no/r.json", &["no/r.json"]),
        ("render cube -o no/r.json", &["no/r.json"]),
    ] {
        folder.refuses_in_a_line(line, parts);
    }
    assert_eq!(folder.names(), ["cut.ply", "folder", "mesh.xyz", "range.obj"]);
}

#[test]
fn lists_name_everything() {
    let names = "Cube Sponza teapot median-kd image-shadow heat moller-trumbore rt-triangle attribution";
    let list = Folder::new().shows("list", &names.split(' ').collect::<Vec<_>>());
    assert!(list.lines().count() < 24, "it fits a screen: {list}");
    let keys = ["threshold 0.7", "vertex-median, spatial-median", "split plane of a node", "exact, moller"];
    assert_contains(&unwrapped(&Folder::new().prints("list Median-KD")), &keys);
    for kind in ["scenes", "structures", "studies"] {
        Folder::new().prints(&format!("list {kind}"));
    }
    for line in ["--help", "--version", "compare --help", "completions man"] {
        let [text, messages] = ends(RIGHT, &mut command(line));
        assert!(messages.is_empty() && text.contains("sahara"), "{line}");
    }
}

#[test]
fn the_first_help_fits_a_screen_and_compare_has_a_short_help_and_a_whole_one_in_groups() {
    let help = |line: &str| {
        let [text, _] = ends(RIGHT, command(line).env("COLUMNS", "80"));
        text.lines().map(String::from).collect::<Vec<_>>()
    };
    for line in ["--help", "-h", "help"] {
        // A screen has 24 lines. The prompt needs one line.
        let lines = help(line);
        assert!(lines.len() < 24 && lines.iter().all(|line| line.chars().count() <= 80), "{line}: {lines:#?}");
        let examples = lines.iter().skip_while(|line| *line != "Examples:").skip(1);
        assert!(examples.clone().all(|line| line.starts_with("  sahara ")) && examples.count() >= 3, "{lines:#?}");
    }
    let options = |lines: &[String]| lines.iter().filter(|line| line.trim_start().starts_with('-')).count();
    let (short, long) = (help("compare -h"), help("compare --help"));
    assert!(short.len() <= 48 && (8..=12).contains(&options(&short)), "{short:#?}");
    assert!(options(&long) > 30, "{long:#?}");
    for heading in ["Scenes:", "Structures:", "Rays:", "Measuring:", "Output:", "Exit status:"] {
        assert!(long.iter().any(|line| line == heading), "{heading} is not in {long:#?}");
    }
    assert!(!short.iter().any(|line| line == "Exit status:"));
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
        ("study partitions cube --quick", ["", "sah-kd-tight"]),
        ("compare cube --save-baseline main", ["`--save-baseline` was removed; keep a run with", "sahara diff"]),
        ("compare cube --baseline=main", ["`--baseline` was removed", "sahara diff"]),
        ("accuracy --help", ["", "`sahara study accuracy`"]),
    ] {
        Folder::new().refuses_in_a_line(old, &new);
    }
}

#[test]
fn a_minus_stands_for_standard_output_and_case_does_not_matter() {
    // Standard output contains only the result. Messages go to standard error.
    let folder = Folder::new();
    for (line, magic, message) in [
        ("render CUBE -o - --view DEPTH -s Sah-KD:test=Exact --size 4x4", &b"\x89PNG"[..], "depth view of Cube"),
        ("rays record cube --workload PRIMARY --rays 4 -o -", b"SAHA", "4 rays"),
        ("compare cube --quick -s sah-kd -s sah-bvh --export-json -", b"{", "Cube: 12 triangles"),
    ] {
        let output = folder.command(line).output().unwrap();
        let messages = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(RIGHT), "{messages}");
        assert!(output.stdout.starts_with(magic) && messages.contains(message), "{line}: {messages}");
        if magic == b"{" {
            let [json, _] = output_texts(&output);
            let dataset: serde_json::Value = serde_json::from_str(&json).expect("JSON and nothing else");
            let structures = dataset["measured"][0]["epoch"]["structures"].as_array().unwrap();
            assert_eq!(structures.len(), 3, "two and a twin: {dataset}");
        }
    }
    assert!(folder.names().is_empty(), "a file of that name was made");
}
