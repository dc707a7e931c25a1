//! Speed against error, judged by exact arithmetic.

use super::{AccuracyRecord, figure, legend, tables};
use crate::report::Table;
use crate::report::document::{Art, Block, Figure};
use crate::report::number::{count, figures};
use crate::report::plot::Chart;
use crate::report::words::scene_name;
use crate::report::words::slug;

pub fn blocks(records: &[AccuracyRecord], command: &str) -> Vec<Block> {
    let mut blocks = vec![Block::Text(
        "Exact arithmetic decides for every ray what it truly meets. Kinds of rays are never added up: each fails in its own \
         way. On the front are those that nothing beats in both speed and error."
            .into(),
    )];
    for (i, of_kind) in records.chunk_by(|a, b| a.rays == b.rays && a.scene == b.scene).enumerate() {
        blocks.push(Block::Figure(one(i, of_kind, command)));
        let table = tables(of_kind, &legend()).remove(0);
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
            "{name}, {} rays: share of wrong answers against time. Lower and further left is better; both axes are \
             logarithmic.",
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
        art: Art::Chart(Chart::Points(figure(records))),
        data: Table::of_texts(
            "",
            ["structure", "triangle test", "ns per ray", "error", "error at most", "on the front"],
            rows.collect(),
        ),
    }
}
