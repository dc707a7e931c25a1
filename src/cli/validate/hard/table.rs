//! Tables of the scores of hard cases.

use crate::registry::Choice;
use crate::report::number::{count, figures, plural};
use crate::report::{Cell, Table, Tone};
use crate::request::known_defect;
use crate::validate::hard_cases::{Content, Failure, HardCase, Property, Rank, RayScore, Score};

pub struct Column<'a> {
    pub choice: &'a Choice,
    /// One score per case, in the order of the cases.
    pub scores: Vec<Score>,
}

pub const LEGEND: [&str; 4] = [
    "Dot: no error. m: missed, d: wrong depth (t off by more than 4 ulps and more than 1e-6; after the slash: off by \
     more than 1 %, or 0.1 % on another primitive), S: structure errors, all in percent of the true hits. f: false \
     hits, in percent of the rays.",
    "S counts hits confirmed by exact arithmetic that the structure lost or changed and that no rounding of the \
     triangle test explains. c: rays on which any hit, closest hit and batches contradict each other.",
    "hang, panic, crash: no result. refused: the build over this mesh failed. declined: the structure does not \
     support such rays. The true hits are exact; the ray interval is half-open.",
    "Star: not in the totals (the input is invalid, systems disagree on the correct hit, or nothing can be hit). \
     Plus: added after the survey; not in the totals.",
];

pub fn tables(cases: &[&HardCase], columns: &[Column]) -> Vec<Table> {
    let is_property = |case: &HardCase| matches!(case.content, Content::Property(_));
    let ulps = |_: &HardCase, score: &Score| {
        let ulps = score.rays()?.error_counts.ulps?;
        Some([ulps.median, ulps.p99, ulps.max].map(figures).join("/").into())
    };
    let slowness = |_: &HardCase, score: &Score| Some(format!("{} x", figures(score.rays()?.slowness?)).into());
    vec![
        outcomes(cases, columns, "Outcomes", |case| !is_property(case)),
        table(cases, columns, "Error of t in ulps on the correct primitive: median/p99/max", ulps),
        table(cases, columns, "Time of invalid rays relative to valid rays on the same mesh", slowness),
        outcomes(cases, columns, "Properties: failures", is_property),
        totals(cases, columns),
    ]
}

pub fn summary(cases: &[&HardCase], columns: &[Column]) -> Vec<Table> {
    let is_failed = |(i, _): &(usize, &&HardCase)| {
        columns.iter().any(|column| known_defect(&column.choice.entry.name).is_none() && !column.scores[*i].is_sound())
    };
    let failed: Vec<&str> = cases.iter().enumerate().filter(is_failed).map(|(_, case)| case.name).collect();
    let title = format!("Failures: {} of {}", failed.len(), plural(cases.len(), "case"));
    vec![outcomes(cases, columns, &title, |case| failed.contains(&case.name)), totals(cases, columns)]
}

fn table(
    cases: &[&HardCase],
    columns: &[Column],
    title: &str,
    cell: impl Fn(&HardCase, &Score) -> Option<Cell>,
) -> Table {
    let mut rows = vec![];
    for (i, case) in cases.iter().enumerate() {
        let cells: Vec<Option<Cell>> = columns.iter().map(|column| cell(case, &column.scores[i])).collect();
        if cells.iter().any(Option::is_some) {
            let mark = match case.rank {
                Rank::Moderate | Rank::Extreme => "",
                Rank::Unranked => "*",
                Rank::Added => "+",
            };
            let name = Cell::from(format!("{}{mark}", case.name));
            rows.push(std::iter::once(name).chain(cells.into_iter().map(Option::unwrap_or_default)).collect());
        }
    }
    let names = columns.iter().map(|column| column.choice.label.as_str());
    Table::new(title, std::iter::once("case").chain(names), rows)
}

fn outcomes(cases: &[&HardCase], columns: &[Column], title: &str, is_shown: impl Fn(&HardCase) -> bool) -> Table {
    let mut notes = vec![];
    for (i, case) in cases.iter().enumerate().filter(|(_, case)| is_shown(case)) {
        for column in columns {
            let has_defects = known_defect(&column.choice.entry.name).is_some();
            let sentence = match &column.scores[i] {
                Score::Failed(Failure::Refused(sentence) | Failure::Declined(sentence)) => Some(sentence.clone()),
                Score::Property(Property { example, .. }) if !has_defects => example.clone(),
                Score::Rays(score) if !has_defects => score.example(),
                _ => None,
            };
            notes.extend(sentence.map(|own| format!("{} on {}: {own}", column.choice.label, case.name)));
        }
    }
    table(cases, columns, title, |case, score| is_shown(case).then(|| outcome(score))).noted(notes)
}

fn outcome(score: &Score) -> Cell {
    let text = match score {
        _ if score.is_clean() => return ".".into(),
        Score::Failed(failure @ Failure::Declined(_)) => return failure.name().into(),
        Score::Failed(failure) => failure.name().into(),
        Score::Property(property) => format!("{} of {}", count(property.broken), count(property.checked)),
        Score::Rays(score) => errors(score),
    };
    Cell::from(text).with(Tone::Wrong)
}

fn errors(score: &RayScore) -> String {
    let error_counts = &score.error_counts;
    let share = |mark: &str, events: u64, of: u64| (events > 0).then(|| format!("{mark} {}", percent(events, of)));
    let coarse = percent(score.coarse_depth, error_counts.hits);
    let parts = [
        share("m", error_counts.missed, error_counts.hits),
        share("f", error_counts.false_hits, error_counts.rays),
        share("d", error_counts.wrong_depth, error_counts.hits).map(|d| format!("{d}/{coarse}")),
        share("S", score.validation.errors(), error_counts.hits),
        (score.contradictions > 0).then(|| format!("c {}", count(score.contradictions))),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

fn percent(events: u64, of: u64) -> String {
    figures(100.0 * events as f64 / of.max(1) as f64)
}

fn totals(cases: &[&HardCase], columns: &[Column]) -> Table {
    const GROUPS: [(&[Rank], &str); 2] = [(&[Rank::Moderate, Rank::Extreme], "valid"), (&[Rank::Moderate], "moderate")];
    let size = |ranks: &[Rank]| cases.iter().filter(|case| ranks.contains(&case.rank)).count();
    if size(GROUPS[0].0) == 0 {
        return Table::default();
    }
    let mut names = vec!["structure".to_owned()];
    for (ranks, kind) in GROUPS {
        names.push(format!("clean of {} {kind}", size(ranks)));
        names.extend(["m %", "d %", "d>1 %", "f", "S %", "E %"].map(String::from));
    }
    let mut most_hits = 0;
    let mut rows = vec![];
    for column in columns {
        let mut row = vec![column.choice.label.as_str().into()];
        for (ranks, _) in GROUPS {
            let of_group = cases.iter().zip(&column.scores).filter(|(case, _)| ranks.contains(&case.rank));
            let scores: Vec<&Score> = of_group.map(|(_, score)| score).collect();
            let clean = scores.iter().filter(|score| score.is_clean()).count();
            let failed = scores.iter().filter(|score| matches!(score, Score::Failed(_))).count();
            let sum = |number: fn(&RayScore) -> u64| scores.iter().filter_map(|score| score.rays()).map(number).sum();
            let hits = sum(|score| score.error_counts.hits);
            most_hits = most_hits.max(hits);
            let texts = [
                if failed > 0 { format!("{clean} (+{failed})") } else { clean.to_string() },
                percent(sum(|score| score.error_counts.missed), hits),
                percent(sum(|score| score.error_counts.wrong_depth), hits),
                percent(sum(|score| score.coarse_depth), hits),
                count(sum(|score| score.error_counts.false_hits)),
                percent(sum(|score| score.validation.errors()), hits),
                percent(sum(|score| score.error_counts.errors()), sum(|score| score.error_counts.rays)),
            ];
            row.extend(texts.map(Cell::from));
        }
        rows.push(row);
    }
    let note = format!(
        "(+n): n cases without a result, which the sums leave out. f: number of false hits. E: m, d and f together, in \
         percent of all rays. m, d and S: in percent of {}, or fewer if a structure does not trace all rays.",
        plural(most_hits as usize, "true hit")
    );
    Table::new("Totals", names, rows).noted(vec![note])
}
