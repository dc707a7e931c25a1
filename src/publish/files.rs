//! All files of a report.

use serde::Serialize;

use super::document::{Art, Document, Figure};
use super::html::page;
use super::latex::latex;
use super::markdown::markdown;
use super::runs::Runs;
use super::sections;
use crate::report::{Table, to_jsonl, to_tidy_csv};
use crate::study::{attribution, break_even, costs, crossover, parameters, scaling};

/// Width of drawings that stand alone, in their units.
const WIDTH: f64 = 900.0;

/// Paths in the folder of a report, and what is there.
pub fn files(document: &Document, runs: &Runs) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![
        ("index.html".to_owned(), page(document).into_bytes()),
        ("report.md".into(), markdown(document).into_bytes()),
        ("report.tex".into(), latex(document).into_bytes()),
    ];
    for figure in document.figures() {
        files.extend(of_figure(figure));
    }
    tidy("records", &runs.records, &mut files);
    tidy("partitions", &runs.partitions, &mut files);
    tidy("accuracy", &runs.accuracy, &mut files);
    if let Some(replication) = &runs.replication {
        tidy("rays", &replication.rays, &mut files);
        tidy("main", &replication.main, &mut files);
        tidy("settings", &replication.parameters, &mut files);
        tidy("hard", &replication.hard, &mut files);
    }
    if let Some(study) = &runs.attribution {
        tidy("attribution", &attribution::rows(&study.result), &mut files);
    }
    if let Some(study) = &runs.scaling {
        tidy("scaling", &scaling::rows(&study.result), &mut files);
    }
    if let Some(study) = &runs.break_even {
        tidy("break-even", &break_even::rows(&study.result), &mut files);
    }
    if let Some(study) = &runs.crossover {
        tidy("crossover", &crossover::rows(&study.result), &mut files);
    }
    if let Some(study) = &runs.parameters {
        tidy("parameters", parameters::rows(&study.result), &mut files);
    }
    tidy("predictions", &sections::predictions(runs), &mut files);
    if let Some(study) = &runs.costs {
        tidy("costs", &costs::rows(&study.result), &mut files);
    }
    files
}

/// Where a picture of a figure is, in the folder.
pub fn picture_name(figure: &str, index: usize) -> String {
    format!("figures/{figure}-{}.png", index + 1)
}

fn of_figure(figure: &Figure) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![];
    let path = |ending: &str| format!("figures/{}.{ending}", figure.id);
    match &figure.art {
        Art::Chart(chart) => {
            files.push((path("svg"), chart.svg(WIDTH).into_bytes()));
            files.push((path("png"), chart.png(WIDTH)));
        }
        Art::Gallery(pictures) => {
            files.extend(pictures.iter().enumerate().map(|(i, p)| (picture_name(&figure.id, i), p.png.clone())));
        }
        Art::Overlay(overlay) => {
            let pictures = overlay.pictures.iter().enumerate();
            files.extend(pictures.map(|(i, p)| (picture_name(&figure.id, i), p.png.clone())));
        }
    }
    if !figure.data.columns.is_empty() {
        files.push((path("csv"), csv(&figure.data)));
    }
    files
}

fn tidy<T: Serialize>(name: &str, rows: &[T], files: &mut Vec<(String, Vec<u8>)>) {
    if !rows.is_empty() {
        files.push((format!("data/{name}.csv"), to_tidy_csv(rows)));
        files.push((format!("data/{name}.jsonl"), to_jsonl(rows)));
    }
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
