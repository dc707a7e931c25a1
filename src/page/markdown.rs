//! The report as Markdown, with pictures beside it.

use crate::report::document::{Art, Block, Document, Figure};
use crate::report::words::ended;
use crate::report::{escaped, wrapped};

/// The text of the file.
pub fn markdown(document: &Document) -> String {
    let mut text = format!("# {}\n\n", escaped(&document.title));
    if !document.answer.banner.is_empty() {
        text += &format!("> **{}**\n\n", escaped(&document.answer.banner));
    }
    text += &format!("**{}.**\n\n", escaped(&document.answer.verdict));
    for number in &document.answer.numbers {
        text += &format!("- {}: **{}** {}\n", escaped(&number.label), escaped(&number.number), number.interval);
    }
    for sentence in &document.answer.sentences {
        text += &format!("\n{}\n", prose(sentence));
    }
    for section in &document.sections {
        text += &format!("\n## {}\n\n", escaped(section.title));
        blocks(&section.blocks, &mut text);
    }
    text
}

pub fn blocks(list: &[Block], text: &mut String) {
    for block in list {
        match block {
            Block::Text(words) | Block::Note(words) => {
                *text += &format!("{}\n\n", wrapped(&prose(words), 120).join("\n"))
            }
            Block::Table(tabular) => {
                *text += &tabular.table.to_markdown();
                *text += &command(&tabular.command);
            }
            Block::Figure(f) => figure(f, text),
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
    figure.pictures().iter().enumerate().for_each(|(i, p)| image(&p.alt, &figure.picture_path(i)));
    *text += &format!("\n{}\n{}", prose(&figure.caption), command(&figure.command));
}

fn command(command: &str) -> String {
    if command.is_empty() { "\n".into() } else { format!("\n```console\n{command}\n```\n\n") }
}

/// A sentence as Markdown: what stands between backticks is code, `**` is strong, and all else is text.
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
