//! The paper: a fixed text in which placeholders are replaced.

use super::{COMMAND, FIGURES, Files, RunFacts, TABLES};
use crate::page::document::Document;
use crate::page::runs::Runs;
use crate::report::markdown::{blocks, escaped, prose};
use crate::report::words::listed;
use crate::report::{Art, Block, Table, csv, wrapped};

/// Names in double braces are placeholders.
const FRAME: &str = include_str!("paper.md");

pub const ANSWER: &str = "answer.svg";

/// The maximum number of figures per study.
const FIGURES_SHOWN: usize = 2;

/// A table with more than `LONG` rows becomes a CSV file.
const LONG: usize = 8;

/// A table with one of these title prefixes never becomes a CSV file.
const WHOLE: [&str; 2] = [CLAIMS, "Speed relative"];

/// The first word of the title of the claims table.
const CLAIMS: &str = "Claims";

pub fn path(id: &str) -> String {
    format!("{FIGURES}/{id}.svg")
}

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

fn list<'a>(sentences: impl Iterator<Item = &'a str>) -> String {
    let items: Vec<String> =
        sentences.map(|sentence| format!("- {}\n", wrapped(&prose(sentence), 118).join("\n  "))).collect();
    if items.is_empty() { String::new() } else { items.concat() + "\n" }
}

fn answer(document: &Document) -> String {
    let answer = &document.answer;
    let mut text = String::new();
    if !answer.banner.is_empty() {
        text += &format!("> **{}**\n\n", prose(&answer.banner));
    }
    let reason = if answer.verdict == "Yes" { ": the whole intervals of all three speedups lie above 2" } else { "" };
    text += &format!("**{}** {}{reason}.\n\n", prose(&document.title), prose(&answer.verdict));
    text += &list(answer.sentences.iter().map(String::as_str));
    if answer.chart.is_some() {
        text += &format!("![The answer: speedup over the report's tree]({FIGURES}/{ANSWER})\n");
    }
    text
}

fn results(document: &Document, runs: &Runs) -> (String, Files) {
    let (mut text, mut tables) = (String::new(), vec![]);
    for (own, run) in document.sections.iter().filter_map(|own| runs.of(own.id).map(|run| (own, run))) {
        let found: Vec<&str> = run.report.sentences().collect();
        let (mut figures, others, mut files) = (0, tables.len(), vec![]);
        let mut shown = |block: &Block| match block {
            Block::Figure(figure) if matches!(figure.art, Art::Chart(_)) => {
                figures += 1;
                (figures <= FIGURES_SHOWN).then(|| block.clone())
            }
            Block::Table(table) if table.of_scene => None,
            Block::Table(table) if is_long(table) => {
                let name = format!("{}-{}.csv", own.id, tables.len() - others + 1);
                files.push(format!("{} ({TABLES}/{name}, {} rows)", table.title, table.rows.len()));
                tables.push((name, csv::table(table)));
                None
            }
            Block::Table(table) if table.title.starts_with(CLAIMS) => {
                Some(Block::Table(Table { title: String::new(), ..table.clone() }))
            }
            Block::Text(words) if found.contains(&words.as_str()) => None,
            Block::Text(_) | Block::Table(_) => Some(block.clone()),
            _ => None,
        };
        let shown: Vec<Block> = own.blocks.iter().filter_map(&mut shown).collect();
        text += &format!("## {}\n\n", escaped(own.title));
        let is_new = |sentence: &&str| !document.answer.sentences.iter().any(|own| own == sentence);
        text += &list(found.into_iter().filter(is_new));
        blocks(&shown, &mut text);
        if !files.is_empty() {
            text += &paragraph(&format!("Long tables: {}.", files.join("; ")));
        }
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
