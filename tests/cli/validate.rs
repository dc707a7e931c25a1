//! Tests `sahara validate`, including its hard cases.

use super::command::{Folder, RIGHT, SQUARE, WRONG, assert_contains, json, unwrapped};

#[test]
fn validation_tells_right_from_wrong() {
    Folder::new().prints("validate cube torus --rays 2000 -s median-kd -s sah-kd");

    // The direction component -0 causes obvhs-cwbvh to lose the hit.
    let validate =
        |structures: &str| Folder::new().prints(&format!("validate cube --ray '0.5,0.25,5 -0,0,-1' -s {structures}"));
    let defects = "obvhs-cwbvh: known defects (they do not change the exit status)";
    assert_contains(&validate("obvhs-cwbvh --verbose"), &[defects, "0.5,0.25,5.0 -0.0,0.0,-1.0"]);
    // The front face of the cube is at z = 1.
    let both = validate("sah-kd -s obvhs-cwbvh");
    let row = |name: &str| -> Vec<&str> {
        let mut rows = both.split("Cube: hits").nth(1).expect("a table of hits").lines();
        rows.find(|line| line.trim_start().starts_with(name)).expect("a row").split_whitespace().collect()
    };
    assert!(row("obvhs-cwbvh").ends_with(&["no", "hit"]), "{both}");
    let [.., t, triangle, u, v] = row("sah-kd")[..] else { panic!("{both}") };
    assert!(t == "4" && triangle.parse::<u32>().is_ok_and(|n| n < 12), "{both}");
    assert!([u, v].iter().all(|x| x.parse::<f64>().is_ok_and(|x| (0.0..=1.0).contains(&x))), "{both}");
    validate("sah-kd --against obvhs-bvh2");
}

/// The depth that `moller-trumbore-f64` computes is 115 ulps from the exact depth.
#[test]
fn validation_against_exact_answers_judges_depths_strictly() {
    let folder = Folder::new();
    let corners = "v -405851.38 785724.8 -466819.28\nv 405851.56 -785725.3 466820.28\nv 365266.44 -707152.8 420138.3\n";
    folder.write("needle.obj", format!("{corners}f 1 2 3\n"));
    let ray = "49.000397,-704.82355,176.40697 -9731.703,19450.404,-11313.292";
    for (test, status) in [("moller-trumbore-f64", WRONG), ("exact", RIGHT)] {
        let line = format!(
            "validate needle.obj --ray '{ray}' -s sah-kd:test={test} --against brute-force:test=exact --strict"
        );
        let [text, _] = folder.ends(status, &line);
        assert_eq!(unwrapped(&text).contains("115 ulps away"), status == WRONG, "{text}");
    }
}

#[test]
fn hard_cases_are_named_and_tell_what_each_structure_gets_wrong() {
    let near = ["flat_grasing", "flat_grazing_1e-3", "sahara list hard"];
    Folder::new().refuses_in_a_line("validate --hard flat_grasing", &near);
    Folder::new().refuses_in_a_line("validate --hard --test moeller", &["\"moeller\"", "moller-trumbore", "exact"]);
    Folder::new().shows("list hard", &["41 duplicates_20000: 200 rays\n", "84 limits: a property\n"]);

    let folder = Folder::new();
    let structures = "-s sah-kd -s obvhs-cwbvh --verbose --export-json r.json";
    let text = folder.prints(&format!("validate --hard cube_axis_negzero limits --rays 50 {structures}"));
    let row = text.lines().find(|line| line.trim_start().starts_with("cube_axis_negzero")).expect("a row");
    assert_eq!(unwrapped(row), "cube_axis_negzero . m 100 S 100");

    let run = json(folder.path("r.json"));
    let results = run["results"].as_array().unwrap();
    assert_eq!(results.len(), 4);
    let of = |case: &str, structure: &str| {
        results.iter().find(|r| r["case"] == case && r["structure"] == structure).expect("a record")
    };
    let lost = of("cube_axis_negzero", "obvhs-cwbvh");
    assert_eq!([&lost["missed"], &lost["structure_errors"]], [50, 50]);
    assert_eq!(of("cube_axis_negzero", "sah-kd")["clean"], true);
    assert_eq!(of("limits", "sah-kd")["property"]["broken"], 0);
    assert!(of("limits", "sah-kd")["rays"].is_null());

    Folder::new().shows(
        "validate --hard one_triangle --rays 20 --test exact --test edge-f64 -s median-kd --verbose",
        &["median-kd  median-kd:test=edge-f64"],
    );
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
        let text = Folder::new().prints(line);
        assert_eq!(text.matches(once).count(), 1, "{line}: {text}");
    }
}

#[test]
fn options_that_the_rays_asked_for_do_not_heed_are_refused() {
    for (option_in_use, unheeded) in [
        ("--hard limits -s sah-kd", &["--against sah-bvh", "--seed 2", "--inside", "--size 8x8"][..]),
        ("cube --ray '0,0,9 0,0,-1'", &["--rays 9", "--seed 2", "--inside", "--camera '0,0,5 0,0,0'"]),
        ("cube --adversarial", &["--inside", "--size 8x8", "--camera '0,0,5 0,0,0'"]),
        ("cube --hits a.hits --rays a.rays", &["--quality fast", "--limit 3"]),
        ("cube --export-hits a.hits --rays a.rays", &["--against sah-kd"]),
    ] {
        let option = option_in_use.split(' ').find(|word| word.starts_with("--")).unwrap();
        for unheeded in unheeded {
            let other = unheeded.split(' ').next().unwrap();
            Folder::new()
                .refuses(&format!("validate {option_in_use} {unheeded}"), &[option, other, "cannot be used with"]);
        }
    }
    // No message may advise `--inside` for rays that do not depend on the camera.
    let folder = Folder::new();
    folder.write("square.obj", SQUARE);
    for rays in ["--ray '0,0,9 0,0,-1'", "--adversarial --rays 20"] {
        let text = folder.prints(&format!("validate square.obj -s sah-kd {rays}"));
        assert!(!text.contains("--inside"), "{text}");
    }
}

/// The reference finds no hit, because Möller-Trumbore overflows on coordinates of 1e30.
#[test]
fn a_wrong_reference_is_no_error_of_a_triangle_test() {
    let folder = Folder::new();
    folder.write("huge.obj", "v 1e30 0 0\nv 1e30 1e30 0\nv 0 1e30 1e30\nf 1 2 3\n");
    let reference = "--against brute-force:test=moller-trumbore";
    let text = folder.prints(&format!("validate huge.obj -s sah-kd --rays 300 {reference} --verbose"));
    let row = text.lines().find(|line| line.contains("  sah-kd ")).unwrap();
    assert_eq!(unwrapped(row), "sah-kd exact 0 0 0 0 0 0 0 0", "{text}");
    assert_contains(&text, &["rays the reference is wrong, not sah-kd", "No ray hits anything in the reference"]);
}
