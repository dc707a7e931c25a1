//! An example of adding a structure: a type, the public interface, one macro; and the results of broken structures.

mod broken;
mod faulty;
mod grid;
mod question;

use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::Duration;

use broken::{Broken, BrokenConfig, Fault, Modest, picks};
use faulty::{Faulty, FaultyConfig};
use grid::{Grid, GridConfig};
use question::{DUPLICATION, staircase};
use sahara::builtin::Builtin;
use sahara::cli::Suite;
use sahara::geometry::Ray;
use sahara::measure::{Provenance, SystemClock};
use sahara::registry::Registry;
use sahara::request::{StructureRequest, WorkloadRequest, scene};
use sahara::scene::WorkloadKind;
use sahara::study::measure::{BuildWatch, Prepared, measure};
use sahara::study::measurement::measurements;
use sahara::study::{Dataset, Measured, Plan, PlannedScene, Settings, Studies};
use sahara::triangle::{Exact, MollerTrumbore};
use sahara::validate::conformance::{Named, Subject, answers, counting, shapes};
use sahara::validate::hard_cases::{CaseTruth, find, run};
use sahara::validate::{degenerate_meshes, stacked_sheets};

// Few cells: each of two thousand coincident triangles is in all cells that it meets.
sahara::conformance!(my_grid, Grid<MollerTrumbore>, GridConfig { resolution: 2 }, lowest_id);
sahara::conformance!(my_bvh, Faulty, FaultyConfig::default());

fn registry() -> Registry {
    Registry::builtin()
        .with::<Grid<Exact>>("grid", GridConfig::default())
        .with::<Broken>("broken", BrokenConfig::default())
        .with::<Modest>("modest", GridConfig::default())
        .with::<Faulty>("mybvh", FaultyConfig::default())
        .with_generator("staircase", staircase)
}

#[test]
fn a_registered_structure_is_chosen_like_the_others_and_draws_the_golden_images() {
    let choice = registry().choose("grid:resolution=3").unwrap();
    assert_eq!((choice.label.as_str(), choice.triangle_test()), ("grid:resolution=3", "exact"));
    let refusal = registry().choose("grid:resolution=0").map(|_| ()).unwrap_err().to_string();
    assert!(refusal.contains("resolution must be from 1 to 256"), "{refusal}");
    let choice = registry().choose("grid").unwrap();
    for name in ["cube", "torus", "cornellbox"] {
        let scene = Builtin::find(name).unwrap().scene(None).unwrap();
        let (golden, out) = (Builtin::find(name).unwrap().golden(), Path::new(env!("CARGO_TARGET_TMPDIR")));
        golden.check(&scene, "grid", choice.build(&scene.mesh).unwrap().as_ref(), out).unwrap();
    }
}

#[test]
fn it_is_compared_like_our_own() {
    let registry = registry();
    let structures = ["grid", "sah-kd", "modest"].map(|spec| StructureRequest::new(spec, ""));
    let kinds = vec![WorkloadKind::Primary, WorkloadKind::Shadow];
    let workloads = WorkloadRequest::Scene { kinds, rays: Some(1024) };
    let settings = Settings { runs: 3, ..Settings::for_guide("sah-kd") };
    let own = ("sphere".to_owned(), scene(&registry, "sphere").unwrap());
    let plan = Plan::by_epoch("compare", &[PlannedScene::new(&own, &structures, &workloads, &settings, 1)]);
    let case = plan.cases[0].clone();
    let prepared = Prepared::new(&case, &registry, Some(own.1)).unwrap();
    let epoch = measure(&case, &prepared, &SystemClock::start(), &BuildWatch::default(), &mut |_| {}).unwrap();
    let records = measurements(&Dataset::new(Provenance::capture(1), vec![Measured { case, epoch }]));
    assert_eq!(records.len(), 6);
    assert!(records[..4].iter().all(|r| r.wrong_hits == 0 && r.mrays_per_s > Some(0.0)));
    assert_eq!(records[0].label, "grid");
    assert_eq!(records[0].counts.hits, records[2].counts.hits);

    // Declined is neither a time nor an error.
    assert!(records[4].mrays_per_s.is_some() && records[4].declined.is_none());
    assert_eq!((records[5].mrays_per_s, records[5].declined.as_deref()), (None, Some("any hit")));
    assert_eq!((records[5].wrong_hits, records[4].counts.tests_per_ray()), (0, None));
}

/// Some meshes: they trigger the faults that affect one ray in 10,000.
fn meshes() -> Vec<Named> {
    let wanted = ["closed sphere", "soup", "nested shells", "crossing needles", "same centroid"];
    degenerate_meshes().into_iter().filter(|(name, _)| wanted.contains(&name.as_str())).collect()
}

fn subject(fault: Fault) -> Subject {
    Subject { limit: Duration::from_secs(5), ..Subject::of::<Broken>("broken", BrokenConfig { fault }) }
}

#[test]
fn the_grid_that_the_broken_ones_are_made_from_is_right_and_what_is_declined_is_not_asked() {
    answers(&Subject::of::<Broken>("broken", BrokenConfig::default()), &meshes(), 200).unwrap();
    let modest = Subject::of::<Modest>("modest", GridConfig::default());
    answers(&modest, &meshes(), 60).unwrap();
    counting(&modest, &meshes(), 10).unwrap();
    shapes(&modest, &meshes()).unwrap();
}

#[test]
fn a_structure_that_hangs_is_given_up_and_the_ray_is_named() {
    let report = answers(&subject(Fault::Hangs), &meshes(), 200).unwrap_err();
    assert!(report.contains("worst: hangs on ray \"") && report.contains("no result within 5s"), "{report}");
    let ray: Option<Ray> = report.split('"').find_map(|part| part.parse().ok());
    assert!(ray.is_some_and(|ray| picks(&ray, 500)), "{report}");
    let counted = counting(&subject(Fault::Hangs), &meshes()[..1], 2000).unwrap_err();
    assert!(counted.contains("it hangs") && counted.contains("tracing ray \""), "{counted}");
}

/// Ten places are enough for the small meshes.
#[test]
fn a_short_stack_is_found_by_stacked_sheets() {
    let of = |fault| answers(&Subject::of::<Faulty>("mybvh", FaultyConfig { fault }), &stacked_sheets(), 10);
    of(faulty::Fault::None).unwrap();
    assert!(of(faulty::Fault::OverflowedStack).unwrap_err().contains("8192 stacked sheets"));
}

#[test]
fn builders_that_panic_or_hang_are_told_from_each_other() {
    let of = |fault| answers(&subject(fault), &meshes(), 1).unwrap_err();
    let words = "does not build over \"crossing needles\": it";
    assert!(of(Fault::BuilderPanics).contains(&format!("{words} panics: the message is \"no triangle")));
    assert!(of(Fault::BuilderHangs).contains(&format!("{words} hangs")));
    assert!(shapes(&subject(Fault::BuilderHangs), &meshes()).unwrap_err().contains("it hangs"));
}

/// The command of a crate with these structures: the tests below run it in a separate process.
#[test]
fn command() {
    let Some(args) = std::env::var_os("SAHARA_THIRD_PARTY") else { return };
    let args = args.into_string().unwrap();
    // The whole list takes minutes: if all of it is run, use only this crate's study.
    let all = args.starts_with("study all") || args.starts_with("report");
    let studies = if all { Studies::empty() } else { Studies::builtin() };
    let suite = Suite { registry: registry(), studies: studies.with(DUPLICATION) };
    let words = shlex::split(&args).unwrap();
    let status = sahara::cli::run(&suite, ["sahara".into()].into_iter().chain(words).map(Into::into));
    std::process::exit(if status == ExitCode::SUCCESS { 0 } else { 42 });
}

/// The output of the command, and whether it succeeds.
fn sahara(args: &str) -> (String, bool) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command
        .args(["--exact", "third_party::command", "--nocapture", "--test-threads=1"])
        .env("SAHARA_THIRD_PARTY", args);
    let output = command.env_remove("SAHARA_DATA").stdin(Stdio::null()).output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap() + &String::from_utf8_lossy(&output.stderr);
    assert!(matches!(output.status.code(), Some(0 | 42)), "{args}: {printed}");
    (printed, output.status.code() == Some(0))
}

/// The output of the command; it must succeed, and contain all of `parts`.
#[track_caller]
fn content(args: &str, parts: &[&str]) -> String {
    let (printed, right) = sahara(args);
    assert!(right && parts.iter().all(|part| printed.contains(part)), "{args}: {printed}");
    printed
}

#[test]
fn the_command_rejects_each_fault_for_its_own_reason() {
    // The named ray triggers the fault, if the fault affects one ray in so many.
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
        let (printed, right) = sahara(&format!("validate sphere -s broken:fault={fault} --rays {rays} --limit 5"));
        assert!(!right && printed.contains(reason), "{fault}: {printed}");
        let named: Option<Ray> = printed.split('"').find_map(|part| part.parse().ok());
        assert_eq!(named.is_some(), reason.contains("ray"), "{fault}: {printed}");
        assert!(named.is_none_or(|ray| picks(&ray, one_in)), "{fault}: {printed}");
        assert!(fault != "late" || printed.contains("3 ulps away"), "{printed}");
    }
}

/// Faults of a BVH with its own triangle test, and the final sentence of `validate` and `compare`. Ordinary rays show
/// most of them.
#[test]
fn each_fault_of_a_tree_is_told_from_what_its_triangle_test_rounds() {
    const LOSES: &str = "loses hits that no rounding explains";
    let validate =
        |fault: &str, options: &str| sahara(&format!("validate -s mybvh:fault={fault} --rays 4000 {options}"));
    let (printed, right) = validate("none", "teapot cornellbox");
    assert!(right && printed.contains("always within the rounding of the triangle"), "{printed}");
    let (printed, right) = validate("none", "teapot cornellbox --strict");
    assert!(!right, "{printed}");
    for (fault, options, sentence) in [
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
        let (printed, right) = validate(fault, options);
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(!right && words(&printed).contains(&format!("{fault} {}", sentence)), "{fault}: {printed}");
    }
    // Axis-parallel rays in the sides of boxes, boxes without thickness, and deep trees: hard cases show them.
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

/// A structure with wrong hits on timed rays has no time, and the message names a ray.
#[test]
fn wrong_answers_are_seen_where_speed_is() {
    for (fault, is_timed) in [("none", true), ("leaf-dropped", false), ("epsilon", false)] {
        let args = format!("compare teapot -s mybvh:fault={fault} -s sah-kd -w diffuse --budget 1 --runs 2 --epochs 1");
        let (printed, right) = sahara(&args);
        assert_eq!(right, is_timed, "{fault}: {printed}");
        let advice = format!("see: sahara validate teapot -s mybvh:fault={fault} --ray");
        assert_eq!(printed.split_whitespace().collect::<Vec<_>>().join(" ").contains(&advice), !is_timed, "{printed}");
    }
}

#[test]
fn the_command_knows_the_structures_and_what_they_decline() {
    content("validate torus -s grid -s modest --rays 2000 --verbose", &["modest declines any hit, t_min, t_max: "]);
    let compare = "compare cube -s grid -s modest -w primary -w shadow --rays 400 --runs 2 --verbose";
    content(compare, &["declined", "modest declines any hit, which shadow"]);
    content("list structures", &["declines", "grid"]);
    content("list grid", &["resolution"]);
}

#[test]
fn a_command_about_one_structure_says_when_it_panics_or_hangs() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (rays, hits, picture) = (path("f.rays"), path("f.hits"), path("f.png"));
    content(&format!("rays record sphere -o {rays} --rays 10000"), &[]);
    for (fault, reason) in [("panics", "it panics"), ("hangs", "it hangs"), ("builder-hangs", "it hangs")] {
        let export = format!("validate --rays {rays} -s broken:fault={fault} --limit 3 --export-hits {hits}");
        let (printed, right) = sahara(&export);
        assert!(!right && printed.contains(reason) && printed.contains("error: "), "{fault}: {printed}");
    }
    let (printed, right) = sahara(&format!("render sphere -o {picture} -s broken:fault=panics --size 128x128"));
    assert!(!right && printed.contains("its traversal panicked"), "{printed}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is written");
}

#[test]
fn a_study_of_another_crate_is_in_the_command_in_study_all_and_on_the_page() {
    content("study --help", &[DUPLICATION.question]);
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (runs, page) = (path("runs"), path("page"));
    let exports = format!("--export-json {0}.json --export-csv {0}.csv", path("d"));
    let study = format!("study duplication -s grid -s sah-bvh --dir {runs} {exports}");
    content(&study, &["References for each triangle", "staircase 64"]);
    assert!(std::fs::read_to_string(path("d.json")).unwrap().contains("\"word\":\"staircase:64\""));
    let csv = std::fs::read_to_string(path("d.csv")).unwrap();
    assert!(csv.starts_with("scene,structure,references_per_triangle\n") && csv.lines().count() == 5, "{csv}");
    // Other settings are added, and a job in another process measures a case from its line.
    content(&format!("study duplication -s grid --dir {runs}"), &[]);
    let lines = content(&format!("study plan duplication -s sah-kd --dir {}", path("jobs")), &[]);
    // The harness prints the name of the test before the first line.
    let lines: Vec<&str> = lines.lines().filter_map(|line| Some(line.split_once("sahara ")?.1)).collect();
    assert_eq!(lines.len(), 2, "{lines:?}");
    content(lines[0], &[]);
    content(lines[0], &[]);
    assert_eq!(std::fs::read_dir(path("jobs/duplication")).unwrap().count(), 1);

    content(&format!("study all --quick --fresh --dir {runs}"), &["duplication/", "Everything is measured"]);
    content(&format!("report {runs} -o {page} --no-pictures"), &["index.html"]);
    let html = std::fs::read_to_string(folder.path().join("page/index.html")).unwrap();
    assert!(html.contains(DUPLICATION.question) && html.contains("staircase 64"), "the page");
    assert!(folder.path().join("page/data/duplication.csv").is_file());
}
