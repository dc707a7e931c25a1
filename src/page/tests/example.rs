//! Studies, runs and folders for the tests of the page.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, OnceLock};

use clap::{ArgMatches, Command};

use crate::measure::{Estimate, Provenance};
use crate::page::{Document, RunError, Runs, Section, document};
use crate::report::plot::{Bar, BarGroup, Bars, Chart, Curves, Line, Point, Scatter};
use crate::report::words::slug;
use crate::report::{
    Art, Block, Cell, ClaimVerdict, Colours, Figure, Finding, Outcome, Overlay, Picture, Report, Table, Tone, Value,
};
use crate::study::case::tests as case;
use crate::study::epoch::tests as epoch;
use crate::study::measurement::measurements;
use crate::study::{Case, Dataset, Measured, Plan, Presets, Studies, Study};

/// Three studies with invented results.
pub static STUDIES: LazyLock<Studies> = LazyLock::new(|| {
    Studies::empty()
        .with(study("attribution", "What is it due to?", attribution))
        .with(study("compare", "How fast is every structure?", compare))
        .with(study("replicate", "Is the conclusion true?", replicate))
});

fn study(name: &'static str, question: &'static str, report: fn(&Dataset, &ArgMatches) -> Report) -> Study {
    let (presets, options) = (Presets::default(), || Command::new("options"));
    Study { name, question, presets, options, plan: |_, _| Ok(Plan::default()), report }
}

/// The speedup of the SAH tree on every scene.
fn ratio() -> Estimate {
    Estimate::between(8.0, 7.0, 9.0)
}

fn titles(dataset: &Dataset) -> Vec<String> {
    dataset.scenes().iter().map(|scene| scene.case.scene_title()).collect()
}

fn attribution(dataset: &Dataset, _: &ArgMatches) -> Report {
    let titles = titles(dataset);
    let bar = |title: &String| (title.clone(), Bar::Product(vec![4.0, 2.0], ratio()));
    let parts = vec!["plane".into(), "traversal".into()];
    let bars = Bars::of_products("times as fast", parts, titles.iter().map(bar));
    let findings = titles.iter().flat_map(|title| {
        let sentence = format!("On {title} the plane gives 4, the traversal 2.");
        [
            Finding::number(format!("whole-{}", slug(title)), ratio()),
            Finding::new(format!("split-{}", slug(title)), sentence),
        ]
    });
    let blocks = vec![Block::figure(figure("attribution", Art::Chart(Chart::Bars(bars))))];
    Report { findings: findings.collect(), blocks, ..Report::default() }
}

fn compare(dataset: &Dataset, _: &ArgMatches) -> Report {
    let measured = measurements(dataset);
    let row = |own: &crate::study::measurement::Measurement| {
        vec![own.scene.clone().into(), own.label.clone().into(), own.mrays_per_s.into(), own.shape.leaves.into()]
    };
    let data = Table::new("", ["scene", "label", "mrays_per_s", "leaves"], measured.iter().map(row));
    let mut blocks = vec![];
    for title in titles(dataset) {
        let bars = Bars {
            x_title: "times as fast".into(),
            labels: vec!["sah-kd".into()],
            parts: vec![],
            groups: vec![BarGroup { title: title.clone(), bars: vec![Bar::Of(ratio())] }],
        };
        let rows = [
            vec!["sah-kd".into(), Cell::ratio(ratio()).with(Tone::Best), "right".into()],
            vec!["median-kd".into(), Cell::from(Value::Errors { wrong: 3, of: 9 }).with(Tone::Wrong), Cell::empty()],
        ];
        let table = Table::new(title.clone(), ["structure", "x", "verdict"], rows).of_one_scene();
        blocks.push(Block::Table(table.noted(vec![title.clone()])));
        let id = format!("speed-{}", slug(&title));
        blocks.push(Block::figure(figure(&id, Art::Chart(Chart::Bars(bars)))));
    }
    blocks.push(Block::Fold("More".into(), vec![Block::Note(titles(dataset).join(" "))]));
    let findings = vec![
        Finding::new("right", "Of all structures sah-kd is the fastest.").with_value(ratio()),
        Finding::named("fastest", "sah-kd"),
        Finding::new("checked", "None is wrong"),
    ];
    Report { findings, blocks, data, warnings: vec!["the clock was slow".into()], ..Report::default() }
}

fn replicate(dataset: &Dataset, _: &ArgMatches) -> Report {
    let of = |title: String| Finding::number(format!("hard-{}", slug(&title)), ratio());
    let findings = titles(dataset).into_iter().map(of);
    let hard = Finding::new("hard", "Primary rays are 8.00 times as fast.").with_value(ratio());
    let verdict = ClaimVerdict {
        prediction: 1,
        claim: "Cube: rays".into(),
        expected: "at least 20".into(),
        value: Some(ratio()),
        outcome: Outcome::Refuted,
    };
    Report { findings: std::iter::once(hard).chain(findings).collect(), verdicts: vec![verdict], ..Report::default() }
}

pub fn figure(id: &str, art: Art) -> Figure {
    let data = Table::new("", ["structure", "x"], [vec!["sah-kd".into(), Cell::from(ratio())]]);
    Figure { id: id.into(), caption: "A caption".into(), alt: "A picture".into(), art, data }
}

pub fn provenance(date: &str) -> Provenance {
    Provenance {
        commit: "c0ffee".into(),
        cpu: "a processor".into(),
        load: None,
        date: date.into(),
        ..Provenance::capture(1)
    }
}

/// Epoch 0 of a scene, with two structures and invented times.
pub fn measured(study: &str, scene: &str) -> Measured {
    let structures: [(&str, u64, &[u64]); 2] = [("median-kd", 1000, &[8000, 8100]), ("sah-kd", 5000, &[1000, 1100])];
    let case = case::example(scene, 0, &structures.map(|own| own.0));
    let command = format!("/opt/somewhere/sahara study {study} --dir runs");
    let case = Case { study: study.into(), epochs: 1, command, ..case };
    Measured { case, epoch: epoch::example(scene, 12, 0, &structures) }
}

pub type Files = Vec<(String, Vec<u8>)>;

pub fn journal(study: &str, scenes: &[&str], provenance: &Provenance) -> Files {
    let file = |scene: &&str| {
        let Measured { case, epoch } = measured(study, scene);
        let fields = serde_json::json!({
            "schema": Dataset::SCHEMA, "provenance": provenance, "case": case, "epoch": epoch,
        });
        (format!("{study}/{}-{}.json", slug(scene), slug(&provenance.date)), fields.to_string().into_bytes())
    };
    scenes.iter().map(file).collect()
}

pub fn export(study: &str, scenes: &[&str], provenance: &Provenance) -> Files {
    let dataset = Dataset::new(provenance.clone(), scenes.iter().map(|scene| measured(study, scene)).collect());
    vec![(format!("{study}-{}.json", slug(&provenance.date)), dataset.to_json())]
}

pub fn folder<N: AsRef<str>>(files: &[(N, Vec<u8>)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name.as_ref());
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    folder
}

pub fn read(folder: &Path) -> Runs<'static> {
    Runs::read(&[folder.to_path_buf()], &STUDIES).unwrap()
}

pub fn runs(studies: &[(&str, &[&str])]) -> Runs<'static> {
    let provenance = provenance("2026-01-02T03:04:05Z");
    let files: Vec<Files> = studies.iter().map(|(study, scenes)| journal(study, scenes, &provenance)).collect();
    read(folder(&files.concat()).path())
}

pub fn refused(path: PathBuf) -> RunError {
    Runs::read(&[path], &STUDIES).err().expect("it cannot be read")
}

/// A page with each variant of `Art`, `Chart` and `Colours`.
pub fn whole(scene: &str) -> (Document, Runs<'static>) {
    let runs = runs(&[("compare", &[scene]), ("attribution", &[scene]), ("replicate", &[scene])]);
    let picture = |name: &str| Picture {
        name: name.into(),
        note: "12 triangles".into(),
        alt: format!("{name}, rendered"),
        png: vec![1, 2, 3],
        size: [2, 2],
    };
    let overlay = Overlay {
        heading: scene.into(),
        pictures: vec![picture(scene), picture("b")],
        colours: Colours::Ramp {
            title: "Work".into(),
            colours: vec!["#000000".into(), "#ffffff".into()],
            ticks: vec![(0.0, "0".into()), (1.0, "10".into())],
        },
        inspector: serde_json::json!({ "command": format!("sahara validate {scene} --ray") }),
    };
    let key = Overlay { colours: Colours::Key(vec![("#ff0000".into(), "missed".into())]), ..overlay.clone() };
    let line = Line { label: scene.into(), note: String::new(), points: vec![] };
    let curves = Curves { x_title: "x".into(), y_title: "y".into(), lines: vec![line] };
    let point = Point { x: 1.0, y: 1.0, is_bound: false, is_front: true, label: scene.into(), group: scene.into() };
    let scatter = Scatter { x_title: "x".into(), y_title: "y".into(), points: vec![point] };
    let arts = [
        ("gallery", Art::Gallery(vec![picture(scene)])),
        ("overlay", Art::Overlay(overlay)),
        ("overlay", Art::Overlay(key)),
        ("curves", Art::Chart(Chart::Curves(curves))),
        ("scatter", Art::Chart(Chart::Scatter(scatter))),
    ];
    let blocks = arts.map(|(id, art)| Block::figure(figure(id, art))).into();
    let pictures = Section { id: "pictures", title: "Pictures", command: "sahara render".into(), blocks };
    (document(&runs, &STUDIES, vec![pictures]), runs)
}

pub fn cube() -> &'static (Document, Runs<'static>) {
    static CUBE: OnceLock<(Document, Runs)> = OnceLock::new();
    CUBE.get_or_init(|| whole("Cube"))
}
