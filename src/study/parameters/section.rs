//! The report's sweep of its parameters: which differences are real?

use super::{Difference, Parameters, Setting, tables};
use crate::report::document::{Block, Tabular};
use crate::report::number::figures;
use crate::report::words::distinct;
use crate::report::{Cell, Statement, Table};

/// How many differences of the sweep are real.
pub fn statements(result: &Parameters) -> Vec<Statement> {
    let count = |of: &[Difference]| result.settings.iter().filter(|setting| of.contains(&setting.verdict)).count();
    let [same, open, real] =
        [&[Difference::SameTree][..], &[Difference::NotShown], &[Difference::Faster, Difference::Slower]].map(count);
    let all = same + open + real;
    let sentence = format!(
        "Of the {all} differences that the report's sweep of leaf limit and threshold shows, {same} are between identical trees, {open} \
         cannot be told from none and {real} are real."
    );
    (all > 0).then(|| Statement::new("sweep", sentence)).into_iter().collect()
}

pub fn blocks(result: &Parameters, command: &str) -> Vec<Block> {
    let mut blocks = vec![
        Block::Text(
            "The source report tries six pairs of its leaf limit L and match threshold T, once each. Here each is built \
             anew in several epochs; a difference counts as real when neither chance nor the noise of the machine \
             explains it."
                .into(),
        ),
        Block::Table(matrix(result, command)),
    ];
    blocks.extend(tables(result).into_iter().map(|table| {
        let name = format!("Table: {}", table.title);
        Block::Fold(name, vec![Block::table(table, command)])
    }));
    blocks
}

/// How strongly a cell is coloured: above 0 faster than the default, below 0 slower.
fn shade(times: f64) -> i8 {
    let size = match libm::fabs(libm::log(times)) {
        log if log < 0.02 => 0,
        log if log < 0.1 => 1,
        log if log < 0.3 => 2,
        _ => 3,
    };
    if times < 1.0 { size } else { -size }
}

/// Scenes down, settings across, the report's own numbers beside ours.
fn matrix(result: &Parameters, command: &str) -> Tabular {
    let name = |setting: &Setting| format!("{} / {}", setting.leaf, setting.threshold);
    let others = || result.settings.iter().filter(|setting| setting.verdict != Difference::Default);
    let names: Vec<String> = others().map(name).collect();
    let (names, scenes) = (distinct(names.iter()), distinct(result.settings.iter().map(|setting| &setting.scene)));
    let (mut rows, mut shades) = (vec![], vec![]);
    for scene in &scenes {
        let (mut row, mut shades_of_row) = (vec![Cell::from(scene.as_str())], vec![None]);
        for setting in &names {
            let found = others().find(|s| s.scene == *scene && name(s) == *setting);
            let times = found.and_then(|s| s.times);
            let is_real = found.is_some_and(|s| matches!(s.verdict, Difference::Faster | Difference::Slower));
            row.push(times.map(|times| figures(times.estimate)).into());
            shades_of_row.push(times.filter(|_| is_real).map(|times| shade(times.estimate)));
            row.push(found.map(|s| figures(s.report_times)).into());
            shades_of_row.push(found.map(|s| shade(s.report_times)));
        }
        rows.push(row);
        shades.push(shades_of_row);
    }
    let columns = names.iter().flat_map(|name| [name.clone(), "report".into()]);
    let table = Table {
        title: format!("Time with L / T, as a multiple of the time with {}", Parameters::default_name()),
        columns: std::iter::once("scene".to_owned()).chain(columns).collect(),
        rows,
        notes: vec![
            "Blue: faster than the default; orange: slower; the stronger, the more. Ours are coloured where the difference is real; \
             the report's are single runs, coloured as they are."
                .into(),
        ],
    };
    Tabular { table, command: command.into(), shades }
}

#[cfg(test)]
mod tests {
    use super::shade;

    #[test]
    fn faster_is_above_zero_and_little_is_nothing() {
        assert_eq!([0.5, 0.8, 0.95, 0.99, 1.0, 1.01, 1.05, 1.2, 2.0].map(shade), [3, 2, 1, 0, 0, 0, -1, -2, -3]);
    }
}
