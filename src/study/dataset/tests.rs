//! Checks that SCHEMA.md names all exported fields and no other fields.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::*;
use crate::measure::SubsetSamples;
use crate::request::{RayKind, RunnerRequest, StructureRequest, TWIN, WorkloadRequest};
use crate::study::case::tests::example as case;
use crate::study::epoch::tests::example as epoch;
use crate::study::epoch::{RayCounts, Rays};
use crate::study::{Check, Settings, Studies};
use crate::validate::{ErrorCounts, Kind, Ulps};

pub fn dataset(measured: Vec<Measured>) -> Dataset {
    Dataset::new(Provenance::capture(1), measured)
}

/// All optional fields are set, because the JSON may omit unset fields.
fn with_all_fields() -> Dataset {
    let runner = RunnerRequest { command: "x".into(), limit_s: 1.0, config: json!({}) };
    let mut first = Case {
        labels: [("level".into(), "7".into())].into(),
        structures: vec![StructureRequest {
            runner: Some(runner),
            skipped: Some("why".into()),
            ..StructureRequest::new("a", TWIN)
        }],
        workloads: WorkloadRequest::File { path: "a.rays".into(), hash: "11".into(), rays: Some(1) },
        settings: Settings {
            slowest: Some(4.0),
            check: Check::BruteForce { tests: 1, limit_ns: Some(1) },
            build_limit_s: Some(1.0),
            whole_counts: vec!["a".into()],
            whole: true,
            ..case("Cube", 0, &[]).settings
        },
        ..case("Cube", 0, &[])
    };
    let view = json!({ "camera": "0,0,1 0,0,0", "inside": true, "size": [4, 4] });
    first.scene.view = serde_json::from_value(view).unwrap();
    let kinds = vec![RayKind::Edge];
    let second = Case { workloads: WorkloadRequest::Hard { kinds, count: 1 }, ..case("Cube", 1, &["a"]) };

    let mut measured = epoch("Cube", 12, 0, &[("a", 50, &[1000]), ("a", 50, &[1000])]);
    for structure in &mut measured.structures {
        (structure.wrong, structure.outside) = (true, Some(1.0));
        structure.rays = vec![Rays {
            parts: vec![SubsetSamples { rays: 10, ns: vec![10] }],
            wrong: true,
            declined: Some("t_min".into()),
            checked: Some(Checked {
                rounded: 1,
                fault: Some(Kind::Lost),
                example: Some(("ray".into(), "lost".into())),
                ..Checked::default()
            }),
            counts: Some(RayCounts { whole_tests: Some(1), ..RayCounts::default() }),
            errors: Some(ErrorCounts { ulps: Some(Ulps::default()), ..ErrorCounts::default() }),
            slowest_ns: Some(1),
            ..structure.rays.remove(0)
        }];
    }
    let measured = [first, second].map(|case| Measured { case, epoch: measured.clone() });
    Dataset { notes: vec!["a note".into()], ..dataset(measured.into()) }
}

/// Collects all field names, except the keys inside `labels` and `config`.
fn fields(value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::Object(object) => {
            for (name, inner) in object {
                names.insert(name.clone());
                if !["labels", "config"].contains(&name.as_str()) {
                    fields(inner, names);
                }
            }
        }
        Value::Array(items) => items.iter().for_each(|item| fields(item, names)),
        _ => {}
    }
}

/// The names in the first column of all tables with the first heading `head`.
fn documented(text: &str, head: &str) -> BTreeSet<String> {
    let tables = text.split("\n\n").filter(|part| part.starts_with(&format!("| {head} |")));
    let cells = tables.flat_map(|table| table.lines().skip(2)).filter_map(|row| row.split('|').nth(1));
    cells.flat_map(|cell| cell.split('`').skip(1).step_by(2)).map(String::from).collect()
}

#[test]
fn every_field_and_column_is_documented_and_no_other() {
    let text = include_str!("../SCHEMA.md");
    let mut names = BTreeSet::new();
    fields(&serde_json::from_slice(&with_all_fields().to_json()).unwrap(), &mut names);
    for name in &names {
        assert!(text.contains(&format!("`{name}`")), "{name} is not documented");
    }
    let unknown: Vec<String> = documented(text, "field").difference(&names).cloned().collect();
    assert!(names.len() > 100 && unknown.is_empty(), "no such fields: {unknown:?}");

    let nothing = dataset(vec![]);
    let (_, tables) = text.split_once("\n# Tables\n").unwrap();
    for study in Studies::builtin().iter() {
        let section = tables.split("\n## ").find(|section| section.starts_with(study.name));
        let columns = (study.report)(&nothing, &study.defaults()).data.columns;
        assert_eq!(documented(section.unwrap(), "column"), BTreeSet::from_iter(columns), "{}", study.name);
    }
}
