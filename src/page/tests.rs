use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use super::{Runs, files, page};
use crate::measure::Provenance;
use crate::report::document::{Art, Block, Colours, Document, Figure, Overlay, Section, Thumbnail};
use crate::report::inspector::{Answer, InspectedHit, InspectedRay, InspectedStructure, Inspector};
use crate::report::plot::{Chart, Curves, Line, Mark};
use crate::report::{Record, Table, example_record, to_json};
use crate::study::epoch::{Epoch, tests as epoch};
use crate::study::journal::Header;
use crate::study::{Studies, attribution};

mod statements;

fn document(runs: &Runs, pictures: Vec<Section>) -> Document {
    super::document(runs, &Studies::builtin(), pictures)
}

/// What a user may call a scene.
const EVIL: &str = "<script>alert(\"&'1'\")</script>";

pub(super) fn provenance(command: &str) -> Provenance {
    Provenance {
        command: command.into(),
        commit: "c0ffee".into(),
        cpu: "a processor".into(),
        load: None,
        ..example_record().provenance
    }
}

fn record(scene: &str, label: &str, workload: &str, ns: f64) -> Record {
    Record {
        scene: scene.into(),
        scene_hash: scene.into(),
        label: label.into(),
        structure: label.split(':').next().unwrap().into(),
        workload: workload.into(),
        trace_ns: Some(ns),
        mrays_per_s: Some(500.0 * 1e3 / ns),
        samples_ns: [1.0, 1.1, 0.9, 1.05, 1.0].map(|f| f * ns).into(),
        runs: 5,
        epochs: 5,
        noise_floor: Some(0.01),
        provenance: provenance("/opt/somewhere/sahara compare --export-json compare.json"),
        ..example_record()
    }
}

pub(super) fn records_of(scene: &str) -> Vec<Record> {
    ["primary", "shadow"]
        .iter()
        .flat_map(|workload| {
            [("median-kd", 8e6), ("sah-kd", 1e6), ("obvhs-bvh2", 9e5)]
                .map(|(label, ns)| record(scene, label, workload, ns))
        })
        .collect()
}

/// A journal with one scene.
fn accuracy(scene: &str) -> Vec<u8> {
    let of = |(label, ns, error): (&str, f64, f64)| {
        serde_json::json!({
            "schema": 1, "scene": scene, "scene_hash": "aa", "triangles": 12, "stand_in": false, "structure": "sah-kd", "label": label,
            "config": {}, "triangle_test": "exact", "rays": "uniform", "seed": 1, "judged": 1000, "sampled": false, "hits": 500,
            "missed": 0, "false_hits": 0, "wrong_depth": 0, "wrong_primitive": 0, "error": error, "error_bound": error + 0.003,
            "miss_rate": null, "false_hit_rate": null, "wrong_depth_rate": null,
            "ulps": { "median": 0.25, "p99": 0.5, "max": null }, "ns_per_ray": ns, "timed": 1000, "runs": 3, "dominated_by": null,
            "provenance": provenance("sahara study accuracy"),
        })
    };
    let records = [("sah-kd:test=exact", 250.0, 0.0), ("sah-kd:test=moller-trumbore", 200.0, 0.02)].map(of);
    journal("accuracy", vec![serde_json::json!({ "records": records, "refused": [], "note": null })])
}

/// A journal with one epoch of a scene.
fn attribution_journal(scene: &str) -> String {
    let epochs = attribution::tests::cases(2, 0.0).into_iter().map(|epoch| Epoch { scene: scene.into(), ..epoch });
    String::from_utf8(journal("attribution", epochs.map(|epoch| serde_json::to_value(epoch).unwrap()).collect()))
        .unwrap()
}

/// The text of a journal.
fn journal(study: &str, cases: Vec<serde_json::Value>) -> Vec<u8> {
    let header = serde_json::json!({
        "schema": Header::SCHEMA, "study": study, "settings": { "seed": 1 }, "provenance": provenance(&format!("sahara study {study}"))
    });
    let lines = cases.iter().enumerate().map(|(i, case)| serde_json::json!({ "key": i.to_string(), "case": case }));
    std::iter::once(header).chain(lines).map(|line| format!("{line}\n")).collect::<String>().into_bytes()
}

/// Journals of the studies of curves.
fn curves(scene: &str) -> [(&'static str, Vec<u8>); 4] {
    let epoch = |triangles: usize, number: usize| {
        let ns: [&[u64]; 3] = [&[90_000, 91_000], &[40_000, 41_000], &[30_000, 30_500]];
        let structures = [("median-kd", 1000, ns[0]), ("sah-kd", 5000, ns[1]), ("obvhs-bvh2", 9000, ns[2])];
        let grown = structures.map(|(label, build, ns)| (label, build * triangles as u64, ns));
        epoch::example(&format!("{scene} {triangles}"), triangles, number, &grown)
    };
    let epochs: Vec<Epoch> = [20, 320, 5120].iter().flat_map(|&n| [epoch(n, 0), epoch(n, 1)]).collect();
    let json = |epoch: &Epoch| serde_json::to_value(epoch).unwrap();
    let depth = |epoch: &Epoch| serde_json::json!([["primary", (epoch.triangles as f64).log2()]]);
    [
        (
            "scaling.jsonl",
            journal("scaling", epochs.iter().map(|e| serde_json::json!({ "family": "spheres", "epoch": e })).collect()),
        ),
        ("break-even.jsonl", journal("break-even", epochs.iter().map(json).collect())),
        ("costs.jsonl", journal("costs", epochs.iter().map(json).collect())),
        (
            "crossover.jsonl",
            journal(
                "crossover",
                epochs
                    .iter()
                    .map(|e| serde_json::json!({ "layers": e.triangles, "complexity": depth(e), "epoch": e }))
                    .collect(),
            ),
        ),
    ]
}

pub(super) fn runs_folder(files: &[(&str, Vec<u8>)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// Why paths cannot be read.
fn refused(paths: &[PathBuf]) -> super::RunError {
    Runs::read(paths, &Studies::builtin()).err().expect("it cannot be read")
}

pub(super) fn read(folder: &Path) -> Runs {
    Runs::read(&[folder.to_path_buf()], &Studies::builtin()).unwrap()
}

/// Two rays, of which one meets a triangle that one of two structures misses.
fn inspector(scene: &str) -> Inspector {
    let hit = Answer { hit: Some(InspectedHit { t: 0.1, triangle: 7, weights: [0.25, 1.0 / 3.0] }), wrong: "" };
    let (miss, missed) = (Answer { hit: None, wrong: "" }, Answer { hit: None, wrong: "missed" });
    let ray = |pixel, truth: &Answer, answers: &[&Answer]| InspectedRay {
        pixel,
        text: "0.0,0.0,0.0 1.0,0.0,0.0".into(),
        truth: truth.clone(),
        answers: answers.iter().map(|&answer| answer.clone()).collect(),
    };
    let structure = |label: &str, answers: [usize; 2]| InspectedStructure {
        label: label.into(),
        nodes: vec![3, 4],
        tests: vec![12, 0],
        answers: answers.into(),
        ..InspectedStructure::default()
    };
    Inspector {
        size: [2, 2],
        which: "Some".into(),
        command: format!("sahara validate {scene} --ray"),
        rays: vec![ray(0, &hit, &[&hit, &missed]), ray(3, &miss, &[&miss])],
        structures: vec![structure(scene, [0, 0]), structure("b", [1, 0])],
    }
}

/// Everything there is, from a scene called `scene`.
fn whole(scene: &str) -> (Document, Runs) {
    let files = [
        ("compare.json", to_json(&records_of(scene))),
        ("accuracy.jsonl", accuracy(scene)),
        ("attribution.jsonl", attribution_journal(scene).into_bytes()),
    ];
    let runs = read(runs_folder(&[&files[..], &curves(scene)].concat()).path());
    let thumbnail = |name: &str| Thumbnail {
        name: name.into(),
        note: "12 triangles".into(),
        alt: format!("{name}, rendered"),
        png: vec![1, 2, 3],
        size: [2, 2],
    };
    let figure = |id: &str, art: Art| Figure {
        id: id.into(),
        caption: "A caption".into(),
        alt: "A picture".into(),
        command: "sahara render".into(),
        art,
        data: Table::default(),
    };
    let overlay = Overlay {
        heading: scene.into(),
        pictures: vec![thumbnail(scene), thumbnail("b")],
        colours: Colours::Ramp {
            title: "Work".into(),
            colours: vec!["#000000".into(), "#ffffff".into()],
            ticks: vec![(0.0, "0".into()), (1.0, "10".into())],
        },
        inspector: Some(Box::new(inspector(scene))),
    };
    let line = Line { label: scene.into(), note: String::new(), points: vec![], mark: Mark::Both };
    let curves = Curves::logarithmic("x", "y", vec![line]);
    let pictures = Section {
        id: "pictures",
        title: "Pictures",
        blocks: vec![
            Block::Figure(figure("gallery", Art::Gallery(vec![thumbnail(scene)]))),
            Block::Figure(figure("overlay", Art::Overlay(overlay))),
            Block::Figure(figure("curves", Art::Chart(Chart::Curves(curves)))),
            Block::Note(scene.into()),
        ],
    };
    (document(&runs, vec![pictures]), runs)
}

/// [`whole`] of an ordinary scene, made once.
pub(super) fn cube() -> &'static (Document, Runs) {
    static CUBE: OnceLock<(Document, Runs)> = OnceLock::new();
    CUBE.get_or_init(|| whole("Cube"))
}

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
    let document = document(&read(runs_folder(&[("compare.json", to_json(&both))]).path()), vec![]);
    let ids: Vec<&str> = document.figures().into_iter().map(|figure| figure.id.as_str()).collect();
    assert_eq!(ids, ["tradeoff", "speed-a-b", "speed-a-b-v2"]);
}

#[test]
fn the_same_runs_give_the_same_page() {
    // The folder of the runs is another one each time, and is named where the numbers come from.
    let forms = |document: &Document| {
        let sections = document.sections.iter().filter(|section| section.id != "provenance").cloned().collect();
        let document = Document { sections, ..document.clone() };
        (page(&document), super::markdown::markdown(&document), super::latex::latex(&document))
    };
    assert_eq!(forms(&cube().0), forms(&whole("Cube").0));
}

#[test]
fn a_part_that_is_not_there_is_named_with_its_command() {
    let runs = read(runs_folder(&[("compare.json", to_json(&records_of("Dragon")))]).path());
    let whole = document(&runs, vec![]);
    assert_eq!(whole.answer.verdict, "Yes, on Dragon");
    assert_eq!(whole.answer.numbers[0].number, "8.00 ×");
    let missing: Vec<&str> = whole.missing().iter().map(|missing| missing.command.as_str()).collect();
    assert!(missing.iter().any(|command| command.starts_with("sahara replicate")), "{missing:?}");
    assert!(missing.iter().any(|command| command.starts_with("sahara study attribution")), "{missing:?}");
    assert!(missing.iter().all(|command| !command.starts_with("sahara compare")), "{missing:?}");
    let page = page(&whole);
    assert!(missing.iter().all(|command| page.contains(&command.replace('/', "&#x2f;"))));

    let attributed = runs_folder(&[("attribution.jsonl", attribution_journal("Lucy").into_bytes())]);
    let answer = document(&read(attributed.path()), vec![]).answer;
    assert_eq!((answer.verdict.as_str(), answer.numbers.len()), ("Yes, on Lucy", 1));

    let nothing = document(&read(runs_folder(&[("a.jsonl", accuracy("Cube"))]).path()), vec![]);
    assert_eq!(nothing.answer.verdict, "Not measured");
    assert_eq!(nothing.sections.len(), 2, "the study that was measured, and where its numbers come from");

    // A comparison of other scenes leads with what it has measured.
    let own = document(&read(runs_folder(&[("compare.json", to_json(&records_of("Cube")))]).path()), vec![]);
    assert_eq!(own.title, "Which structure is the fastest on Cube?");
    assert!(own.answer.sentences[0].contains(own.answer.verdict.split(' ').next().unwrap()), "{:?}", own.answer);
    assert!(own.answer.sentences.last().unwrap().contains("sahara replicate"), "{:?}", own.answer);
}

#[test]
fn the_newest_run_of_a_scene_counts_and_the_older_one_is_said_to_be_replaced() {
    let older = runs_folder(&[("old.json", to_json(&[records_of("Dragon"), records_of("Cube")].concat()))]);
    std::thread::sleep(std::time::Duration::from_millis(20));
    let mut newer = records_of("Dragon");
    newer.iter_mut().for_each(|record| record.build_ns = 77);
    let newer = runs_folder(&[("new.json", to_json(&newer))]);
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
    let journal = attribution_journal("Cube");
    let other = journal.replacen("\"attribution\"", "\"astrology\"", 1);
    let broken = journal.replacen("\"epoch\":", "\"epic\":", 1);
    let cases: [(&str, Vec<u8>, &str); 8] = [
        ("torn.json", torn, "torn"),
        ("empty.json", vec![], "torn"),
        ("text.json", b"hello".to_vec(), "torn"),
        ("other.json", b"{\"a\": 1}".to_vec(), "no run of sahara"),
        ("list.json", b"[1, 2]".to_vec(), "no run of sahara"),
        ("old.json", b"[{\"workload_hash\": \"1\"}]".to_vec(), "another version"),
        ("astrology.jsonl", other.into_bytes(), "astrology"),
        ("broken.jsonl", broken.into_bytes(), "line 2"),
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

#[test]
fn a_journal_that_is_being_written_is_read_as_far_as_it_goes() {
    let text = attribution_journal("Cube") + "{\"key\":\"two\",\"ca";
    let runs = read(runs_folder(&[("attribution.jsonl", text.into_bytes())]).path());
    assert_eq!(runs.answers.of::<attribution::AttributionStudy>().unwrap().len(), 1);
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
