//! The text of the paper.

use super::{COMMAND, FIGURES, RunFacts, portable};
use crate::page::markdown::{blocks, prose};
use crate::page::runs::Runs;
use crate::report::document::{Art, Block, Document, Figure, Section};
use crate::report::words::{distinct, listed};
use crate::report::wrapped;
use crate::study::compare::bias;
use crate::study::predictions::REST_BELOW;
use crate::study::{AnyStudy, Studies};

/// The picture of the answer.
pub const ANSWER: &str = "answer.svg";

/// Figures and tables of a study that the paper shows; the page has all.
const SHOWN: usize = 2;

/// Where the paper looks for a figure.
pub fn path(id: &str) -> String {
    format!("{FIGURES}/{id}.svg")
}

pub fn text(document: &Document, runs: &Runs, studies: &Studies, run: &RunFacts) -> String {
    let mut text = format!("# Results\n\n<!-- Made by `{COMMAND}`. Do not edit: run it again. -->\n\n");
    paragraph(&run.sentence(), &mut text);
    question(document, &mut text);
    method(runs, run, &mut text);
    text += "## Results\n\n";
    for study in studies.iter() {
        if let Some(section) = document.sections.iter().find(|section| section.id == study.name()) {
            results(study, section, runs, &mut text);
        }
    }
    let missing: Vec<String> = document.missing().iter().map(|m| format!("{} (`{}`)", m.what, m.command)).collect();
    if !missing.is_empty() {
        paragraph(&format!("Not measured in this run: {}.", listed(&missing)), &mut text);
    }
    threats(runs, run, &mut text);
    change(document, &mut text);
    text.trim_end().to_owned() + "\n"
}

fn paragraph(words: &str, text: &mut String) {
    *text += &format!("{}\n\n", wrapped(&prose(words), 120).join("\n"));
}

fn list(points: &[String], text: &mut String) {
    for point in points {
        *text += &format!("- {}\n", wrapped(&prose(point), 118).join("\n  "));
    }
    text.push('\n');
}

fn question(document: &Document, text: &mut String) {
    *text += "## Question\n\n";
    paragraph(
        "A student report builds a KD-tree that splits at the median of the vertices, measures it on twelve scenes and ends with an \
         untested claim: with a tree by the surface area heuristic (SAH) its hard scenes, Dragon, Lucy and Sponza, would have been \
         much faster. Is that true, what is it due to, and what else would have been?",
        text,
    );
    if !document.answer.banner.is_empty() {
        *text += &format!("> **{}**\n\n", prose(&document.answer.banner));
    }
    *text += &format!("## Answer\n\n**{}** {}.\n\n", prose(&document.title), prose(&document.answer.verdict));
    document.answer.sentences.iter().for_each(|sentence| paragraph(sentence, text));
    if document.answer.chart.is_some() {
        *text += &format!("![The answer: times as fast as the report's tree]({FIGURES}/{ANSWER})\n\n");
    }
}

fn method(runs: &Runs, run: &RunFacts, text: &mut String) {
    *text += "## Method\n\n";
    let names = distinct(runs.records().iter().map(|record| &record.scene));
    let structures = distinct(runs.records().iter().map(|record| &record.label));
    let compared = match names.len() {
        0 => "No comparison of all structures is in this run.".to_owned(),
        _ => format!("Compared are {} on {}.", listed(&structures), listed(&names)),
    };
    paragraph(
        &format!(
            "All structures answer the same rays behind one interface: the rays of the whole picture of a scene, kind by kind, or whole \
             tiles of them where there is not time for all. {compared} Answers are held against brute force over the same triangle test \
             before anything is timed, and wrong answers get no time."
        ),
        text,
    );
    paragraph(
        "A run has several epochs, each in a process of its own with structures built anew; within an epoch samples are taken in \
         rounds in random order. A ratio is of times of the same round on the same rays. Its interval holds the same ratio of another \
         run, as little disturbed, in 95 % of cases: Student's t over the epochs, twice the variance for the run to come, and what two builds of the same \
         structure differ by (A/A). Where many findings are judged together each interval allows for the others.",
        text,
    );
    *text += &format!("```console\n{}\n```\n\n", run.commands.join("\n"));
    paragraph(
        &format!(
            "Compiler: {}, {}. obvhs {}, by its default preset where none is named.",
            run.rustc, run.target, run.obvhs
        ),
        text,
    );
}

/// The statements of a study, and of what its section shows at once the first figures and tables.
fn results(study: &dyn AnyStudy, section: &Section, runs: &Runs, text: &mut String) {
    *text += &format!("### {}\n\n", section.title);
    let statements = runs.answers.get(study.name()).map_or(0, |answer| study.statements(answer).len());
    let points: Vec<String> = section.blocks.iter().take(statements).filter_map(words).collect();
    list(&points, text);
    let (mut figures, mut tables) = (0, 0);
    let kept: Vec<Block> = section.blocks[statements..]
        .iter()
        .filter(|block| match block {
            Block::Figure(figure) if matches!(figure.art, Art::Chart(_)) => {
                figures += 1;
                figures <= SHOWN
            }
            Block::Table(_) => {
                tables += 1;
                tables <= SHOWN
            }
            Block::Text(_) => true,
            _ => false,
        })
        .cloned()
        .map(alone)
        .collect();
    let mut body = String::new();
    blocks(&kept, &mut body);
    *text += &body.replace("\n### ", "\n#### ").replace("####  \n\n", "");
    if body.starts_with("### ") {
        // The first table follows its heading at once.
        let at = text.len() - body.len();
        text.insert(at, '#');
    }
    let commands: Vec<String> = runs.command(study).lines().map(portable).collect();
    *text += &format!("```console\n{}\n```\n\n", commands.join("\n"));
}

fn words(block: &Block) -> Option<String> {
    if let Block::Text(words) = block { Some(words.clone()) } else { None }
}

/// As the paper shows it: the command is told once for the study, and what was folded is not there.
fn alone(block: Block) -> Block {
    match block {
        Block::Table(tabular) => Block::table(tabular.table, ""),
        Block::Figure(figure) => Block::figure(Figure { command: String::new(), ..*figure }),
        Block::Text(words) => Block::Text(words.replace(REST_BELOW, "")),
        other => other,
    }
}

fn threats(runs: &Runs, run: &RunFacts, text: &mut String) {
    *text += "## Threats to validity\n\n";
    let stand_ins = runs.records().iter().filter(|record| record.stand_in);
    let stand_ins = distinct(stand_ins.map(|record| &record.scene));
    let mut points = vec![
        format!("**We are judges in our own cause.** {} The meshes shown here are of the same kinds.", bias()),
        format!("**One machine, {}.** {} with {}: on another one the order may be another.", run.threads(), run.cpu, run.simd),
        "**Intervals are of reruns.** They hold what another run of the same plan finds on this machine, not what other meshes, cameras \
         or machines would."
            .into(),
        "**Seconds of the report are of its machine and code.** Only its ratios are compared with ours.".into(),
    ];
    if !stand_ins.is_empty() {
        points.push(format!(
            "**Stand-ins.** The meshes of {} are, in whole or in part, of our own making, with as many triangles as the report's.",
            listed(&stand_ins)
        ));
    }
    let warnings = distinct(runs.provenances.iter().flat_map(|p| &p.warnings));
    if !warnings.is_empty() {
        points.push(format!("**What spoilt the run**, as it says itself: {}", warnings.join(" ")));
    }
    if run.commit.ends_with("+changes") {
        points.push("**The program was built from sources that differ from the commit.**".into());
    }
    list(&points, text);
}

fn change(document: &Document, text: &mut String) {
    *text += "## What would change our mind\n\n";
    let verdict = &document.answer.verdict;
    let conclusion = match () {
        () if verdict.starts_with("Yes") => {
            "The report's conclusion counts as true while the whole interval lies above 2. A machine or a camera on which it does not, with \
             the same meshes, would take that back (`sahara replicate`)."
        }
        () if verdict.starts_with("No") && !verdict.starts_with("Not") => {
            "The report's conclusion counts as refuted. Meshes on which the interval lies above 1 would reopen it (`sahara replicate`)."
        }
        _ => {
            "The report's question is not decided by this run. Real meshes and more epochs decide it (`sahara replicate --epochs N`)."
        }
    };
    let is_judged = document.sections.iter().any(|section| section.id == "accuracy");
    let points = [
        conclusion.to_owned(),
        "A structure, a preset or keys that are ahead of the first of a rank, by an interval that does not hold 1, on meshes that nobody \
         tuned for (`sahara compare MESH -s NAME:key=value`)."
            .into(),
        format!(
            "One ray to which a structure of ours gives an answer that exact arithmetic refutes and its own triangle test does not make \
             (`sahara validate`, `sahara validate --hard`){}.",
            if is_judged { "" } else { "; this run has no judged rays" }
        ),
        "A claim that is undecided here is decided by more epochs, either way (`sahara study predictions`).".into(),
    ];
    list(&points, text);
}
