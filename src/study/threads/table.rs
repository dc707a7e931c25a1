//! Speedups as tables for people.

use super::Speedup;
use crate::report::number::duration;
use crate::report::words::{explained, interval, written};
use crate::report::{Cell, Table};
use crate::study::grouped::grouped;

/// Of one scene and one thing each, in their order.
pub(super) fn groups(speedups: &[Speedup]) -> Vec<Vec<&Speedup>> {
    grouped(speedups, |a, b| a.scene == b.scene && a.what == b.what)
}

/// What is timed, as titles name it.
pub(super) fn words(what: &str) -> String {
    if what == "build" { "builds".into() } else { format!("{what} rays") }
}

pub(super) fn table(group: &[&Speedup]) -> Table {
    let mut numbers: Vec<usize> = group.iter().flat_map(|one| &one.points).map(|point| point.threads).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let numbers: Vec<usize> = numbers.into_iter().filter(|&threads| threads > 1).collect();
    let mut columns = vec!["structure".to_owned(), "1 thread".into()];
    columns.extend(numbers.iter().map(|threads| format!("x with {threads}")));
    columns.push("serial share".into());
    let row = |one: &&Speedup| {
        let with = |threads: usize| one.points.iter().find(|point| point.threads == threads);
        let mut row: Vec<Cell> = vec![one.structure.as_str().into()];
        row.push(with(1).map(|point| duration(point.ns)).into());
        row.extend(numbers.iter().map(|&n| with(n).map(|point| interval(point.speedup)).into()));
        row.push(written(one.serial, |share| format!("{share:.2}")).into());
        row
    };
    let rows = group.iter().map(row).collect();
    let mut notes = vec![NOTE.into()];
    notes.extend(two_points(group));
    let title = format!("{}, {}: times as fast as one thread", group[0].scene, words(&group[0].what));
    explained(Table { title, columns, rows, notes })
}

const NOTE: &str = "serial share: f of Amdahl's law, by which n threads take f + (1 - f) / n of the time of one; fitted to all numbers of \
                    threads. One thread is timed by processor time, several by the time that elapses.";

/// Said where one number of threads is all that is held against one thread, as on a machine with two cores.
pub(super) fn two_points(group: &[&Speedup]) -> Option<String> {
    let most = group.iter().map(|one| one.points.len()).max()?;
    let sentence = "Two points: Amdahl's curve goes through them whatever the truth is. More cores say how well it describes them.";
    (most == 2).then(|| sentence.into())
}
