//! Runs, pages and folders that the tests of the page share.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::measure::Provenance;
use crate::page::{RunError, Runs, document};
use crate::report::document::{Art, Block, Colours, Document, Figure, Overlay, Section, Thumbnail};
use crate::report::inspector::{Answer, InspectedHit, InspectedStructure, Inspector};
use crate::report::plot::{Chart, Curves, Line};
use crate::report::{CaseCounts, Record, Table, example_record, to_json};
use crate::study::epoch::{Epoch, RayDetails, StructureDetails, tests as epoch};
use crate::study::journal::{self, Header};
use crate::study::{Studies, attribution as study};

pub fn provenance(command: &str) -> Provenance {
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

pub fn records_of(scene: &str) -> Vec<Record> {
    ["primary", "shadow"]
        .iter()
        .flat_map(|workload| {
            [("median-kd", 8e6), ("sah-kd", 1e6), ("obvhs-bvh2", 9e5)]
                .map(|(label, ns)| record(scene, label, workload, ns))
        })
        .collect()
}

/// Files by their paths in a folder.
pub type Files = Vec<(String, Vec<u8>)>;

/// A journal with one scene.
pub fn accuracy(scene: &str) -> Files {
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

/// A journal with two epochs of a scene.
pub fn attribution(scene: &str) -> Files {
    let epochs = study::tests::cases(2, 0.0).into_iter().map(|epoch| Epoch { scene: scene.into(), ..epoch });
    journal("attribution", epochs.map(|epoch| serde_json::to_value(epoch).unwrap()).collect())
}

/// A journal of a comparison, one epoch of each of these scenes.
pub fn comparison(scenes: &[&str]) -> Files {
    let case = |scene: &&str| {
        let mut epoch =
            epoch::example(scene, 12, 0, &[("median-kd", 1000, &[8_000_000]), ("sah-kd", 2000, &[1_000_000])]);
        for structure in &mut epoch.structures {
            structure.details = Some(StructureDetails {
                config: serde_json::json!({}),
                triangle_test: "exact".into(),
                build_peak_bytes: None,
                counts: CaseCounts::default(),
            });
            structure.rays[0].details = Some(RayDetails::default());
        }
        serde_json::to_value(epoch).unwrap()
    };
    journal("compare", scenes.iter().map(case).collect())
}

/// A journal of spheres of so many triangles, each with so many epochs.
pub fn scaling(spheres: &[(usize, usize)]) -> Files {
    let case = |triangles: usize, number: usize| {
        let name = format!("sphere {triangles}");
        let epoch = epoch::example(&name, triangles, number, &[("sah-kd", 1000, &[90_000, 91_000])]);
        serde_json::json!({ "family": "spheres", "epoch": epoch })
    };
    let cases = spheres.iter().flat_map(|&(triangles, epochs)| (0..epochs).map(move |number| case(triangles, number)));
    journal("scaling", cases.collect())
}

/// The files of a journal.
fn journal(study: &str, cases: Vec<serde_json::Value>) -> Files {
    let header = Header::new(study, &serde_json::json!({ "seed": 1 }), provenance(&format!("sahara study {study}")));
    let file = |(i, case): (usize, serde_json::Value)| {
        let key = i.to_string();
        let text = journal::text(&header, &key, &case, |value| Ok(value.clone()));
        (format!("{study}/{}", journal::file_name(&key)), text.into_bytes())
    };
    cases.into_iter().enumerate().map(file).collect()
}

/// Journals of the studies of curves.
fn curves(scene: &str) -> Files {
    let epoch = |triangles: usize, number: usize| {
        let ns: [&[u64]; 3] = [&[90_000, 91_000], &[40_000, 41_000], &[30_000, 30_500]];
        let structures = [("median-kd", 1000, ns[0]), ("sah-kd", 5000, ns[1]), ("obvhs-bvh2", 9000, ns[2])];
        let grown = structures.map(|(label, build, ns)| (label, build * triangles as u64, ns));
        epoch::example(&format!("{scene} {triangles}"), triangles, number, &grown)
    };
    let epochs: Vec<Epoch> = [20, 320, 5120].iter().flat_map(|&n| [epoch(n, 0), epoch(n, 1)]).collect();
    let json = |epoch: &Epoch| serde_json::to_value(epoch).unwrap();
    let depth = |epoch: &Epoch| serde_json::json!([["primary", (epoch.triangles as f64).log2()]]);
    let spheres = |epoch: &Epoch| serde_json::json!({ "family": "spheres", "epoch": epoch });
    let members =
        |epoch: &Epoch| serde_json::json!({ "layers": epoch.triangles, "complexity": depth(epoch), "epoch": epoch });
    [
        journal("scaling", epochs.iter().map(spheres).collect()),
        journal("break-even", epochs.iter().map(json).collect()),
        journal("costs", epochs.iter().map(json).collect()),
        journal("crossover", epochs.iter().map(members).collect()),
    ]
    .concat()
}

pub fn runs_folder<N: AsRef<str>>(files: &[(N, Vec<u8>)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name.as_ref());
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    folder
}

/// The records of a comparison in a file.
pub fn exported(records: &[Record]) -> Files {
    vec![("compare.json".into(), to_json(&records))]
}

/// What is read of such a file.
pub fn compared(records: &[Record]) -> Runs {
    read(runs_folder(&exported(records)).path())
}

/// Why paths cannot be read.
pub fn refused(paths: &[PathBuf]) -> RunError {
    Runs::read(paths, &Studies::builtin()).err().expect("it cannot be read")
}

pub fn read(folder: &Path) -> Runs {
    Runs::read(&[folder.to_path_buf()], &Studies::builtin()).unwrap()
}

/// Two rays, of which one meets a triangle that one of two structures misses.
fn inspector(scene: &str) -> Inspector {
    let hit = Answer { hit: Some(InspectedHit { t: 0.1, triangle: 7, weights: [0.25, 1.0 / 3.0] }), wrong: "" };
    let (miss, missed) = (Answer { hit: None, wrong: "" }, Answer { hit: None, wrong: "missed" });
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
        pixels: vec![0, 3],
        rays: vec!["0.0,0.0,0.0 1.0,0.0,0.0".into(); 2],
        truths: vec![hit.clone(), miss.clone()],
        answers: vec![vec![hit, missed], vec![miss]],
        structures: vec![structure(scene, [0, 0]), structure("b", [1, 0])],
    }
}

/// Everything there is, from a scene called `scene`.
pub fn whole(scene: &str) -> (Document, Runs) {
    let files = [exported(&records_of(scene)), accuracy(scene), attribution(scene), curves(scene)].concat();
    let runs = read(runs_folder(&files).path());
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
    let line = Line { label: scene.into(), note: String::new(), points: vec![] };
    let curves = Curves { x_title: "x".into(), y_title: "y".into(), lines: vec![line] };
    let pictures = Section {
        id: "pictures",
        title: "Pictures",
        blocks: vec![
            Block::figure(figure("gallery", Art::Gallery(vec![thumbnail(scene)]))),
            Block::figure(figure("overlay", Art::Overlay(overlay))),
            Block::figure(figure("curves", Art::Chart(Chart::Curves(curves)))),
            Block::Note(scene.into()),
        ],
    };
    (document(&runs, &Studies::builtin(), vec![pictures]), runs)
}

/// [`whole`] of an ordinary scene, made once.
pub fn cube() -> &'static (Document, Runs) {
    static CUBE: OnceLock<(Document, Runs)> = OnceLock::new();
    CUBE.get_or_init(|| whole("Cube"))
}
