//! The files of a report: the page, Markdown, figures and data.

use super::document::{Document, Section};
use super::html::page;
use super::runs::Runs;
use crate::report::markdown::{blocks, escaped, prose};
use crate::report::plot::WIDTH;
use crate::report::{Art, Figure, csv};

/// Returns the path and the content of each file. The paths are relative to the folder of the report.
pub fn files(document: &Document, runs: &Runs) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![
        ("index.html".to_owned(), page(document).into_bytes()),
        ("report.md".into(), markdown(document).into_bytes()),
    ];
    files.extend(document.figures().into_iter().flat_map(of_figure));
    let with_data = runs.studies.iter().filter(|run| !run.report.data.rows.is_empty());
    files.extend(with_data.map(|run| (format!("data/{}.csv", run.study.name), csv::table(&run.report.data))));
    files
}

fn of_figure(figure: &Figure) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![];
    let path = |ending: &str| format!("figures/{}.{ending}", figure.id);
    if let Art::Chart(chart) = &figure.art {
        files.push((path("svg"), chart.svg(WIDTH).into_bytes()));
    }
    let pictures = figure.pictures().iter().enumerate();
    files.extend(pictures.map(|(i, picture)| (figure.picture_path(i), picture.png.clone())));
    if !figure.data.columns.is_empty() {
        files.push((path("csv"), csv::table(&figure.data)));
    }
    files
}

pub fn markdown(document: &Document) -> String {
    let mut text = format!("# {}\n\n", escaped(&document.title));
    if !document.answer.banner.is_empty() {
        text += &format!("> **{}**\n\n", escaped(&document.answer.banner));
    }
    text += &format!("**{}.**\n\n", escaped(&document.answer.verdict));
    for number in &document.answer.numbers {
        text += &format!("- {}: **{}** {}\n", escaped(&number.label), escaped(&number.number), number.interval);
    }
    for sentence in &document.answer.sentences {
        text += &format!("\n{}\n", prose(sentence));
    }
    text.push('\n');
    document.sections.iter().for_each(|own| section(own, &mut text));
    text.trim_end().to_owned() + "\n"
}

fn section(section: &Section, text: &mut String) {
    *text += &format!("## {}\n\n", escaped(section.title));
    blocks(&section.blocks, text);
    if !section.command.is_empty() {
        *text += &format!("```console\n{}\n```\n\n", section.command);
    }
}
