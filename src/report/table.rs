//! A table as plain data.

use super::words::ONE_EPOCH;
use super::{Cell, Value};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// One line.
    pub title: String,
    pub columns: Vec<String>,
    /// Each row has one cell per column.
    pub rows: Vec<Vec<Cell>>,
    pub notes: Vec<String>,
    /// Headings of the columns that the terminal shows only with `--verbose`.
    pub details: Vec<String>,
    /// Whether the table is about one scene.
    pub of_scene: bool,
}

/// The heading of a column, and the function that makes the cells of the column.
pub type Column<'a, T> = (&'a str, &'a dyn Fn(&T) -> Cell);

impl Table {
    /// Adds a note if an estimate in the table has no interval.
    #[must_use]
    pub fn with_interval_note(mut self) -> Self {
        let has_no_interval = |cell: &Cell| matches!(cell.value, Value::Estimate(x, _) if x.interval.is_none());
        if self.rows.iter().flatten().any(has_no_interval) {
            self.notes.push(format!("{ONE_EPOCH}: no interval; use --epochs 2 or more"));
        }
        self
    }

    pub fn new(
        title: impl Into<String>,
        columns: impl IntoIterator<Item = impl Into<String>>,
        rows: impl IntoIterator<Item = Vec<Cell>>,
    ) -> Self {
        let columns = columns.into_iter().map(Into::into).collect();
        Self { title: title.into(), columns, rows: rows.into_iter().collect(), ..Self::default() }
    }

    pub fn of<T>(title: impl Into<String>, items: impl IntoIterator<Item = T>, columns: &[Column<T>]) -> Self {
        let row = |item: T| columns.iter().map(|(_, of)| of(&item)).collect();
        Self::new(title, columns.iter().map(|(name, _)| *name), items.into_iter().map(row))
    }

    pub fn of_texts<const N: usize>(title: &str, columns: [&str; N], rows: Vec<[String; N]>) -> Self {
        Self::new(title, columns, rows.into_iter().map(|row| row.map(Cell::from).into()))
    }

    pub fn push_column(&mut self, name: impl Into<String>, cells: impl IntoIterator<Item = Cell>) {
        self.columns.push(name.into());
        self.rows.iter_mut().zip(cells).for_each(|(row, cell)| row.push(cell));
    }

    pub fn with_details<'a>(self, names: impl IntoIterator<Item = &'a str>) -> Self {
        Self { details: names.into_iter().map(String::from).collect(), ..self }
    }

    pub fn without_details(self) -> Self {
        let details = self.details.clone();
        self.without_columns(&details.iter().map(String::as_str).collect::<Vec<_>>())
    }

    pub fn noted(self, notes: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { notes: notes.into_iter().map(Into::into).collect(), ..self }
    }

    pub fn of_one_scene(self) -> Self {
        Self { of_scene: true, ..self }
    }

    pub fn without_empty_columns(self) -> Self {
        let says = |i: usize| self.rows.is_empty() || self.rows.iter().any(|row| !row[i].is_empty());
        let kept = (0..self.columns.len()).map(says).collect();
        self.with_columns(kept)
    }

    pub fn without_columns(self, names: &[&str]) -> Self {
        let kept = self.columns.iter().map(|column| !names.contains(&column.as_str())).collect();
        self.with_columns(kept)
    }

    /// Always keeps the first column.
    fn with_columns(self, mut kept: Vec<bool>) -> Self {
        kept.iter_mut().take(1).for_each(|first| *first = true);
        let columns = only(self.columns, &kept);
        let rows = self.rows.into_iter().map(|row| only(row, &kept)).collect();
        Self { columns, rows, ..self }
    }

    /// Whether the column is aligned to the left.
    pub fn is_words(&self, column: usize) -> bool {
        let mut cells = self.rows.iter().map(|row| &row[column]).filter(|cell| !cell.is_empty()).peekable();
        column == 0 || cells.peek().is_some() && cells.all(Cell::is_text)
    }

    pub fn has_values(&self) -> bool {
        self.rows.iter().flat_map(|row| row.iter().skip(1)).any(|cell| !cell.is_empty())
    }
}

fn only<T>(items: Vec<T>, kept: &[bool]) -> Vec<T> {
    items.into_iter().zip(kept).filter(|(_, kept)| **kept).map(|(item, _)| item).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::{Tone, Value};
    use super::*;

    pub fn example() -> Table {
        Table {
            title: "Cube".into(),
            columns: ["structure", "Mrays/s"].map(String::from).into(),
            rows: vec![
                vec!["brute|force".into(), Cell::from(1.25).with(Tone::Best)],
                vec!["tree".into(), Cell::from(Value::Errors { wrong: 3, of: 9 }).with(Tone::Wrong)],
            ],
            notes: vec!["a note of some words".into()],
            ..Table::default()
        }
    }

    #[test]
    fn columns_that_say_nothing_are_left_out() {
        let mut wide = example();
        wide.columns.insert(1, "peak".into());
        wide.rows.iter_mut().for_each(|row| row.insert(1, Cell::empty()));
        assert_eq!(wide.clone().without_empty_columns(), example());
        assert_eq!(wide.clone().without_columns(&["peak"]), example());
        wide.rows[1][1] = "1".into();
        assert_eq!(wide.clone().without_empty_columns(), wide);
        let names = Table {
            columns: vec!["structure".into(), "all".into()],
            rows: vec![vec!["a".into(), Cell::empty()]],
            ..example()
        };
        assert!(!names.has_values() && example().has_values());
        assert_eq!(names.without_empty_columns().columns, ["structure"]);
    }
}
