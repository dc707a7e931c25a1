//! How fast structures were from commit to commit.

use crate::page::runs::Runs;
use crate::report::document::{Art, Block, Figure, Section};
use crate::report::number::{figures, plural};
use crate::report::plot::{Chart, CurvePoint, Curves, Line, Mark, Scale};
use crate::report::words::{interval, listed, slug};
use crate::report::{Cell, Table, Tone};
use crate::study::history::{Series, Step, series};

const TITLE: &str = "How fast were the structures from commit to commit?";

/// Nothing where no run was kept.
pub fn section(runs: &Runs) -> Option<Section> {
    let series = series(&runs.history);
    if series.is_empty() {
        return None;
    }
    let note = "A change is real if its interval does not hold 1, corrected for looking at every structure in every pair of neighbouring \
                runs. Times are relative to obvhs in the same rounds; runs of another machine, name or compiler setting, and those that \
                measured all epochs in one process, are another series.";
    let blocks = series.iter().flat_map(blocks).chain([Block::Note(note.into())]).collect();
    Some(Section { id: "history", title: TITLE, blocks })
}

/// The name of a series.
fn name(series: &Series) -> String {
    let first = &series.runs[0];
    let p = &first.provenance;
    let process = if p.process_per_epoch { "" } else { ", all epochs in one process" };
    format!("{}, {}, {}, {}{process}", first.baseline, p.cpu, p.simd, plural(p.threads, "thread"))
}

/// A commit as an axis names it: its first digits, with a plus where the sources differed from it.
fn short(commit: &str) -> String {
    let (digits, changes) = commit.split_once('+').map_or((commit, ""), |(digits, _)| (digits, "+"));
    format!("{digits:.7}{changes}")
}

/// A run, as tables name it.
fn run(series: &Series, number: usize) -> String {
    let p = &series.runs[number].provenance;
    format!("{} of {}", p.commit, p.date.split('T').next().unwrap_or(&p.date))
}

fn blocks(series: &Series) -> Vec<Block> {
    let last = series.runs.len() - 1;
    let command = &series.runs[last].provenance.command;
    let mut blocks = vec![Block::Text(sentence(series))];
    if last > 0 {
        blocks.push(Block::figure(figure(series, command)));
    }
    if !series.changes.is_empty() {
        blocks.push(Block::table(changes(series), command));
    }
    blocks.push(Block::Fold(format!("All runs of {}", name(series)), vec![Block::table(runs(series), command)]));
    blocks
}

fn sentence(series: &Series) -> String {
    let kept = plural(series.runs.len(), "run");
    let last = series.runs.len() - 1;
    let of_last: Vec<String> = series.changes.iter().filter(|step| step.run == last).map(told).collect();
    let changed = match (last, of_last.is_empty()) {
        (0, _) => "a second one tells what changed".to_owned(),
        _ if !series.is_compared(last) => {
            format!(
                "the last one, {}, is of other scenes or rays than the one before: nothing is compared",
                run(series, last)
            )
        }
        (_, true) => format!("the last one, {}, is not distinguishable from the one before", run(series, last)),
        (_, false) => format!("in the last one, {}, {}", run(series, last), listed(&of_last)),
    };
    format!("{}: {kept} kept; {changed}.", name(series))
}

fn told(step: &Step) -> String {
    format!("{} takes {} times as long as before", step.structure, interval(step.time))
}

fn changes(series: &Series) -> Table {
    let row = |step: &Step| {
        let tone = if step.time.is_above(1.0) { Tone::Wrong } else { Tone::Best };
        vec![
            run(series, step.run).into(),
            step.structure.as_str().into(),
            Cell::from(if step.time.is_above(1.0) { "slower" } else { "faster" }).with(tone),
            interval(step.time).into(),
        ]
    };
    let columns = ["run", "structure", "change", "time / time before"];
    Table::new("Changes that are real", columns, series.changes.iter().map(row))
}

fn runs(series: &Series) -> Table {
    let labels = series.structures();
    let rows = (0..series.runs.len()).map(|number| {
        let speeds = labels
            .iter()
            .map(|label| series.speed(number, label).map_or(Cell::blank(), |speed| interval(speed).into()));
        [Cell::from(run(series, number).as_str())].into_iter().chain(speeds).collect()
    });
    let columns = ["run"].into_iter().chain(labels.iter().copied()).map(String::from).collect();
    let title = "Times as fast as obvhs, geometric mean over the rays of the baseline".into();
    Table { title, columns, rows: rows.collect(), notes: vec![] }
}

fn figure(series: &Series, command: &str) -> Figure {
    let line = |label: &str| {
        let point = |n: usize| {
            let is_marked = series.changes.iter().any(|step| step.run == n && step.structure == label);
            Some(CurvePoint { is_marked, ..CurvePoint::of((n + 1) as f64, series.speed(n, label)?) })
        };
        Line::new(label, Mark::Both, (0..series.runs.len()).filter_map(point))
    };
    let labels = series.structures();
    let lines = labels.iter().map(|label| line(label)).collect();
    let last = series.runs.len() - 1;
    let told =
        labels.iter().filter_map(|label| Some(format!("{label} {}", figures(series.speed(last, label)?.estimate))));
    let told: Vec<String> = told.collect();
    let y_title = "times as fast as obvhs";
    let x_names = series.runs.iter().map(|run| short(&run.provenance.commit)).collect();
    let curves = Curves::logarithmic("commit of the run, the oldest first", y_title, lines);
    let curves = Curves { x_scale: Scale::Linear, x_names, ..curves };
    let rings = if series.changes.is_empty() { "" } else { " Rings: changes that are real." };
    Figure {
        id: format!("history-{}", slug(&series.runs[0].baseline)),
        caption: format!("{}: speed of each kept run, with its interval.{rings}", name(series)),
        alt: format!("Line chart over {}. In the last one: {}.", plural(last + 1, "run"), told.join("; ")),
        command: command.into(),
        art: Art::Chart(Chart::Curves(curves)),
        data: runs(series),
    }
}
