//! What the page says of threads.

use super::Speedup;
use super::table::{groups, table, two_points, words};
use crate::report::document::{Art, Block, Figure};
use crate::report::number::figures;
use crate::report::plot::{Chart, CurvePoint, Curves, Line, Mark};
use crate::report::words::{distinct, listed, slug, written};
use crate::report::{Statement, Table};

/// Of each scene, how much the most threads give each structure's build.
pub fn statements(speedups: &[Speedup]) -> Vec<Statement> {
    let of = |scene: &String| {
        let own: Vec<&Speedup> = speedups.iter().filter(|one| one.scene == *scene && one.what == "build").collect();
        let last = own.iter().filter_map(|one| one.points.last()).map(|point| point.threads).max()?;
        let parts = own.iter().filter_map(|one| {
            let point = one.points.last().filter(|point| point.threads == last)?;
            let times = written(point.speedup, figures);
            let share = written(one.serial, |share| format!("{share:.2}"));
            Some(format!("{} {times} times as fast (serial share {share})", one.structure))
        });
        let parts: Vec<String> = parts.collect();
        let sentence = format!("On {scene}, {last} threads build {}.", listed(&parts));
        Some(Statement::new(&slug(scene), sentence).of(own.first()?.points.last()?.speedup))
    };
    distinct(speedups.iter().map(|one| &one.scene)).iter().filter_map(of).collect()
}

pub fn blocks(speedups: &[Speedup], command: &str) -> Vec<Block> {
    let mut blocks = vec![];
    for group in groups(speedups) {
        blocks.push(Block::figure(figure(&group, command)));
        blocks.push(Block::table(table(&group), command));
    }
    blocks
}

fn figure(group: &[&Speedup], command: &str) -> Figure {
    let (scene, what) = (&group[0].scene, words(&group[0].what));
    let line = |one: &&Speedup| {
        let point = |point: &super::Point| CurvePoint::of(point.threads as f64, point.speedup);
        let note = format!("f = {:.2}", one.serial.estimate);
        Line { note, ..Line::new(&one.structure, Mark::Both, one.points.iter().map(point)) }
    };
    let rows = group.iter().flat_map(|one| {
        one.points.iter().map(|p| [one.structure.clone(), p.threads.to_string(), figures(p.speedup.estimate)])
    });
    let told = group.iter().filter_map(|one| {
        let point = one.points.last()?;
        Some(format!("{}: {} times with {} threads", one.structure, figures(point.speedup.estimate), point.threads))
    });
    let told: Vec<String> = told.collect();
    let y_title = "times as fast as one thread";
    Figure {
        id: format!("threads-{}-{}", slug(scene), slug(&group[0].what)),
        caption: format!(
            "{scene}, {what}: speed over the number of threads, both axes logarithmic. Behind each name stands Amdahl's serial share f.{}",
            two_points(group).map_or(String::new(), |sentence| format!(" {sentence}"))
        ),
        alt: format!("Line chart over the number of threads. {}.", told.join("; ")),
        command: command.into(),
        art: Art::Chart(Chart::Curves(Curves::logarithmic("threads", y_title, group.iter().map(line).collect()))),
        data: Table::of_texts("", ["structure", "threads", y_title], rows.collect()),
    }
}
