//! The results as tables for people.

use super::Attribution;
use super::design::Factor;
use super::result::{CellResult, Split};
use crate::report::number::{count, figures};
use crate::report::words::{explained, interval, written};
use crate::report::{Cell, Table, Tone};

/// One row and one sentence for each scene: the answer.
pub fn headlines(results: &[Attribution]) -> Table {
    let rows = results.iter().map(|r| {
        let parts = r.time.parts.iter().map(|part| Cell::from(interval(part.times)));
        let mut row = vec![r.scene.as_str().into(), interval(r.time.whole).into()];
        row.extend(parts);
        row.push(interval(r.plane_alone).into());
        row
    });
    let mut columns = vec!["scene".to_owned(), "whole".into()];
    columns.extend(Factor::ALL.map(|factor| factor.name().to_owned()));
    columns.push("plane alone".into());
    let mut notes = vec![
        "whole: how many times faster the SAH tree is than the report's; the three parts multiply to it. plane alone: exact SAH against \
         the report's plane where both stop at 8 triangles, as far as planes divide them, and have plane intervals. [95 %: of another run of the same plan]"
            .to_owned(),
    ];
    notes.extend(results.iter().map(sentence));
    explained(Table { title: "What the SAH tree's speed is due to".into(), columns, rows: rows.collect(), notes })
}

/// `Of the 21.1-fold speedup on Dragon, the stop rule gives 9.10, the plane 1.60, the traversal 1.45`, and by the order in which
/// the three are switched.
fn sentence(r: &Attribution) -> String {
    let [plane, stop, traversal] = Factor::ALL.map(|factor| {
        let part = &r.time.parts[factor as usize];
        (figures(part.times.estimate), format!("{} to {}", figures(part.least), figures(part.most)))
    });
    format!(
        "Of the {}-fold speedup on {}, the stop rule gives {}, the plane {}, the traversal {}; by the order of switching {}, {} and {}.",
        figures(r.time.whole.estimate),
        r.scene,
        stop.0,
        plane.0,
        traversal.0,
        stop.1,
        plane.1,
        traversal.1,
    )
}

/// The tables of one scene: all trees, what each level does, what varies with what, and the same split for counts.
pub fn tables(r: &Attribution) -> Vec<Table> {
    [cells(r), levels(r), terms(r), splits(r)].map(explained).into()
}

fn cells(r: &Attribution) -> Table {
    let best = r.cells.iter().map(|cell| cell.ns_per_ray).fold(f64::INFINITY, f64::min);
    let row = |cell: &CellResult| {
        let tone = if cell.ns_per_ray == best { Tone::Best } else { Tone::Plain };
        let mark = if cell.sampled { "~" } else { "" };
        vec![
            short(cell).into(),
            Cell::from(format!("{mark}{}", figures(cell.ns_per_ray))).with(tone),
            Cell::from(interval(cell.speedup)),
            figures(cell.tests_per_ray).into(),
            figures(cell.steps_per_ray).into(),
            figures(cell.duplication).into(),
            figures(cell.build_ns * 1e-6).into(),
        ]
    };
    let samples = format!("{} epochs of {} samples", r.epochs, r.runs);
    let title = format!("{}: {} triangles, {} rays", r.scene, count(r.triangles as u64), r.workload);
    let columns = ["plane, stop, traversal", "ns/ray", "times faster [95%]", "tests", "steps", "refs", "build ms"];
    Table::new(title, columns, r.cells.iter().map(row)).noted(vec![format!(
            "{samples}. times faster: than the report's tree, the first. ns/ray ~: on a part of the rays. tests, steps: triangles tested and nodes \
             entered for each ray. refs: references for each triangle. A/A noise of all scenes: a factor of {:.3}.",
            r.aa_noise
        )])
}

fn short(cell: &CellResult) -> String {
    let plane = cell.plane.replace(" median", "");
    let traversal = cell.traversal.split(' ').next_back().unwrap_or(cell.traversal);
    format!("{plane}, {}, {traversal}", cell.stop)
}

fn levels(r: &Attribution) -> Table {
    let rows = r.main_effects.iter().map(|effect| {
        vec![
            format!("{}: {}", effect.factor, effect.level).into(),
            interval(effect.time).into(),
            figures(effect.tests).into(),
            figures(effect.steps).into(),
        ]
    });
    Table::new(format!("{}: main effects", r.scene), ["level", "time [95%]", "tests", "steps"], rows)
        .noted(vec!["As a multiple of the geometric mean of all 36 trees: below 1 is better.".into()])
}

fn terms(r: &Attribution) -> Table {
    let percent = |share: f64| format!("{:.1}", 100.0 * share);
    let rows = r.terms.iter().map(|term| {
        let time = written(term.time, percent);
        vec![term.term.as_str().into(), time.into(), percent(term.tests).into(), percent(term.steps).into()]
    });
    let title = format!("{}: what varies with what, % of the variance of the logarithms", r.scene);
    Table::new(title, ["term", "time [95%]", "tests", "steps"], rows)
        .noted(vec!["a x b: what a gives depends on b.".into()])
}

fn splits(r: &Attribution) -> Table {
    let rows = |name: &str, split: &Split| {
        let mut parts: Vec<Cell> = vec![name.into(), interval(split.whole).into()];
        let mut ranges: Vec<Cell> = vec!["  by order".into(), Cell::blank()];
        for part in &split.parts {
            parts.push(interval(part.times).into());
            ranges.push(format!("{} to {}", figures(part.least), figures(part.most)).into());
        }
        [parts, ranges]
    };
    let mut columns = vec!["times less".to_owned(), "whole".into()];
    columns.extend(Factor::ALL.map(|factor| factor.name().to_owned()));
    Table {
        title: format!("{}: from the report's tree to the SAH tree", r.scene),
        columns,
        rows: [rows("time", &r.time), rows("tests", &r.tests), rows("steps", &r.steps)].concat(),
        notes: vec![
            "The parts multiply to the whole: geometric means over all orders of switching the factors (Shapley). by order: the least \
             and the most over those orders."
                .into(),
        ],
    }
}
