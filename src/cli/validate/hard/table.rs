//! Scores as tables: cases down, structures across.

use crate::registry::Choice;
use crate::report::number::{count, figures, plural};
use crate::report::{Cell, Table, Tone};
use crate::request::known_defect;
use crate::validate::hard_cases::{Content, Failure, HardCase, Property, Rank, RayScore, Score, Totals};

/// One structure in the tables.
pub struct Column {
    /// As the user chose it.
    label: String,
    /// Whether its errors are known and described, so that no ray need be shown.
    documented: bool,
    /// One a case, in the order of the cases.
    pub scores: Vec<Score>,
}

impl Column {
    /// Without scores.
    pub fn of(choice: &Choice) -> Self {
        let documented = known_defect(&choice.entry.name).is_some();
        Self { label: choice.label.clone(), documented, scores: vec![] }
    }
}

const CLEAN: &str = ".";

/// What the tables show, once for all.
pub fn legend() -> Vec<String> {
    [
        "A dot: nothing wrong. m: missed, d: wrong depth (t off by more than 4 ulps and more than 1e-6; behind the stroke \
         those off by more than 1 %, or 0.1 % on another primitive), S: structure errors, in percent of the true hits; f: false \
         hits, in percent of the rays.",
        "S counts what the structure's own triangle test, run over all triangles, finds, exact arithmetic confirms, and the \
         structure did not return. c: rays on which any hit, closest hit and batches contradict each other.",
        "hang, panic, crash: no answers; refused: the structure does not admit the mesh; declined: it offers no answer to such rays. Truth is exact; the interval is half-open.",
        "A star: not in the totals, because the input is not valid, systems differ about what is right, or nothing can be hit; \
         a plus: added to the catalogue's measured cases.",
    ]
    .map(String::from)
    .into()
}

/// The tables of a run that have rows: answers, errors of t, times of invalid rays, properties, totals.
pub fn tables(cases: &[&HardCase], columns: &[Column]) -> Vec<Table> {
    let all = [
        answers(cases, columns),
        table(cases, columns, "t error in ulps where the primitive is right: median/p99/max", ulps),
        table(cases, columns, "Time of invalid rays over that of valid ones on the same mesh", slowness),
        properties(cases, columns),
        totals(cases, columns),
    ];
    all.into_iter().filter(|table| !table.rows.is_empty()).collect()
}

fn head(first: &str, columns: &[Column]) -> Vec<String> {
    std::iter::once(first.into()).chain(columns.iter().map(|column| column.label.clone())).collect()
}

fn name(case: &HardCase) -> Cell {
    let mark = match case.rank {
        Rank::Moderate | Rank::Extreme => "",
        Rank::Unranked => "*",
        Rank::Added => "+",
    };
    format!("{}{mark}", case.name).into()
}

/// Rows for the cases about which `cell` has something to say.
fn table(cases: &[&HardCase], columns: &[Column], title: &str, cell: fn(&Score) -> Option<Cell>) -> Table {
    let mut rows = vec![];
    for (i, case) in cases.iter().enumerate() {
        let cells: Vec<Option<Cell>> = columns.iter().map(|column| cell(&column.scores[i])).collect();
        if cells.iter().any(Option::is_some) {
            rows.push(std::iter::once(name(case)).chain(cells.into_iter().map(Option::unwrap_or_default)).collect());
        }
    }
    Table::new(title, head("case", columns), rows)
}

fn answers(cases: &[&HardCase], columns: &[Column]) -> Table {
    let mut notes = vec![];
    let mut rows = vec![];
    for (i, case) in cases.iter().enumerate() {
        if matches!(case.content, Content::Property(_)) {
            continue;
        }
        rows.push(std::iter::once(name(case)).chain(columns.iter().map(|column| answer(&column.scores[i]))).collect());
        for column in columns {
            let said = match &column.scores[i] {
                Score::Rays(RayScore { example: Some(example), .. }) if !column.documented => example,
                Score::Failed(Failure::Refused(sentence) | Failure::Declined(sentence)) => sentence,
                _ => continue,
            };
            notes.push(format!("{} on {}: {said}", column.label, case.name));
        }
    }
    Table::new("Answers", head("case", columns), rows).noted(notes)
}

fn answer(score: &Score) -> Cell {
    let score = match score {
        Score::Rays(_) if score.is_clean() => return CLEAN.into(),
        Score::Failed(failure @ Failure::Declined(_)) => return failure.name().into(),
        Score::Failed(failure) => return Cell::from(failure.name()).with(Tone::Wrong),
        Score::Property(_) => return Cell::empty(),
        Score::Rays(score) => score,
    };
    let judged = &score.judged;
    let share = |mark: &str, events: u64, of: u64| match events {
        0 => None,
        _ => Some(format!("{mark} {}", percent(events, of))),
    };
    let parts = [
        share("m", judged.missed, judged.hits),
        share("f", judged.false_hits, judged.rays),
        share("d", judged.wrong_depth, judged.hits)
            .map(|d| format!("{d}/{}", percent(score.coarse_depth, judged.hits))),
        share("S", score.structure_errors.unwrap_or(0), judged.hits),
        (score.contradictions > 0).then(|| format!("c {}", count(score.contradictions))),
    ];
    Cell::from(parts.into_iter().flatten().collect::<Vec<_>>().join(" ")).with(Tone::Wrong)
}

fn percent(events: u64, of: u64) -> String {
    figures(100.0 * events as f64 / of.max(1) as f64)
}

fn ulps(score: &Score) -> Option<Cell> {
    let Score::Rays(RayScore { judged, .. }) = score else { return None };
    judged.ulps.map(|ulps| [ulps.median, ulps.p99, ulps.max].map(figures).join("/").into())
}

fn slowness(score: &Score) -> Option<Cell> {
    let Score::Rays(RayScore { slowness, .. }) = score else { return None };
    slowness.map(|times| format!("{} x", figures(times)).into())
}

fn properties(cases: &[&HardCase], columns: &[Column]) -> Table {
    let mut notes = vec![];
    for (i, case) in cases.iter().enumerate() {
        for column in columns.iter().filter(|column| !column.documented) {
            if let Score::Property(Property { example: Some(example), .. }) = &column.scores[i] {
                notes.push(format!("{} on {}: {example}", column.label, case.name));
            }
        }
    }
    Table { notes, ..table(cases, columns, "Properties: failures", property) }
}

fn property(score: &Score) -> Option<Cell> {
    match score {
        Score::Property(property) if property.broken == 0 => Some(CLEAN.into()),
        Score::Property(property) => {
            let text = format!("{} of {}", count(property.broken), count(property.checked));
            Some(Cell::from(text).with(Tone::Wrong))
        }
        _ => None,
    }
}

/// What every structure did wrong on the ranked cases that were run.
fn totals(cases: &[&HardCase], columns: &[Column]) -> Table {
    const BOTH: [(&[Rank], &str); 2] = [(&[Rank::Moderate, Rank::Extreme], "valid"), (&[Rank::Moderate], "moderate")];
    let of = |column: &Column, ranks: &[Rank]| Totals::over(cases.iter().copied().zip(&column.scores), ranks);
    let mut names = vec!["structure".to_owned()];
    let Some(first) = columns.first() else { return Table::default() };
    let sizes = BOTH.map(|(ranks, _)| of(first, ranks).cases);
    if sizes[0] == 0 {
        return Table::default();
    }
    for ((_, kind), size) in BOTH.iter().zip(sizes) {
        names.extend([
            format!("clean of {size} {kind}"),
            "m %".into(),
            "d %".into(),
            "d>1 %".into(),
            "f".into(),
            "S %".into(),
            "E %".into(),
        ]);
    }

    let rows = columns
        .iter()
        .map(|column| {
            let mut row: Vec<Cell> = vec![column.label.as_str().into()];
            for (ranks, _) in BOTH {
                let sums = of(column, ranks);
                let failed = if sums.failed > 0 { format!(" (+{})", sums.failed) } else { String::new() };
                row.push(format!("{}{failed}", sums.clean).into());
                row.push(percent(sums.missed, sums.hits).into());
                row.push(percent(sums.wrong_depth, sums.hits).into());
                row.push(percent(sums.coarse_depth, sums.hits).into());
                row.push(count(sums.false_hits).into());
                row.push(percent(sums.structure_errors, sums.hits).into());
                row.push(percent(sums.errors(), sums.rays).into());
            }
            row
        })
        .collect::<Vec<Vec<Cell>>>();
    let hits = columns.iter().map(|column| of(column, &[Rank::Moderate, Rank::Extreme]).hits).max().unwrap_or(0);
    let notes = vec![format!(
        "(+n): cases without answers, whose rays are in no sum; f: false hits, as a number; E: m, d and f together, in percent of all \
         rays. {} for a structure that answers all.",
        plural(hits as usize, "true hit")
    )];
    Table::new("Totals", names, rows).noted(notes)
}
