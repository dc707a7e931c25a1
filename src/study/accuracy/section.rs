//! Speed against error, judged by exact arithmetic.

use super::{AccuracyRecord, figure, legend, table};
use crate::report::document::{Art, Block, Figure};
use crate::report::number::{count, figures};
use crate::report::plot::{Chart, LABELLED};
use crate::report::words::{distinct, listed, scene_name, slug};
use crate::report::{Statement, Table};
use crate::study::documented_defect;

/// For each scene and kind of rays: over which triangle tests our structures are right, and over which they are wrong.
pub fn statements(records: &[AccuracyRecord]) -> Vec<Statement> {
    records.chunk_by(AccuracyRecord::is_beside).filter_map(of_kind).collect()
}

fn of_kind(records: &[AccuracyRecord]) -> Option<Statement> {
    let own = || records.iter().filter(|r| documented_defect(&r.structure).is_none());
    let first = own().next()?;
    let (mut right, mut wrong) = (vec![], vec![]);
    for test in distinct(own().map(|r| &r.triangle_test)) {
        let of_test = || own().filter(|r| r.triangle_test == test);
        let most = of_test().map(|r| r.error).fold(0.0, f64::max);
        let least = of_test().map(|r| r.error).fold(f64::INFINITY, f64::min);
        let [from, to] = [least, most].map(|error| figures(100.0 * error));
        match most {
            0.0 => right.push(test),
            _ if from != to => wrong.push(format!("{test} {from} to {to} %")),
            _ => wrong.push(format!("{test} {to} %")),
        }
    }
    let rays = count(own().map(|r| r.judged).max().unwrap_or(0));
    let right = match &right[..] {
        [] => format!("over no triangle test are all answers right in {rays} rays"),
        tests => format!("right in all of {rays} rays over {}", listed(tests)),
    };
    let wrong = if wrong.is_empty() { String::new() } else { format!("; wrong over {}", listed(&wrong)) };
    let fastest = own().filter(|r| r.errors() == 0).min_by(|a, b| a.ns_per_ray.total_cmp(&b.ns_per_ray));
    let fastest = fastest.map_or(String::new(), |r| format!("; the fastest of ours without an error is {}", r.label));
    let name = scene_name(&first.scene, first.stand_in);
    let key = slug(&format!("{} {}", first.scene, first.rays));
    Some(Statement::new(&key, format!("{name}, {} rays: our structures are {right}{wrong}{fastest}.", first.rays)))
}

pub fn blocks(records: &[AccuracyRecord], command: &str) -> Vec<Block> {
    let mut blocks = vec![Block::Text(
        "Exact arithmetic decides for every ray what it truly meets. Kinds of rays are never added up: each fails in its own \
         way. On the front are those that nothing beats in both speed and error."
            .into(),
    )];
    for (i, of_kind) in records.chunk_by(AccuracyRecord::is_beside).enumerate() {
        blocks.push(Block::figure(one(i, of_kind, command)));
        let mut table = table(of_kind);
        table.notes.extend(legend());
        let name = table.title.clone();
        blocks.push(Block::Fold(format!("Table: {name}"), vec![Block::table(table, command)]));
    }
    blocks
}

fn one(index: usize, records: &[AccuracyRecord], command: &str) -> Figure {
    let first = &records[0];
    let name = scene_name(&first.scene, first.stand_in);
    let front: Vec<String> = records
        .iter()
        .filter(|record| record.dominated_by.is_none())
        .map(|r| {
            format!(
                "{}, {} ns a ray, error at most {} %",
                r.label,
                figures(r.ns_per_ray),
                figures(100.0 * r.error_bound)
            )
        })
        .collect();
    let few = if records.len() > LABELLED {
        format!(" Of more than {LABELLED} points those that are filled are labelled.")
    } else {
        String::new()
    };
    let rows = records.iter().map(|r| {
        [
            r.label.clone(),
            r.triangle_test.clone(),
            figures(r.ns_per_ray),
            figures(r.error),
            figures(r.error_bound),
            if r.dominated_by.is_none() { "yes".into() } else { String::new() },
        ]
    });
    Figure {
        id: format!("accuracy-{}-{}-{index}", slug(&first.scene), slug(&first.rays)),
        caption: format!(
            "{name}, {} rays: share of wrong hits against time. Lower and further left is better; both axes are logarithmic. \
             Labels name the triangle test, colours the structure. Filled: nothing is faster and less wrong. Arrow: not one \
             wrong hit was seen in n rays; the dot is the upper bound with 95 % confidence, about 3/n.{few}",
            first.rays
        ),
        alt: format!(
            "Scatter plot of {} structures and triangle tests on {} {} rays. On the front: {}.",
            records.len(),
            count(first.judged),
            first.rays,
            front.join("; ")
        ),
        command: command.into(),
        art: Art::Chart(Chart::Scatter(figure(records))),
        data: Table::of_texts(
            "",
            ["structure", "triangle test", "ns per ray", "error", "error at most", "on the front"],
            rows.collect(),
        ),
    }
}
