//! `sahara validate`, including its hard cases.

use super::command::{
    RIGHT, SQUARE, WRONG, at, command, ends, json, prints, refuses, refuses_in_a_line, unwrapped, words, write,
};

#[test]
fn validation_tells_right_from_wrong() {
    prints(&["validate", "cube", "torus", "--rays", "2000", "-s", "median-kd", "-s", "sah-kd"]);

    // obvhs' CwBvh misses every ray with a component of -0.0: this one hits the cube in the middle of a face.
    let ray = ["validate", "cube", "--ray", "0.5,0.25,5 -0,0,-1", "-s"];
    // A known defect of a baseline is printed with its name, and does not change the status of any command.
    let printed = prints(&[&ray[..], &["obvhs-cwbvh", "--verbose"]].concat());
    assert!(printed.contains("obvhs-cwbvh: known defects (they do not change the exit status)"), "{printed}");
    assert!(printed.contains("0.5,0.25,5.0 -0.0,0.0,-1.0"), "the ray can be asked again: {printed}");
    // The hit of each structure is printed, right or wrong: the cube's front face is at z = 1.
    let both = prints(&[&ray[..], &["sah-kd", "-s", "obvhs-cwbvh"]].concat());
    let row = |name: &str| -> Vec<String> {
        let answers = both.split("Cube: hits").nth(1).expect("a table of hits");
        let row = answers.lines().find(|line| line.trim_start().starts_with(name)).expect("a row");
        row.split_whitespace().map(String::from).collect()
    };
    assert!(row("obvhs-cwbvh").ends_with(&["no".into(), "hit".into()]), "{both}");
    let right = row("sah-kd");
    let [t, triangle, u, v] = &right[right.len() - 4..] else { panic!("{right:?}") };
    assert!(t == "4" && triangle.parse::<u32>().is_ok_and(|n| n < 12), "{right:?}");
    assert!([u, v].iter().all(|x| x.parse::<f64>().is_ok_and(|x| (0.0..=1.0).contains(&x))), "{right:?}");
    prints(&[&ray[..], &["sah-kd", "--against", "obvhs-bvh2"]].concat());
}

/// A ray grazes along a needle: the depth in `f64` is wrong by 115 ulps, which is not an error of 1 %.
#[test]
fn validation_against_exact_answers_judges_depths_strictly() {
    let directory = tempfile::tempdir().unwrap();
    let corners = "v -405851.38 785724.8 -466819.28\nv 405851.56 -785725.3 466820.28\nv 365266.44 -707152.8 420138.3\n";
    let mesh = write(&directory, "needle.obj", &format!("{corners}f 1 2 3\n"));
    let ray = "49.000397,-704.82355,176.40697 -9731.703,19450.404,-11313.292";
    for (structure, status) in [("sah-kd:test=moller-trumbore-f64", WRONG), ("sah-kd:test=exact", RIGHT)] {
        let strict = ["--against", "brute-force:test=exact", "--strict"];
        let args = [&["validate", &mesh, "--ray", ray, "-s", structure], &strict[..]].concat();
        let text = unwrapped(&ends(status, &mut command(&args)).0);
        assert_eq!(text.contains("115 ulps away"), status == WRONG, "{text}");
    }
}

#[test]
fn hard_cases_are_named_and_tell_what_each_structure_gets_wrong() {
    let near = ["flat_grasing", "flat_grazing_1e-3", "sahara list hard"];
    refuses_in_a_line(&["validate", "--hard", "flat_grasing"], &near);
    refuses_in_a_line(&["validate", "--hard", "--test", "moeller"], &["\"moeller\"", "moller-trumbore", "exact"]);
    let list = prints(&["list", "hard"]);
    assert!(list.contains("41 duplicates_20000: 200 rays\n") && list.contains("84 limits: a property\n"), "{list}");

    let directory = tempfile::tempdir().unwrap();
    let export = at(&directory, "hard.json");
    let hard = "validate --hard cube_axis_negzero limits --rays 50 -s sah-kd -s obvhs-cwbvh --verbose --export-json";
    // Known defects of a baseline do not fail the run.
    let text = prints(&[words(hard), vec![&export]].concat());
    let row = text.lines().find(|line| line.trim_start().starts_with("cube_axis_negzero")).expect("a row");
    assert_eq!(row.split_whitespace().collect::<Vec<_>>(), ["cube_axis_negzero", ".", "m", "100", "S", "100"]);

    let run = json(&export);
    let results = run["results"].as_array().unwrap();
    assert_eq!(results.len(), 4);
    let of = |case: &str, structure: &str| {
        results.iter().find(|r| r["case"] == case && r["structure"] == structure).expect("a record").clone()
    };
    let lost = of("cube_axis_negzero", "obvhs-cwbvh");
    assert_eq!((lost["missed"].as_u64(), lost["structure_errors"].as_u64()), (Some(50), Some(50)));
    assert_eq!(of("cube_axis_negzero", "sah-kd")["clean"], true);
    assert_eq!(of("limits", "sah-kd")["property"]["broken"], 0);
    assert!(of("limits", "sah-kd")["rays"].is_null());

    // They run over the requested tests.
    let tests = "--test exact --test edge-f64 -s median-kd --verbose";
    let text = prints(&words(&format!("validate --hard one_triangle --rays 20 {tests}")));
    assert!(text.contains("median-kd  median-kd:test=edge-f64"), "{text}");
}

#[test]
fn what_is_named_twice_counts_once() {
    for (line, once) in [
        ("validate cube Cube --rays 100 -s sah-kd", "12 triangles"),
        ("validate --hard limits limits -s sah-kd --verbose", " limits+ "),
        ("validate --hard one_triangle -s sah-kd -t exact -t EXACT --verbose", "\n  sah-kd "),
        ("compare cube -w primary -w primary --quick -s sah-kd --export-csv -", "\nCube,"),
        ("golden check cube Cube", "Cube: "),
    ] {
        let text = prints(&words(line));
        assert_eq!(text.matches(once).count(), 1, "{line}: {text}");
    }
}

#[test]
fn options_that_the_rays_asked_for_do_not_heed_are_refused() {
    let ray = ["--ray", "0,0,9 0,0,-1"];
    let hard = ["--hard", "limits", "-s", "sah-kd"];
    for (asked, unheeded) in [
        (&hard[..], &[&["--against", "sah-bvh"][..], &["--seed", "2"], &["--inside"], &["--size", "8x8"]][..]),
        (&ray, &[&["--rays", "9"], &["--seed", "2"], &["--inside"], &["--camera", "0,0,5 0,0,0"]]),
        (&["--adversarial"], &[&["--inside"], &["--size", "8x8"], &["--camera", "0,0,5 0,0,0"]]),
        (&["--hits", "a.hits", "--rays", "a.rays"], &[&["--quality", "fast"], &["--limit", "3"]]),
        (&["--export-hits", "a.hits", "--rays", "a.rays"], &[&["--against", "sah-kd"]]),
    ] {
        for unheeded in unheeded {
            let scene = if asked[0] == "--hard" { &[][..] } else { &["cube"] };
            refuses(&[&["validate"], scene, asked, unheeded].concat(), &[asked[0], unheeded[0], "cannot be used with"]);
        }
    }
    // These rays do not depend on the camera, so there is no advice about it.
    let directory = tempfile::tempdir().unwrap();
    let mesh = write(&directory, "square.obj", SQUARE);
    for rays in [&ray[..], &["--adversarial", "--rays", "20"]] {
        let text = prints(&[&["validate", &mesh, "-s", "sah-kd"], rays].concat());
        assert!(!text.contains("--inside"), "{text}");
    }
}

/// Möller-Trumbore overflows on such a large triangle, and finds none of its hits.
#[test]
fn a_wrong_reference_is_no_error_of_a_triangle_test() {
    let directory = tempfile::tempdir().unwrap();
    let huge = write(&directory, "huge.obj", "v 1e30 0 0\nv 1e30 1e30 0\nv 0 1e30 1e30\nf 1 2 3\n");
    let reference = "brute-force:test=moller-trumbore";
    let text = prints(&words(&format!("validate {huge} -s sah-kd --rays 300 --against {reference} --verbose")));
    let row: Vec<&str> = text.lines().find(|line| line.contains("  sah-kd ")).unwrap().split_whitespace().collect();
    assert_eq!(row, ["sah-kd", "exact", "0", "0", "0", "0", "0", "0", "0", "0"], "{text}");
    assert!(text.contains("rays the reference is wrong, not sah-kd"), "{text}");
    assert!(text.contains("The reference hits nothing"), "{text}");
}
