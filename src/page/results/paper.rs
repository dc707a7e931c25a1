//! The paper: one fixed text around the answer and the Markdown of the reports.

use super::run_facts::RunFacts;
use super::{COMMAND, FIGURES, Files, TABLES};
use crate::page::document::{Document, Section};
use crate::page::markdown::section;
use crate::page::runs::Runs;
use crate::report::markdown::prose;
use crate::report::words::listed;
use crate::report::{Art, Block, Table, csv, wrapped};

/// The text around; a name in double braces is replaced.
const FRAME: &str = include_str!("paper.md");

pub const ANSWER: &str = "answer.svg";

/// Figures of a study in the paper; the page has all of them.
const FIGURES_SHOWN: usize = 2;

/// Tables with more rows are files beside the paper, except tables whose titles begin with these words.
const LONG: usize = 8;
const WHOLE: [&str; 2] = ["Claims", "Speed relative"];

/// The path of a figure in the paper.
pub fn path(id: &str) -> String {
    format!("{FIGURES}/{id}.svg")
}

/// The text, and the files in the folder of tables.
pub fn text(document: &Document, runs: &Runs, run: &RunFacts) -> (String, Files) {
    let (results, tables) = results(document, runs);
    let compiler = format!(
        "Compiler: {}, {}. obvhs {} with the preset very-slow, the default of sahara.",
        run.rustc, run.target, run.obvhs
    );
    let filled = [
        ("command", COMMAND.to_owned()),
        ("machine", paragraph(&run.sentence())),
        ("answer", answer(document)),
        ("commands", run.commands.join("\n")),
        ("compiler", paragraph(&compiler)),
        ("results", results),
    ];
    let fill =
        |text: String, (name, value): &(&str, String)| text.replace(&format!("{{{{{name}}}}}"), value.trim_end());
    (filled.iter().fold(FRAME.to_owned(), fill), tables)
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
    // The last section of the paper defines the verdicts.
    let reason = if answer.verdict == "Yes" { ": the whole intervals of all three speedups lie above 2" } else { "" };
    text += &format!("**{}** {}{reason}.\n\n", prose(&document.title), prose(&answer.verdict));
    text += &answer.sentences.iter().map(|sentence| paragraph(sentence)).collect::<String>();
    if answer.chart.is_some() {
        text += &format!("![The answer: speedup over the report's tree]({FIGURES}/{ANSWER})\n");
    }
    text
}

/// The sections of the studies, without folded blocks, tables of single scenes, interactive blocks, and sentences of the
/// answer; and the long tables as files.
fn results(document: &Document, runs: &Runs) -> (String, Files) {
    let (mut text, mut tables) = (String::new(), vec![]);
    for own in document.sections.iter().filter(|own| runs.of(own.id).is_some()) {
        let (mut figures, others) = (0, tables.len());
        let mut shown = |block: &Block| match block {
            Block::Figure(figure) if matches!(figure.art, Art::Chart(_)) => {
                figures += 1;
                (figures <= FIGURES_SHOWN).then(|| block.clone())
            }
            Block::Table(table) if table.of_scene => None,
            Block::Table(table) if is_long(table) => {
                let name = format!("{}-{}.csv", own.id, tables.len() - others + 1);
                let said = format!("{}: {} rows in {TABLES}/{name}.", table.title, table.rows.len());
                tables.push((name, csv::table(table)));
                Some(Block::Text(said))
            }
            Block::Text(words) if document.answer.sentences.contains(words) => None,
            Block::Text(_) | Block::Table(_) => Some(block.clone()),
            _ => None,
        };
        let blocks = own.blocks.iter().filter_map(&mut shown).collect();
        // All commands are in the section on the method.
        section(&Section { blocks, command: String::new(), ..*own }, &mut text);
    }
    let missing: Vec<String> =
        document.missing().iter().map(|own| format!("{} (`{}`)", own.what, own.command)).collect();
    if !missing.is_empty() {
        text += &paragraph(&format!("Not measured in this run: {}.", listed(&missing)));
    }
    (text, tables)
}

fn is_long(table: &Table) -> bool {
    table.rows.len() > LONG && !WHOLE.iter().any(|title| table.title.starts_with(title))
}
