//! Tests a crate that adds structures and a study to the suite.

use std::fs;
use std::process::{Command, ExitCode, Stdio};
use std::time::Duration;

use sahara::cli::Suite;
use sahara::geometry::Ray;
use sahara::measure::SystemClock;
use sahara::study::Studies;
use sahara::validate::conformance::{Named, Subject, answers, counting, shapes};
use sahara::validate::hard_cases::{CaseTruth, find, run};
use sahara::validate::{degenerate_meshes, stacked_sheets};
use serde_json::Value;
use third_party_structures::broken::{Broken, BrokenConfig, Fault, picks};
use third_party_structures::faulty::{self, Faulty, FaultyConfig};
use third_party_structures::question::DUPLICATION;
use third_party_structures::registry;

use crate::cli::command::{Folder, assert_contains, output_texts, unwrapped};
use crate::cli::journal::rows;

fn meshes() -> Vec<Named> {
    let wanted = ["closed sphere", "soup", "nested shells", "crossing needles", "same centroid"];
    degenerate_meshes().into_iter().filter(|(name, _)| wanted.contains(&name.as_str())).collect()
}

#[test]
fn the_grid_that_the_broken_ones_are_made_from_is_right_and_what_is_declined_is_not_asked() {
    let [broken, modest] = ["broken", "modest"].map(|name| registry().choose(name).unwrap().subject());
    answers(&broken, &meshes(), 60).unwrap();
    answers(&modest, &meshes(), 60).unwrap();
    counting(&modest, &meshes(), 10).unwrap();
    shapes(&modest, &meshes()).unwrap();
}

#[test]
fn what_hangs_is_given_up_and_told_from_what_panics() {
    // On one triangle, only a hang can reach the time limit.
    let one: Vec<Named> = degenerate_meshes().into_iter().filter(|(name, _)| name == "one triangle").collect();
    let subject =
        |fault| Subject { limit: Duration::from_secs(2), ..Subject::of::<Broken>("broken", BrokenConfig { fault }) };
    let unbuilt = "does not build over \"one triangle\": it";
    for (report, parts) in [
        (answers(&subject(Fault::Hangs), &one, 200), ["worst: hangs on ray \"", "no result within 2s"]),
        (counting(&subject(Fault::Hangs), &one, 2000), ["it hangs", "tracing ray \""]),
        (answers(&subject(Fault::BuilderPanics), &one, 1), [unbuilt, "panics: the message is \"no triangle"]),
        (answers(&subject(Fault::BuilderHangs), &one, 1), [unbuilt, "it hangs"]),
        (shapes(&subject(Fault::BuilderHangs), &one), [unbuilt, "it hangs"]),
    ] {
        let report = report.unwrap_err();
        assert_contains(&report, &parts);
        let named: Option<Ray> = report.split('"').find_map(|part| part.parse().ok());
        assert_eq!(named.map(|ray| picks(&ray, 500)), report.contains("ray \"").then_some(true), "{report}");
    }
}

/// The fault `OverflowedStack` occurs only in deep trees.
#[test]
fn a_short_stack_is_found_by_stacked_sheets() {
    let of = |fault| answers(&Subject::of::<Faulty>("mybvh", FaultyConfig { fault }), &stacked_sheets(), 10);
    of(faulty::Fault::None).unwrap();
    assert!(of(faulty::Fault::OverflowedStack).unwrap_err().contains("8192 stacked sheets"));
}

/// The tests below run this function as a command in a separate process.
#[test]
fn command() {
    let Some(args) = std::env::var_os("SAHARA_THIRD_PARTY") else { return };
    let args = args.into_string().unwrap();
    // The built-in studies take minutes, so `study all` and `report` include only `DUPLICATION`.
    let all = args.starts_with("study all") || args.starts_with("report");
    let studies = if all { Studies::empty() } else { Studies::builtin() };
    let suite = Suite { registry: registry(), studies: studies.with(DUPLICATION) };
    let words = shlex::split(&args).unwrap();
    let status = sahara::cli::run(&suite, ["sahara".into()].into_iter().chain(words).map(Into::into));
    std::process::exit(if status == ExitCode::SUCCESS { 0 } else { 42 });
}

fn sahara(folder: &Folder, args: &str) -> (String, bool) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command
        .args(["--exact", "third_party::command", "--nocapture", "--test-threads=1"])
        .env("SAHARA_THIRD_PARTY", args)
        .env_remove("SAHARA_DATA")
        .current_dir(folder.path(""))
        .stdin(Stdio::null());
    let output = command.output().unwrap();
    let printed = output_texts(&output).concat();
    assert!(matches!(output.status.code(), Some(0 | 42)), "{args}: {printed}");
    (printed, output.status.code() == Some(0))
}

#[track_caller]
fn content(folder: &Folder, args: &str, parts: &[&str]) -> String {
    let (printed, right) = sahara(folder, args);
    assert!(right, "{args}: {printed}");
    assert_contains(&printed, parts);
    printed
}

#[test]
fn the_command_rejects_each_fault_for_its_own_reason() {
    // If the message names a ray, `picks(ray, one_in)` must be true for this ray.
    for (fault, rays, reason, one_in) in [
        ("drops", 100_000, "lost on ray \"", 10_000),
        ("wrong-id", 1000, "wrong-primitive on ray \"", 1),
        ("late", 1000, "wrong-t on ray \"", 1),
        ("any-hit-disagrees", 10_000, "any-hit-disagrees on ray \"", 500),
        ("panics", 10_000, "panics on ray \"", 500),
        ("hangs", 10_000, "hangs on ray \"", 500),
        ("moody", 10_000, "unrepeatable on ray \"", 1),
        ("builder-panics", 100, "refused", 1),
        ("builder-hangs", 100, "hangs", 1),
    ] {
        let validate = format!("validate cube -s broken:fault={fault} --rays {rays} --limit 2");
        let (printed, right) = sahara(&Folder::new(), &validate);
        assert!(!right && printed.contains(reason), "{fault}: {printed}");
        let named: Option<Ray> = printed.split('"').find_map(|part| part.parse().ok());
        assert_eq!(named.is_some(), reason.contains("ray"), "{fault}: {printed}");
        assert!(named.is_none_or(|ray| picks(&ray, one_in)), "{fault}: {printed}");
        assert!(fault != "late" || printed.contains("3 ulps away"), "{printed}");
    }
}

#[test]
fn each_fault_of_a_tree_is_told_from_what_its_triangle_test_rounds() {
    const LOSES: &str = "loses hits that no rounding explains";
    const ROUNDS: &str = "always within the rounding of the triangle";
    for (fault, options, sentence) in [
        ("none", "teapot cornellbox", ROUNDS),
        ("none", "teapot cornellbox --strict", ""),
        ("leaf-dropped", "teapot", LOSES),
        ("child-order", "teapot", LOSES),
        ("stale-t-max", "teapot", LOSES),
        ("last-triangle", "teapot", LOSES),
        ("ties", "teapot --adversarial", LOSES),
        ("any-hit", "teapot", "contradicts itself: any hit and closest hit disagree"),
        ("epsilon", "teapot --adversarial", LOSES),
        ("wrong-id", "teapot", "names triangles that are not hit there"),
        ("not-a-number", "cornellbox", "returns hits that no rounding explains"),
        ("t-off", "teapot", "returns depths that no rounding explains"),
    ] {
        let validate = format!("validate -s mybvh:fault={fault} --rays 2000 {options}");
        let (printed, right) = sahara(&Folder::new(), &validate);
        let verdict = if fault == "none" { sentence.into() } else { format!("{fault} {sentence}") };
        assert!(right == (sentence == ROUNDS) && unwrapped(&printed).contains(&verdict), "{fault}: {printed}");
    }
    for (fault, case, is_found) in [
        ("zero-times-infinity", "straight_down", true),
        ("degenerate-box", "planar_in_split_plane", true),
        ("overflowed-stack", "stacked_sheets", true),
        ("none", "straight_down", false),
        ("none", "planar_in_split_plane", false),
        ("none", "stacked_sheets", false),
    ] {
        let choice = registry().choose(&format!("mybvh:fault={fault}")).unwrap();
        let case = find(case).unwrap();
        let answers = run(case, &choice.subject(), 1000, &SystemClock::start()).unwrap();
        let score = CaseTruth::new(case, 1000).score(choice.triangle_test(), answers).unwrap();
        assert_eq!(!score.is_sound(), is_found, "{fault} {}", case.name);
    }
}

#[test]
fn wrong_answers_are_seen_where_speed_is() {
    for (fault, is_timed) in [("none", true), ("leaf-dropped", false), ("epsilon", false)] {
        let args = format!("compare teapot -s mybvh:fault={fault} -s sah-kd -w diffuse --budget 1 --runs 2 --epochs 1");
        let (printed, right) = sahara(&Folder::new(), &args);
        let advice = format!("see: sahara validate teapot -s mybvh:fault={fault} --ray");
        assert_eq!([right, !unwrapped(&printed).contains(&advice)], [is_timed; 2], "{fault}: {printed}");
    }
}

#[test]
fn registered_structures_are_chosen_compared_and_drawn_like_our_own_and_may_decline_queries() {
    let folder = &Folder::new();
    let (printed, right) = sahara(folder, "validate cube -s grid:resolution=0");
    assert!(!right && printed.contains("resolution must be from 1 to 256"), "{printed}");
    let compare = "compare sphere -s grid:resolution=32 -s sah-kd -s modest -w primary -w shadow --rays 1024 --runs 3 \
                   --epochs 1 --verbose --export-json r.json";
    for (args, parts) in [
        ("golden check cube torus cornellbox -s grid", &["Cornellbox: identical to the golden image: grid"][..]),
        ("validate torus -s grid -s modest --rays 2000 --verbose", &["modest declines any hit, t_min, t_max: "]),
        (compare, &["declined", "modest declines any hit, which shadow"]),
        ("list structures", &["declines", "grid"]),
        ("list grid", &["resolution"]),
    ] {
        content(folder, args, parts);
    }
    let rows = rows(folder.path("r.json"));
    let timed: Vec<bool> = rows.iter().map(|row| !row["ns"].as_array().unwrap().is_empty()).collect();
    // A declined workload has neither a time nor an error.
    assert_eq!(timed, [true, true, true, true, true, false], "{rows:?}");
    assert!(rows.iter().all(|row| row["checked"]["errors"].as_u64().unwrap_or(0) == 0), "{rows:?}");
    assert_eq!([&rows[0]["label"], &rows[0]["triangle_test"]], ["grid:resolution=32", "exact"]);
    assert_eq!(rows[0]["counts"]["hits"], rows[2]["counts"]["hits"]);
    assert_eq!([&rows[5]["declined"], &rows[4]["counts"]["tests"]], [&"any hit".into(), &Value::Null]);
}

#[test]
fn a_command_about_one_structure_says_when_it_panics_or_hangs() {
    let folder = Folder::new();
    content(&folder, "rays record cube -o f.rays --rays 10000", &[]);
    let export = "--rays f.rays --limit 2 --export-hits f.hits";
    for (args, reason) in [
        (format!("validate {export} -s broken:fault=panics"), "it panics"),
        (format!("validate {export} -s broken:fault=hangs"), "it hangs"),
        (format!("validate {export} -s broken:fault=builder-hangs"), "it hangs"),
        ("render cube -o f.png -s broken:fault=panics --size 128x128".into(), "its traversal panicked"),
    ] {
        let (printed, right) = sahara(&folder, &args);
        assert!(!right && printed.contains(reason) && printed.contains("error: "), "{args}: {printed}");
    }
    assert_eq!(folder.names(), ["f.rays"], "nothing is written");
}

#[test]
fn a_study_of_another_crate_is_in_the_command_in_study_all_and_on_the_page() {
    let folder = &Folder::new();
    content(folder, "study --help", &[DUPLICATION.question]);
    let study = "study duplication -s grid -s sah-bvh --rays 256 --dir runs --export-json d.json --export-csv d.csv";
    content(folder, study, &["References for each triangle", "staircase 64"]);
    assert_contains(&folder.read("d.json"), &["\"word\":\"staircase:64\""]);
    let csv = folder.read("d.csv");
    assert!(csv.starts_with("scene,structure,references_per_triangle\n") && csv.lines().count() == 5, "{csv}");
    // Runs with different structures may use the same folder.
    content(folder, "study duplication -s grid --rays 256 --dir runs", &[]);
    let plan = content(folder, "study plan duplication -s sah-kd --rays 256 --dir jobs", &[]);
    // The first line of the plan begins with the test name, which the test harness prints.
    let jobs: Vec<&str> = plan.lines().filter_map(|line| Some(line.split_once("sahara ")?.1)).collect();
    assert_eq!(jobs.len(), 2, "{plan}");
    for _ in 0..2 {
        content(folder, jobs[0], &[]);
    }
    assert_eq!(fs::read_dir(folder.path("jobs/duplication")).unwrap().count(), 1);

    content(folder, "study all --quick --fresh --dir runs", &["duplication/", "Everything is measured"]);
    content(folder, "report runs -o page --no-pictures", &["index.html"]);
    assert_contains(&folder.read("page/index.html"), &[DUPLICATION.question, "staircase 64"]);
    assert!(folder.path("page/data/duplication.csv").is_file());
}
