//! The report as Markdown, with pictures beside it.

use super::document::{Document, Section};
use crate::report::markdown::{blocks, escaped, prose};

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
    text.push('\n');
    document.sections.iter().for_each(|own| section(own, &mut text));
    text.trim_end().to_owned() + "\n"
}

/// A section under its heading, with its commands at the end.
fn section(section: &Section, text: &mut String) {
    *text += &format!("## {}\n\n", escaped(section.title));
    blocks(&section.blocks, text);
    if !section.command.is_empty() {
        *text += &format!("```console\n{}\n```\n\n", section.command);
    }
}
