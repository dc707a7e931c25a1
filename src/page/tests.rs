use std::fs;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use super::{Runs, files, page};
use crate::report::document::{Art, Document, Section};
use crate::report::plot::Chart;
use crate::report::{Record, to_json};
use crate::study::history::{self, Entry};
use crate::study::{Studies, attribution};
use example::{Files, accuracy, comparison, exported, refused, scaling, whole};

pub use example::{attribution as attribution_files, compared, cube, provenance, read, records_of, runs_folder};

mod example;
mod machines;
mod statements;

fn document(runs: &Runs, pictures: Vec<Section>) -> Document {
    super::document(runs, &Studies::builtin(), pictures)
}

/// The three forms of a document.
fn forms(document: &Document) -> [String; 3] {
    [page(document), super::markdown::markdown(document), super::latex::latex(document)]
}

/// What a user may call a scene.
const EVIL: &str = "<script>alert(\"&'1'\")</script>";

#[test]
fn what_users_name_is_text_in_every_form() {
    let (document, runs) = whole(EVIL);
    let page = page(&document);
    assert!(!page.contains("<script>alert"), "a name became markup");
    assert!(page.contains("&lt;script&gt;alert(&quot;&amp;&#x27;1&#x27;&quot;)"), "the name is there as text");
    let files = files(&document, &runs, &Studies::builtin());
    let text = |name: &str| {
        let (_, bytes) = files.iter().find(|(path, _)| path == name).unwrap_or_else(|| panic!("no {name}"));
        String::from_utf8(bytes.clone()).unwrap()
    };
    assert!(!text("report.md").replace("\\<", "").contains("<script>"));
    let outside_math = text("report.tex").replace("\\&", "").replace("\\_", "").replace("\\#", "").replace("\\%", "");
    let body = outside_math.split("\\begin{document}").nth(1).unwrap();
    for line in body.lines().filter(|line| !line.ends_with("\\\\") && !line.ends_with("{%")) {
        assert!(!line.contains(['&', '#', '%', '<']), "{line}");
    }
    // What a figure is called in the file system is no path.
    assert!(files.iter().all(|(path, _)| !path.contains("..") && !path.contains(['<', '"', '&'])), "{files:?}");
}

#[test]
fn the_page_asks_for_nothing_from_elsewhere() {
    let (document, _) = cube();
    let page = page(document);
    for attribute in ["src=", "href=", "url(", "@import", "srcset=", "action="] {
        for (at, _) in page.match_indices(attribute) {
            let value = page[at + attribute.len()..].trim_start_matches(['"', '\'']);
            assert!(value.starts_with('#') || value.starts_with("data:"), "{}", &page[at..at + 60]);
        }
    }
    assert!(!page.replace("http://www.w3.org/2000/svg", "").contains("http"), "no address at all");
}

#[test]
fn an_inspector_is_data_that_no_name_can_end() {
    let (document, _) = whole(EVIL);
    let page = page(&document);
    let json = page.split("<script type=\"application/json\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(json).unwrap();
    assert_eq!(data["command"], format!("sahara validate {EVIL} --ray"));
    assert_eq!(
        data["answers"][0].to_string(),
        "[[0.1,7,0.25,0.333333333],[\"missed\"]]",
        "t as short as it reads back"
    );
    assert_eq!((data["truths"][1].to_string(), data["pixels"].to_string()), ("[]".into(), "[0,3]".into()));
    assert_eq!(
        data["structures"][1].to_string(),
        r#"{"label":"b","nodes":[3,4],"leaves":[],"tests":[12,0],"answers":[1,0]}"#
    );
}

#[test]
fn every_figure_has_a_caption_a_command_and_words_for_those_who_do_not_see() {
    let (document, _) = cube();
    let figures = document.figures();
    assert!(figures.len() >= 12, "{}", figures.len());
    let mut ids: Vec<&str> = figures.iter().map(|figure| figure.id.as_str()).collect();
    for figure in &figures {
        assert!(!figure.caption.is_empty() && figure.command.starts_with("sahara "), "{}", figure.id);
        assert!(!figure.alt.is_empty() || !matches!(figure.art, Art::Chart(_)), "{}", figure.id);
    }
    let page = page(document);
    assert_eq!(page.matches("<figcaption>").count(), figures.len());
    assert_eq!(page.matches("<figure ").count(), figures.len());
    let pictures = page.matches("<img src").count();
    assert_eq!(pictures, page.matches("<img src=\"data:image/png;base64,").count());
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), figures.len(), "every figure has a name of its own");
}

#[test]
fn scenes_of_much_the_same_name_have_figures_of_their_own() {
    let both = [records_of("a b"), records_of("a-b")].concat();
    let document = document(&compared(&both), vec![]);
    let ids: Vec<&str> = document.figures().into_iter().map(|figure| figure.id.as_str()).collect();
    assert_eq!(ids, ["tradeoff", "speed-a-b", "speed-a-b-v2"]);
}

#[test]
fn the_same_runs_give_the_same_page() {
    // The folder of the runs is another one each time, and is named where the numbers come from.
    let same = |document: &Document| {
        let sections = document.sections.iter().filter(|section| section.id != "provenance").cloned().collect();
        forms(&Document { sections, ..document.clone() })
    };
    assert_eq!(same(&cube().0), same(&whole("Cube").0));
}

#[test]
fn a_part_that_is_not_there_is_named_with_its_command() {
    let runs = compared(&records_of("Dragon"));
    let whole = document(&runs, vec![]);
    assert_eq!(whole.answer.verdict, "Yes, on Dragon");
    assert_eq!(whole.answer.numbers[0].number, "8.00 ×");
    let missing: Vec<&str> = whole.missing().iter().map(|missing| missing.command.as_str()).collect();
    assert!(missing.iter().any(|command| command.starts_with("sahara replicate")), "{missing:?}");
    assert!(missing.iter().any(|command| command.starts_with("sahara study attribution")), "{missing:?}");
    assert!(missing.iter().all(|command| !command.starts_with("sahara compare")), "{missing:?}");
    // What is asked ends with its own sign.
    let forms = forms(&whole);
    assert!(forms.iter().all(|text| text.contains("Not measured") && !text.contains("?.")));
    let [page, ..] = forms;
    assert!(missing.iter().all(|command| page.contains(&command.replace('/', "&#x2f;"))));

    let attributed = runs_folder(&attribution_files("Lucy"));
    let answer = document(&read(attributed.path()), vec![]).answer;
    assert_eq!((answer.verdict.as_str(), answer.numbers.len()), ("Yes, on Lucy", 1));

    let nothing = document(&read(runs_folder(&accuracy("Cube")).path()), vec![]);
    assert_eq!(nothing.answer.verdict, "Not measured");
    assert_eq!(nothing.sections.len(), 2, "the study that was measured, and where its numbers come from");

    // A comparison of other scenes leads with what it has measured.
    let own = document(&compared(&records_of("Cube")), vec![]);
    assert_eq!(own.title, "Which structure is the fastest on Cube?");
    assert!(own.answer.sentences[0].contains(own.answer.verdict.split(' ').next().unwrap()), "{:?}", own.answer);
    assert!(own.answer.sentences.last().unwrap().contains("sahara replicate"), "{:?}", own.answer);
    assert_eq!(own.sections[0].id, "compare");
}

#[test]
fn the_newest_run_of_a_scene_counts_and_the_older_one_is_said_to_be_replaced() {
    let older = runs_folder(&[("old.json", to_json(&[records_of("Dragon"), records_of("Cube")].concat()))]);
    let mut newer = records_of("Dragon");
    newer.iter_mut().for_each(|record| record.build_ns = 77);
    let newer = runs_folder(&[("new.json", to_json(&newer))]);
    let file = fs::File::options().append(true).open(newer.path().join("new.json")).unwrap();
    file.set_modified(SystemTime::now() + Duration::from_secs(60)).unwrap();
    // In whatever order they are named.
    for order in [[&older, &newer], [&newer, &older]] {
        let runs = Runs::read(&order.map(|folder| folder.path().to_path_buf()), &Studies::builtin()).unwrap();
        assert_eq!(runs.records().len(), 12);
        assert!(runs.records().iter().all(|r| (r.build_ns == 77) == (r.scene == "Dragon")));
        let replaced: Vec<bool> = runs.sources.iter().map(|source| !source.replaced.is_empty()).collect();
        assert_eq!(replaced, [true, false]);
    }
}

#[test]
fn what_cannot_be_read_is_one_sentence() {
    let whole = to_json(&records_of("Cube"));
    let torn = whole[..whole.len() / 2].to_vec();
    let case = String::from_utf8(attribution_files("Cube").swap_remove(0).1).unwrap();
    let other = case.replacen("\"attribution\"", "\"astrology\"", 1);
    let broken = case.replacen("\"epoch\":", "\"epic\":", 1);
    let newer = case.replacen("\"schema\":3", "\"schema\":4", 1);
    let cases: [(&str, Vec<u8>, &str); 10] = [
        ("torn.json", torn, "torn"),
        ("empty.json", vec![], "torn"),
        ("text.json", b"hello".to_vec(), "torn"),
        ("other.json", b"{\"a\": 1}".to_vec(), "no run of sahara"),
        ("list.json", b"[1, 2]".to_vec(), "no run of sahara"),
        ("old.json", b"[{\"workload_hash\": \"1\"}]".to_vec(), "another version"),
        ("half.json", case.as_bytes()[..case.len() / 2].to_vec(), "torn"),
        ("astrology.json", other.into_bytes(), "astrology"),
        ("broken.json", broken.into_bytes(), "missing field `epoch`"),
        ("newer.json", newer.into_bytes(), "has version 4"),
    ];
    for (name, bytes, part) in cases {
        let folder = runs_folder(&[(name, bytes)]);
        let error = refused(&[folder.path().join(name)]).to_string();
        assert!(error.contains(name) && error.contains(part) && error.lines().count() == 1, "{error}");
    }
    let missing = refused(&[PathBuf::from("no/such/file.json")]).to_string();
    assert!(missing.contains("no/such/file.json"), "{missing}");
    let empty = tempfile::tempdir().unwrap();
    assert!(refused(&[empty.path().into()]).to_string().contains("sahara study all"));
}

#[test]
fn what_is_no_run_is_left_out_of_a_folder_and_named() {
    let folder = runs_folder(&[
        ("compare.json", to_json(&records_of("Cube"))),
        ("notes.json", b"[{\"claim\": \"x\"}]".to_vec()),
    ]);
    let runs = read(folder.path());
    assert_eq!(runs.records().len(), 6);
    let mut left_out: Vec<&str> =
        runs.sources.iter().filter(|s| !s.replaced.is_empty()).map(|s| s.kind.as_str()).collect();
    left_out.sort_unstable();
    assert_eq!(left_out, ["no run"]);
    fs::remove_file(folder.path().join("compare.json")).unwrap();
    assert!(refused(&[folder.path().into()]).to_string().contains("there is no run"));
}

/// What is changed in the text of a case, and what it becomes.
const OTHER_CPU: [&str; 2] = ["\"cpu\":\"a processor\"", "\"cpu\":\"another\""];
const OTHER_COMMIT: [&str; 2] = ["\"commit\":\"c0ffee\"", "\"commit\":\"decade\""];

/// Two folders with these files, the text of every file of the second changed so, read together.
fn both([one, other]: [&Files; 2], change: impl Fn(&str) -> String) -> Runs {
    let of = |bytes: &[u8]| change(str::from_utf8(bytes).unwrap()).into_bytes();
    let changed: Files = other.iter().map(|(name, bytes)| (name.clone(), of(bytes))).collect();
    let [one, other] = [one, &changed].map(|files| runs_folder(files));
    Runs::read(&[one.path().into(), other.path().into()], &Studies::builtin()).unwrap()
}

#[test]
fn cases_of_other_machines_and_builds_are_never_of_one_answer() {
    let files = attribution_files("Cube");
    for change in [OTHER_CPU, OTHER_COMMIT] {
        let runs = both([&files; 2], |text| text.replacen(change[0], change[1], 1));
        let answer = runs.answers.of::<attribution::AttributionStudy>().unwrap();
        assert_eq!(answer.len(), 1);
        assert_eq!(runs.sources.len(), 2, "each is an answer of its own: {:?}", runs.sources);
        assert_eq!(runs.sources.iter().filter(|source| !source.replaced.is_empty()).count(), 1);
    }
    // A case that was measured twice by one build on one machine counts once.
    let of_hosts = |files: [&Files; 2]| {
        let mut runs = both(files, |text| text.replacen("\"host\":\"", "\"host\":\"b", 1));
        assert_eq!((runs.sources.len(), runs.notes.len()), (1, 1), "{:?}", runs.notes);
        runs.notes.remove(0)
    };
    let note = of_hosts([&files; 2]);
    assert!(note.contains("attribution: 2 cases measured again since"), "{note}");
    // Hosts of one processor are one machine, and are named.
    let note = of_hosts([&files[..1].to_vec(), &files[1..].to_vec()]);
    assert!(note.starts_with("attribution: cases of 2 hosts: "), "{note}");
}

#[test]
fn a_comparison_is_of_one_build_and_another_machine_stands_beside_it() {
    // One of them measured a scene that the other lacks.
    let files = [comparison(&["Dragon", "Cube", "Lucy"]), comparison(&["Dragon", "Torus"])];
    for (change, machines) in [(OTHER_COMMIT, 1), (OTHER_CPU, 2)] {
        let runs = both(files.each_ref(), |text| text.replacen(change[0], change[1], 1));
        assert_eq!(runs.records().len(), 6);
        for record in runs.records() {
            assert_eq!((&*record.provenance.commit, &*record.provenance.cpu), ("c0ffee", "a processor"));
        }
        let left_out = runs.sources.iter().filter(|source| !source.replaced.is_empty()).count();
        assert_eq!((runs.machines.len(), left_out), (machines, 2 - machines), "{:?}", runs.sources);
    }
}

#[test]
fn epochs_that_no_plan_has_are_not_missing() {
    // Of the larger ones `scaling` measures three.
    let notes = |epochs: usize| read(runs_folder(&scaling(&[(1280, 4), (20 << 18, epochs)])).path()).notes;
    assert_eq!(notes(3), [""; 0]);
    assert_eq!(notes(2), ["scaling: sphere 5242880: epoch 2 is not measured."]);
}

#[test]
fn the_picture_of_a_history_names_commits_and_marks_changes() {
    let run = |(commit, slower): (&str, f64)| {
        let of = |mut record: Record| {
            record.provenance.commit = commit.into();
            if record.label == "sah-kd" {
                record.samples_ns.iter_mut().for_each(|ns| *ns *= slower);
            }
            record
        };
        let records: Vec<Record> = records_of("Cube").into_iter().map(of).collect();
        serde_json::to_string(&Entry::new("nightly", &records).unwrap()).unwrap()
    };
    let lines = [("0123456789ab", 1.0), ("decade", 1.0), ("decade+changes", 2.0)].map(run).join("\n");
    let folder = runs_folder(&[(format!("baselines/{}", history::FILE), lines.into_bytes())]);
    let document = document(&read(folder.path()), vec![]);
    let figure = document.figures().into_iter().find(|figure| figure.id == "history-nightly").unwrap();
    let Art::Chart(Chart::Curves(curves)) = &figure.art else { panic!("no curves") };
    assert_eq!(curves.x_names, ["0123456", "decade", "decade+"]);
    let points = curves.lines.iter().flat_map(|line| line.points.iter().map(move |point| (&*line.label, point)));
    let marked: Vec<(&str, f64)> = points.filter(|(_, point)| point.is_marked).map(|(label, p)| (label, p.x)).collect();
    assert_eq!(marked, [("sah-kd", 3.0)]);
    assert!(figure.caption.contains("Rings"), "{}", figure.caption);
}

#[test]
fn runs_of_several_histories_are_in_order_of_time_and_only_those_of_the_same_rays_are_compared() {
    let lines = |runs: &[(&str, &str)]| {
        let line = |(scene, date): &(&str, &str)| {
            let mut records = records_of(scene);
            for record in &mut records {
                record.provenance.date = format!("{date}T00:00:00Z");
                record.scene_hash = (*scene).into();
            }
            serde_json::to_string(&Entry::new("nightly", &records).unwrap()).unwrap() + "\n"
        };
        let text: String = runs.iter().map(line).collect();
        runs_folder(&[(format!("baselines/{}", history::FILE), text.into_bytes())])
    };
    // The first run of the second folder was made again, and keeps its place there.
    let (tenth, second) = (
        lines(&[("Cube", "2026-03-10")]),
        lines(&[("Cube", "2026-03-12"), ("Cube", "2026-03-02"), ("Torus", "2026-03-11")]),
    );
    let paths = [&tenth, &second, &tenth, &second].map(|folder| folder.path().to_path_buf());
    let of = |paths: &[PathBuf]| Runs::read(paths, &Studies::builtin()).unwrap();
    let runs = of(&paths);
    let days: Vec<&str> = runs.history.iter().map(|run| &run.provenance.date[8..10]).collect();
    assert_eq!(days, ["12", "02", "10", "11"]);
    assert!(page(&document(&runs, vec![])).contains("of 2026-03-11, is of other scenes or rays than the one before"));
    let same = lines(&[("Cube", "2026-03-02"), ("Cube", "2026-03-10")]);
    let text = page(&document(&of(&[same.path().to_path_buf()]), vec![]));
    assert!(text.contains("of 2026-03-10, is not distinguishable from the one before"));
}

#[test]
fn a_scene_that_was_not_checked_is_left_out_and_named() {
    let mut files = attribution_files("Cube");
    files.remove(0);
    let runs = read(runs_folder(&files).path());
    assert!(runs.answers.of::<attribution::AttributionStudy>().unwrap().is_empty());
    assert!(runs.notes[0].starts_with("attribution: Cube (stand-in): epoch 0 is not measured"), "{:?}", runs.notes);
    let document = document(&runs, vec![]);
    assert!(page(&document).contains("epoch 0 is not measured"));
}

#[test]
fn tidy_data_reads_back() {
    let (document, runs) = cube();
    let files = files(document, runs, &Studies::builtin());
    let bytes = |name: &str| &files.iter().find(|(path, _)| path == name).unwrap_or_else(|| panic!("no {name}")).1;
    let lines = String::from_utf8(bytes("data/records.jsonl").clone()).unwrap();
    let back: Vec<Record> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(back, runs.records());
    let mut csv = csv::Reader::from_reader(&bytes("data/records.csv")[..]);
    let names = csv.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = csv.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), runs.records().len());
    let column =
        |name: &str| names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no column {name} in {names:?}"));
    assert_eq!(&rows[1][column("label")], "sah-kd");
    assert_eq!(&rows[0][column("counts.leaves")], "7");
    for figure in document.figures().into_iter().filter(|figure| !figure.data.columns.is_empty()) {
        let mut csv = csv::Reader::from_reader(&bytes(&format!("figures/{}.csv", figure.id))[..]);
        assert_eq!(csv.records().map(Result::unwrap).count(), figure.data.rows.len());
    }
}
