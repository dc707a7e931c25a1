//! Tables and reports as text for a terminal.

use comfy_table::{Attribute, Cell as GridCell, CellAlignment, Color, ContentArrangement, Table as Grid, presets};

use super::{Block, Cell, Report, Table, Tone, wrapped};
use crate::escaped::Escaped as _;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Screen {
    /// Characters per line. If `None`, tables have unlimited width, and notes are wrapped as for 120 characters.
    pub width: Option<u16>,
    pub colour: bool,
}

/// Spaces before the first column.
const INDENT: usize = 2;

/// Spaces after each column.
const PADDING: usize = 2;

pub fn summary_tables(report: &Report) -> Vec<Table> {
    let shared = report.tables().filter(|table| !table.of_scene).cloned();
    shared.chain(report.verdict_table()).collect()
}

pub fn note(block: &Block) -> Option<String> {
    if let Block::Note(words) = block { Some(words.clone()) } else { None }
}

/// Columns that do not fit on the screen are printed below the other columns. The first column is then repeated.
pub fn table(table: &Table, screen: Screen) -> String {
    let table = table.clone().without_empty_columns();
    let title = table.title.escaped();
    let title = if screen.colour { format!("\x1b[1m{title}\x1b[0m") } else { title.to_string() };
    let mut text = if table.title.is_empty() { String::new() } else { title + "\n" };
    for columns in blocks(&table, screen.width.map(usize::from)) {
        text.extend(grid(&table, &columns, screen).lines().map(|line| format!("{}\n", line.trim_end())));
    }
    let width = usize::from(screen.width.unwrap_or(120)).saturating_sub(4).max(20);
    let notes = table.notes.iter().flat_map(|note| wrapped(&note.escaped().to_string(), width));
    text.extend(notes.map(|line| format!("  {line}\n")));
    text
}

const ABOVE: char = '…';

/// A label `sah-kd:leaf=4` below the label `sah-kd` becomes `…:leaf=4`.
pub fn with_short_names(mut table: Table) -> Table {
    let names: Vec<String> = table.rows.iter().map(|row| row.first().map_or(String::new(), Cell::text)).collect();
    let mut has_short = false;
    for (names, row) in names.windows(2).zip(table.rows.iter_mut().skip(1)) {
        if let Some(keys) = names[1].strip_prefix(&names[0]).filter(|keys| keys.starts_with(':') && keys.len() > 1) {
            row[0] = Cell::from(format!("{ABOVE}{keys}")).with(row[0].tone);
            has_short = true;
        }
    }
    if has_short {
        table.notes.push(format!("{ABOVE}: the structure of the row above with these options."));
    }
    table
}

/// Escapes control characters in the text.
fn printed(cell: &Cell) -> String {
    cell.text().escaped().to_string()
}

/// Splits the columns into blocks that fit on the screen.
fn blocks(table: &Table, width: Option<usize>) -> Vec<Vec<usize>> {
    let widest = |i: usize| {
        let cells = table.rows.iter().map(|row| printed(&row[i]).chars().count());
        cells.chain([table.columns[i].chars().count()]).max().unwrap_or(0) + PADDING
    };
    if table.columns.is_empty() {
        return vec![];
    }
    let mut blocks = vec![vec![0]];
    let mut used = INDENT + widest(0);
    for column in 1..table.columns.len() {
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

fn grid(table: &Table, columns: &[usize], screen: Screen) -> String {
    let mut grid = Grid::new();
    grid.load_preset(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled);
    grid.set_header(columns.iter().map(|&i| {
        let cell = GridCell::new(&table.columns[i]);
        if screen.colour { cell.add_attribute(Attribute::Bold) } else { cell }
    }));
    for row in &table.rows {
        grid.add_row(columns.iter().map(|&i| {
            let printed = GridCell::new(printed(&row[i]));
            match row[i].tone {
                Tone::Best if screen.colour => printed.fg(Color::Green),
                Tone::Wrong if screen.colour => printed.fg(Color::Red),
                _ => printed,
            }
        }));
    }
    for (i, column) in grid.column_iter_mut().enumerate() {
        column.set_padding((if i == 0 { INDENT as u16 } else { 0 }, PADDING as u16));
        let is_words = table.is_words(columns[i]);
        column.set_cell_alignment(if is_words { CellAlignment::Left } else { CellAlignment::Right });
    }
    if screen.colour {
        grid.enforce_styling();
    } else {
        grid.force_no_tty();
    }
    grid.to_string()
}

#[cfg(test)]
mod tests {
    use super::super::table::tests::example;
    use super::*;

    #[test]
    fn without_colour_there_is_no_escape_and_no_line_ends_in_blanks() {
        let text = table(&example(), Screen { width: None, colour: false });
        assert!(!text.contains('\x1b'), "{text:?}");
        assert!(text.lines().all(|line| line == line.trim_end()), "{text:?}");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "Cube");
        assert_eq!(lines[1].split_whitespace().collect::<Vec<_>>(), ["structure", "Mrays/s"]);
        assert_eq!(lines[4], "  a note of some words");
        // Numbers are aligned to the right.
        assert_eq!(lines[1].len(), lines[2].len());
    }

    #[test]
    fn colour_says_nothing_new() {
        let [plain, loud] = [false, true].map(|colour| table(&example(), Screen { width: Some(80), colour }));
        let (first, rest) = loud.split_once('\x1b').unwrap();
        let stripped: String = rest.split('\x1b').map(|part| part.split_once('m').unwrap().1).collect();
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&(first.to_owned() + &stripped)), words(&plain));
    }

    #[test]
    fn a_narrow_screen_is_not_exceeded() {
        let mut wide = example();
        wide.columns.extend(["one", "two", "three"].map(String::from));
        wide.rows.iter_mut().for_each(|row| row.extend([123_456_u64, 1234, 12].map(Into::into)));
        for width in [26, 40, 80] {
            let text = table(&wide, Screen { width: Some(width), colour: false });
            assert!(text.lines().all(|line| line.chars().count() <= width.into()), "{text}");
            let cells = ["structure", "3/9 wrong", "123,456", "three", "1,234"];
            assert!(cells.iter().all(|cell| text.contains(cell)), "{text}");
        }
        let narrow = table(&wide, Screen { width: Some(26), colour: false });
        assert!(narrow.matches("brute|force").count() > 1, "every block begins with the first column: {narrow}");
    }
}
