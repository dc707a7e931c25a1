//! Writes tables and reports as GitHub Flavored Markdown.

use super::words::ended;
use super::{Art, Block, Figure, Report, Table, Tone, wrapped};

/// The output of `--export-markdown`.
pub fn report(report: &Report, foot: &[String]) -> String {
    let mut text = String::new();
    blocks(&report.blocks, &mut text);
    if let Some(verdicts) = report.verdict_table() {
        text += &(table(&verdicts) + "\n");
    }
    let lines: Vec<String> = report.sentences().map(escaped).chain(foot.iter().map(|line| escaped(line))).collect();
    text + &lines.join("\n\n") + "\n"
}

pub fn blocks(list: &[Block], text: &mut String) {
    for block in list {
        match block {
            Block::Text(words) | Block::Note(words) => {
                *text += &format!("{}\n\n", wrapped(&prose(words), 120).join("\n"));
            }
            Block::Table(own) => *text += &(table(own) + "\n"),
            Block::Figure(own) => figure(own, text),
            Block::Missing(missing) => {
                let what = ended(&missing.what);
                *text += &format!("Not measured: {} `{}` measures it.\n\n", escaped(&what), missing.command);
            }
            Block::Fold(name, inner) => {
                *text += &format!("**{}**\n\n", escaped(name));
                blocks(inner, text);
            }
        }
    }
}

fn figure(figure: &Figure, text: &mut String) {
    let mut image =
        |alt: &str, path: &str| *text += &format!("![{}]({path})\n", escaped(alt).replace('[', "(").replace(']', ")"));
    if matches!(figure.art, Art::Chart(_)) {
        image(&figure.alt, &format!("figures/{}.svg", figure.id));
    }
    figure.pictures().iter().enumerate().for_each(|(i, picture)| image(&picture.alt, &figure.picture_path(i)));
    *text += &format!("\n{}\n\n", prose(&figure.caption));
}

pub fn table(table: &Table) -> String {
    let heading = if table.title.is_empty() { String::new() } else { format!("### {}\n\n", escaped(&table.title)) };
    let notes: String = table.notes.iter().map(|note| format!("\n{}\n", escaped(note))).collect();
    let table = table.clone().without_empty_columns();
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text = heading + &line(table.columns.iter().map(|name| escaped(name)).collect());
    text +=
        &line((0..table.columns.len()).map(|i| if table.is_words(i) { "---" } else { "---:" }.to_owned()).collect());
    for row in &table.rows {
        let cell = |cell: &super::Cell| match cell.tone {
            _ if cell.is_empty() => String::new(),
            Tone::Plain => escaped(&cell.text()),
            Tone::Best | Tone::Wrong => format!("**{}**", escaped(&cell.text())),
        };
        text += &line(row.iter().map(cell).collect());
    }
    text + &notes
}

pub fn escaped(text: &str) -> String {
    let marked = |c: char| "|*_`<>\\~".contains(c).then_some('\\').into_iter().chain([c]);
    text.chars().flat_map(marked).collect()
}

/// Escapes text, except code spans and `**`. If a backtick is unpaired, the whole text is escaped.
pub fn prose(text: &str) -> String {
    let pieces = text.split('`').collect::<Vec<_>>();
    if pieces.len().is_multiple_of(2) {
        return escaped(text);
    }
    let of = |(i, piece): (usize, &&str)| match i % 2 {
        1 => format!("`{piece}`"),
        _ => piece.split("**").map(escaped).collect::<Vec<_>>().join("**"),
    };
    pieces.iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::table::tests::example;
    use super::super::{Finding, Missing};
    use super::*;

    #[test]
    fn a_table_has_a_rule_and_escapes_its_marks() {
        let text = table(&example());
        assert!(text.starts_with("### Cube\n\n| structure | Mrays/s |\n| --- | ---: |\n"), "{text}");
        assert!(text.contains("| brute\\|force | **1.25** |\n"), "{text}");
    }

    #[test]
    fn a_report_has_its_blocks_then_its_sentences_and_the_foot() {
        let missing = Missing { what: "The rest".into(), command: "sahara x".into() };
        let blocks = vec![Block::Fold("All".into(), vec![example().into()]), Block::Missing(missing)];
        let findings = vec![Finding::new("a", "It is `fast`.")];
        let text = report(&Report { blocks, findings, ..Report::default() }, &["on a machine".into()]);
        let places =
            ["**All**", "### Cube", "Not measured: The rest. `sahara x`", "It is \\`fast\\`.", "on a machine\n"];
        let places: Vec<usize> = places.iter().map(|part| text.find(part).expect(part)).collect();
        assert!(places.is_sorted(), "{text}");
    }
}
