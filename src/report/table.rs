//! One table, printed on a terminal or as Markdown.

use comfy_table::{Attribute, Cell as Printed, CellAlignment, Color, ContentArrangement, Table as Grid, presets};

/// A table with a title above and notes below.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// One line.
    pub title: String,
    /// The first column is text, the others are numbers and stand to the right.
    pub columns: Vec<String>,
    /// As many cells as there are columns.
    pub rows: Vec<Vec<Cell>>,
    /// One sentence each.
    pub notes: Vec<String>,
}

/// What a cell says, and how loud.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cell {
    pub text: String,
    pub tone: Tone,
}

/// How a cell stands out. Colour repeats what the text says: without it nothing is lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    #[default]
    Plain,
    /// The best of its column.
    Best,
    /// A wrong answer.
    Wrong,
}

/// Where a table is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Screen {
    /// Columns; no limit where nobody looks.
    pub width: Option<u16>,
    pub colour: bool,
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self { text, tone: Tone::Plain }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

/// What is not known is blank.
impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(text: Option<T>) -> Self {
        text.map_or(Self::blank(), Into::into)
    }
}

impl Cell {
    /// Nothing: what is not known.
    pub fn blank() -> Self {
        Self::default()
    }

    /// The same cell, as loud as `tone`.
    pub fn with(self, tone: Tone) -> Self {
        Self { tone, ..self }
    }
}

/// What stands above a column, and what its cells say of an item.
pub type Column<'a, T> = (&'a str, &'a dyn Fn(&T) -> Cell);

/// Blanks before the first column, and after every one.
const INDENT: usize = 2;
const PADDING: usize = 2;

impl Table {
    /// A table without notes.
    pub fn new<const N: usize>(
        title: impl Into<String>,
        columns: [&str; N],
        rows: impl IntoIterator<Item = Vec<Cell>>,
    ) -> Self {
        let columns = columns.map(String::from).into();
        Self { title: title.into(), columns, rows: rows.into_iter().collect(), notes: vec![] }
    }

    /// A table with a row for each of `items`, column by column, without notes.
    pub fn of<T>(title: impl Into<String>, items: impl IntoIterator<Item = T>, columns: &[Column<T>]) -> Self {
        let row = |item: T| columns.iter().map(|(_, of)| of(&item)).collect();
        let rows = items.into_iter().map(row).collect();
        Self {
            title: title.into(),
            columns: columns.iter().map(|(name, _)| (*name).into()).collect(),
            rows,
            notes: vec![],
        }
    }

    /// A table of texts, without notes.
    pub fn of_texts<const N: usize>(title: &str, columns: [&str; N], rows: Vec<[String; N]>) -> Self {
        Self::new(title, columns, rows.into_iter().map(|row| row.map(Cell::from).into()))
    }

    /// The same table with these notes.
    pub fn noted(self, notes: Vec<String>) -> Self {
        Self { notes, ..self }
    }

    /// The table in lines of at most the screen's width: columns for which there is no room follow below, after the first
    /// column once more.
    pub fn to_terminal(&self, screen: Screen) -> String {
        let title = if screen.colour { format!("\x1b[1m{}\x1b[0m", self.title) } else { self.title.clone() };
        let mut text = title + "\n";
        for columns in self.blocks(screen.width.map(usize::from)) {
            for line in self.grid(&columns, screen).lines() {
                text.push_str(line.trim_end());
                text.push('\n');
            }
        }
        for note in &self.notes {
            for line in wrapped(note, usize::from(screen.width.unwrap_or(120)).saturating_sub(4).max(20)) {
                text.push_str(&format!("  {line}\n"));
            }
        }
        text
    }

    /// The same table without the columns in which no row says anything; the first one stays.
    pub fn without_blank_columns(self) -> Self {
        let says = |i: usize| self.rows.is_empty() || self.rows.iter().any(|row| !row[i].text.is_empty());
        let kept = (0..self.columns.len()).map(says).collect();
        self.with_columns(kept)
    }

    /// The same table without the columns of these names; the first one stays.
    pub fn without_columns(self, names: &[&str]) -> Self {
        let kept = self.columns.iter().map(|column| !names.contains(&column.as_str())).collect();
        self.with_columns(kept)
    }

    /// The columns that are `kept`, and the first one.
    fn with_columns(self, mut kept: Vec<bool>) -> Self {
        kept.iter_mut().take(1).for_each(|first| *first = true);
        let columns = only(self.columns, &kept);
        let rows = self.rows.into_iter().map(|row| only(row, &kept)).collect();
        Self { columns, rows, ..self }
    }

    /// Whether it has rows that say something beside their names.
    pub fn says_something(&self) -> bool {
        self.rows.iter().flat_map(|row| row.iter().skip(1)).any(|cell| !cell.text.is_empty())
    }

    /// The columns in groups that fit side by side, the first column in each.
    fn blocks(&self, width: Option<usize>) -> Vec<Vec<usize>> {
        let widest = |i: usize| {
            let cells = self.rows.iter().map(|row| row[i].text.chars().count());
            cells.chain([self.columns[i].chars().count()]).max().unwrap_or(0) + PADDING
        };
        if self.columns.is_empty() {
            return vec![];
        }
        let mut blocks = vec![vec![0]];
        let mut used = INDENT + widest(0);
        for column in 1..self.columns.len() {
            let block = blocks.last_mut().expect("there is a block");
            if width.is_some_and(|width| block.len() > 1 && used + widest(column) - PADDING > width) {
                blocks.push(vec![0, column]);
                used = INDENT + widest(0) + widest(column);
            } else {
                block.push(column);
                used += widest(column);
            }
        }
        blocks
    }

    fn grid(&self, columns: &[usize], screen: Screen) -> String {
        let mut grid = Grid::new();
        grid.load_preset(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled);
        grid.set_header(columns.iter().map(|&i| {
            let cell = Printed::new(&self.columns[i]);
            if screen.colour { cell.add_attribute(Attribute::Bold) } else { cell }
        }));
        for row in &self.rows {
            grid.add_row(columns.iter().map(|&i| {
                let printed = Printed::new(&row[i].text);
                match row[i].tone {
                    Tone::Best if screen.colour => printed.fg(Color::Green),
                    Tone::Wrong if screen.colour => printed.fg(Color::Red),
                    _ => printed,
                }
            }));
        }
        for (i, column) in grid.column_iter_mut().enumerate() {
            column.set_padding((if i == 0 { INDENT as u16 } else { 0 }, PADDING as u16));
            column.set_cell_alignment(if i == 0 { CellAlignment::Left } else { CellAlignment::Right });
        }
        if screen.colour {
            grid.enforce_styling();
        } else {
            grid.force_no_tty();
        }
        grid.to_string()
    }

    /// The table in GitHub's Markdown.
    pub fn to_markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut text = format!("### {}\n\n", escaped(&self.title));
        text += &line(self.columns.iter().map(|name| escaped(name)).collect());
        text += &line((0..self.columns.len()).map(|i| if i == 0 { "---" } else { "---:" }.to_owned()).collect());
        for row in &self.rows {
            text += &line(
                row.iter()
                    .map(|cell| match cell.tone {
                        Tone::Plain => escaped(&cell.text),
                        Tone::Best | Tone::Wrong => format!("**{}**", escaped(&cell.text)),
                    })
                    .collect(),
            );
        }
        for note in &self.notes {
            text += &format!("\n{}\n", escaped(note));
        }
        text
    }
}

/// The `items` that are `kept`.
fn only<T>(items: Vec<T>, kept: &[bool]) -> Vec<T> {
    items.into_iter().zip(kept).filter(|(_, kept)| **kept).map(|(item, _)| item).collect()
}

/// Tables and the lines below them as one Markdown document.
pub fn to_markdown(tables: &[Table], foot: &[String]) -> Vec<u8> {
    let tables: String =
        tables.iter().map(|table| table.clone().without_blank_columns().to_markdown() + "\n").collect();
    let foot: Vec<String> = foot.iter().map(|line| escaped(line)).collect();
    (tables + &foot.join("\n\n") + "\n").into_bytes()
}

/// Text with what Markdown would read as a table or as markup marked as text.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if "|*_`<>\\~".contains(c) {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

/// The words of `text` in lines of at most `width` characters, or one word.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = vec![];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        Table {
            title: "Cube".into(),
            columns: ["structure", "Mrays/s"].map(String::from).into(),
            rows: vec![
                vec!["brute|force".into(), Cell::from("1.25").with(Tone::Best)],
                vec!["tree".into(), Cell::from("3 wrong").with(Tone::Wrong)],
            ],
            notes: vec!["a note of some words".into()],
        }
    }

    #[test]
    fn without_colour_there_is_no_escape_and_no_line_ends_in_blanks() {
        let text = table().to_terminal(Screen { width: None, colour: false });
        assert!(!text.contains('\x1b'), "{text:?}");
        assert!(text.lines().all(|line| line == line.trim_end()), "{text:?}");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "Cube");
        assert_eq!(lines[1].split_whitespace().collect::<Vec<_>>(), ["structure", "Mrays/s"]);
        assert_eq!(lines[4], "  a note of some words");
        // Numbers stand to the right.
        assert_eq!(lines[1].len(), lines[2].len());
    }

    #[test]
    fn colour_says_nothing_new() {
        let plain = table().to_terminal(Screen { width: Some(80), colour: false });
        let loud = table().to_terminal(Screen { width: Some(80), colour: true });
        let mut stripped = String::new();
        let mut rest = loud.as_str();
        while let Some((before, after)) = rest.split_once('\x1b') {
            stripped += before;
            rest = after.split_once('m').unwrap().1;
        }
        stripped += rest;
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_ne!(loud, plain);
        assert_eq!(words(&stripped), words(&plain));
    }

    #[test]
    fn a_narrow_screen_is_not_exceeded() {
        let mut wide = table();
        wide.columns.extend(["one", "two", "three"].map(String::from));
        wide.rows.iter_mut().for_each(|row| row.extend(["123456", "1234", "12"].map(Cell::from)));
        for width in [26, 40, 80] {
            let text = wide.to_terminal(Screen { width: Some(width), colour: false });
            assert!(text.lines().all(|line| line.chars().count() <= width.into()), "{text}");
            // Nothing is lost, and no cell is torn apart.
            assert!(
                ["structure", "3 wrong", "123456", "three", "1234"].iter().all(|cell| text.contains(cell)),
                "{text}"
            );
        }
        let narrow = wide.to_terminal(Screen { width: Some(26), colour: false });
        assert!(narrow.matches("brute|force").count() > 1, "every block begins with the first column: {narrow}");
    }

    #[test]
    fn columns_that_say_nothing_are_left_out() {
        let mut wide = table();
        wide.columns.insert(1, "peak".into());
        wide.rows.iter_mut().for_each(|row| row.insert(1, Cell::blank()));
        assert_eq!(wide.clone().without_blank_columns(), table());
        wide.rows[1][1] = "1".into();
        assert_eq!(wide.clone().without_blank_columns(), wide);
        let names = Table {
            columns: vec!["structure".into(), "all".into()],
            rows: vec![vec!["a".into(), Cell::blank()]],
            ..table()
        };
        assert!(!names.says_something() && table().says_something());
        assert_eq!(names.without_blank_columns().columns, ["structure"]);
    }

    #[test]
    fn markdown_has_a_rule_and_escapes_its_marks() {
        let text = table().to_markdown();
        assert!(text.starts_with("### Cube\n\n| structure | Mrays/s |\n| --- | ---: |\n"), "{text}");
        assert!(text.contains("| brute\\|force | **1.25** |\n"), "{text}");
    }
}
