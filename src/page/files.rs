//! All files of a report.

use super::html::page;
use super::markdown::markdown;
use super::runs::Runs;
use crate::report::document::{Art, Document, Figure};
use crate::report::{Table, to_jsonl, to_tidy_csv};
use crate::study::{Data, Studies};

/// Width of drawings that stand alone, in their units.
const WIDTH: f64 = 900.0;

/// Paths in the folder of a report, and what is there.
pub fn files(document: &Document, runs: &Runs, studies: &Studies) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![
        ("index.html".to_owned(), page(document).into_bytes()),
        ("report.md".into(), markdown(document).into_bytes()),
    ];
    for figure in document.figures() {
        files.extend(of_figure(figure));
    }
    for study in studies.iter() {
        let answer = runs.answers.get(study.name());
        for Data { name, rows } in answer.map_or(vec![], |answer| study.data(answer)) {
            if !rows.is_empty() {
                files.push((format!("data/{name}.csv"), to_tidy_csv(&rows)));
                files.push((format!("data/{name}.jsonl"), to_jsonl(&rows)));
            }
        }
    }
    files
}

fn of_figure(figure: &Figure) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![];
    let path = |ending: &str| format!("figures/{}.{ending}", figure.id);
    if let Art::Chart(chart) = &figure.art {
        files.push((path("svg"), chart.svg(WIDTH).into_bytes()));
        files.push((path("png"), chart.png(WIDTH)));
    }
    let pictures = figure.pictures().iter().enumerate();
    files.extend(pictures.map(|(i, picture)| (figure.picture_path(i), picture.png.clone())));
    if !figure.data.columns.is_empty() {
        files.push((path("csv"), csv(&figure.data)));
    }
    files
}

/// A table as it is printed.
fn csv(table: &Table) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(vec![]);
    writer.write_record(&table.columns).expect("memory takes every write");
    for row in &table.rows {
        writer.write_record(row.iter().map(|cell| &cell.text)).expect("rows are as long as the heading");
    }
    writer.into_inner().expect("memory takes every write")
}
