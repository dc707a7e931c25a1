//! The same node, leaf and walk over four ways to divide the triangles.

use super::rows::{Partitions, Row};
use super::table::{LEGEND, all_scenes, table};
use crate::measure::Estimate;
use crate::report::document::{Art, Block, Figure};
use crate::report::number::count;
use crate::report::plot::{Bar, BarGroup, Bars, Chart};
use crate::report::words::{bare, distinct, interval, listed, short_labels, slug};
use crate::report::{Statement, Table};

/// Each partition against the fastest obvhs, from the scene where it gains least to the one where it gains most.
pub fn statements(rows: &[Row]) -> Vec<Statement> {
    let range = |structure: &String| {
        let speeds = rows.iter().filter(|row| row.structure == *structure).filter_map(|row| row.all);
        let mut speeds: Vec<Estimate> = speeds.collect();
        speeds.sort_by(|a, b| a.estimate.total_cmp(&b.estimate));
        let (least, most) = (speeds.first()?, speeds.last()?);
        let most = if speeds.len() > 1 { format!(" to {}", interval(*most)) } else { String::new() };
        Some(format!("{} {}{most}", bare(structure), interval(*least)))
    };
    let told: Vec<String> = distinct(rows.iter().map(|row| &row.structure)).iter().filter_map(range).collect();
    let scenes = distinct(rows.iter().map(|row| &row.scene));
    let scenes = if scenes.len() > 3 { format!("{} scenes", scenes.len()) } else { listed(&scenes) };
    let sentence = format!(
        "As multiples of the speed of the fastest obvhs over all its presets, on {scenes} and over the same triangle test: {}.",
        listed(&told)
    );
    (!told.is_empty()).then(|| Statement::new("obvhs", sentence)).into_iter().collect()
}

pub fn blocks(answer: &Partitions, command: &str) -> Vec<Block> {
    let mut blocks = vec![Block::Text(LEGEND.join(" "))];
    blocks.extend(all_scenes(answer).map(|table| Block::table(table, command)));
    for of_scene in answer.rows.chunk_by(|a, b| a.scene == b.scene) {
        blocks.push(Block::figure(figure(of_scene, command)));
        blocks.push(Block::table(table(of_scene), command));
    }
    blocks
}

fn figure(rows: &[Row], command: &str) -> Figure {
    let labels: Vec<String> = rows.iter().map(|row| row.structure.clone()).collect();
    let labels = short_labels(&labels);
    let workloads = distinct(rows.iter().flat_map(|row| &row.cells).map(|cell| &cell.workload));
    let bar = |row: &Row, workload: &String| {
        let speed = row.cells.iter().find(|cell| cell.workload == *workload).and_then(|cell| cell.speed);
        speed.map_or(Bar::Missing("no time".into()), Bar::Of)
    };
    let group = |workload: &String| BarGroup {
        title: format!("{workload} rays"),
        bars: rows.iter().map(|row| bar(row, workload)).collect(),
    };
    let text = |row: &Row| {
        let cells = row.cells.iter().map(|cell| cell.speed.map_or(String::new(), interval));
        std::iter::once(row.structure.clone()).chain(cells).map(Into::into).collect()
    };
    let data = Table {
        title: String::new(),
        columns: std::iter::once("structure".to_owned()).chain(workloads.iter().cloned()).collect(),
        rows: rows.iter().map(text).collect(),
        notes: vec![],
    };
    let groups: Vec<BarGroup> = workloads.iter().map(group).collect();
    let first = &rows[0];
    Figure {
        id: format!("partitions-{}", slug(&first.scene)),
        caption: format!(
            "{}, {} triangles: speed as a multiple of the fastest obvhs on the same rays, over all its presets and both \
             layouts. Whiskers are 95 % intervals.",
            first.scene,
            count(first.triangles as u64)
        ),
        alt: format!(
            "Bar chart of {} structures on {} kinds of rays of {}; the numbers follow.",
            rows.len(),
            workloads.len(),
            first.scene
        ),
        command: command.into(),
        art: Art::Chart(Chart::Bars(Bars {
            x_title: "times as fast as the fastest obvhs".into(),
            reference: 1.0,
            labels,
            groups,
        })),
        data,
    }
}
