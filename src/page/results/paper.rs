//! The paper: one fixed text around the answer and the Markdown of the reports.

use super::run_facts::{RunFacts, portable};
use super::{COMMAND, FIGURES};
use crate::page::document::{Document, Section};
use crate::page::markdown::section;
use crate::page::runs::Runs;
use crate::report::markdown::prose;
use crate::report::words::listed;
use crate::report::{Art, Block, wrapped};

/// The text around; a name in double braces is replaced.
const FRAME: &str = include_str!("paper.md");

pub const ANSWER: &str = "answer.svg";

/// Figures of a study in the paper; the page has all of them.
const FIGURES_SHOWN: usize = 2;

/// The path of a figure in the paper.
pub fn path(id: &str) -> String {
    format!("{FIGURES}/{id}.svg")
}

pub fn text(document: &Document, runs: &Runs, run: &RunFacts) -> String {
    let compiler = format!("Compiler: {}, {}. obvhs {} with its default preset.", run.rustc, run.target, run.obvhs);
    let filled = [
        ("command", COMMAND.to_owned()),
        ("machine", paragraph(&run.sentence())),
        ("answer", answer(document)),
        ("commands", run.commands.join("\n")),
        ("compiler", paragraph(&compiler)),
        ("results", results(document, runs)),
    ];
    let fill =
        |text: String, (name, value): &(&str, String)| text.replace(&format!("{{{{{name}}}}}"), value.trim_end());
    filled.iter().fold(FRAME.to_owned(), fill)
}

fn paragraph(words: &str) -> String {
    format!("{}\n\n", wrapped(&prose(words), 120).join("\n"))
}

fn answer(document: &Document) -> String {
    let answer = &document.answer;
    let mut text = String::new();
    if !answer.banner.is_empty() {
        text += &format!("> **{}**\n\n", prose(&answer.banner));
    }
    text += &format!("**{}** {}.\n\n", prose(&document.title), prose(&answer.verdict));
    text += &answer.sentences.iter().map(|sentence| paragraph(sentence)).collect::<String>();
    if answer.chart.is_some() {
        text += &format!("![The answer: speedup over the report's tree]({FIGURES}/{ANSWER})\n");
    }
    text
}

/// The sections of the studies, without folded blocks, tables of single scenes and interactive blocks.
fn results(document: &Document, runs: &Runs) -> String {
    let mut text = String::new();
    for own in document.sections.iter().filter(|own| runs.of(own.id).is_some()) {
        let mut figures = 0;
        let mut is_shown = |block: &&Block| match block {
            Block::Figure(figure) if matches!(figure.art, Art::Chart(_)) => {
                figures += 1;
                figures <= FIGURES_SHOWN
            }
            Block::Table(table) => !table.of_scene,
            Block::Text(_) => true,
            _ => false,
        };
        let blocks = own.blocks.iter().filter(|block| is_shown(block)).cloned().collect();
        let command = own.command.lines().map(portable).collect::<Vec<_>>().join("\n");
        section(&Section { blocks, command, ..*own }, &mut text);
    }
    let missing: Vec<String> =
        document.missing().iter().map(|own| format!("{} (`{}`)", own.what, own.command)).collect();
    if !missing.is_empty() {
        text += &paragraph(&format!("Not measured in this run: {}.", listed(&missing)));
    }
    text
}
