//! Checks the paper, README and the data file against each other.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use super::{COMMAND, DATA, Results, ResultsData, digest, fill, marked};
use crate::measure::Provenance;
use crate::page::tests::example::{STUDIES, cube, folder, journal, provenance, read, runs};
use crate::page::{Runs, document};

fn file(path: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    fs::read(&path).unwrap_or_else(|cause| panic!("{}: {cause}", path.display()))
}

fn readme() -> String {
    String::from_utf8(file("README.md")).unwrap()
}

fn data() -> ResultsData {
    serde_json::from_slice(&file(&format!("papers/{DATA}"))).unwrap()
}

#[test]
fn readme_and_paper_match_the_data_file() {
    let data = data();
    for (name, known) in &data.files {
        assert_eq!(
            digest(&file(&format!("papers/{name}"))),
            *known,
            "papers/{name} does not match its digest in the data file: `{COMMAND}` writes it again"
        );
    }
    for (key, text) in marked(&readme()).unwrap() {
        let known = data.statements.get(&key).map(|known| known.text.split_whitespace().collect::<Vec<_>>().join(" "));
        assert_eq!(Some(text), known, "README.md, {key}: not as in the data file: `{COMMAND}` writes it again");
    }
}

#[test]
fn readme_is_short() {
    assert!(readme().len() <= 8192, "{} bytes", readme().len());
    let long = readme().lines().find(|line| line.chars().count() > 120 && !line.starts_with('|')).map(String::from);
    assert_eq!(long, None);
}

#[test]
fn marked_places_are_filled_in_and_wrapped() {
    let text = "# A\n\n- **Fast.** <!-- sahara: a.b -->old\nold<!-- / --> and more.\n- Next\n\n\
                <!-- sahara: t -->x<!-- / -->\n";
    assert_eq!(marked(text).unwrap()[0], ("a.b".to_owned(), "old old".to_owned()));
    let long = "word ".repeat(30);
    let filled = fill(text, |key| Some(if key == "t" { "| a |\n| - |".into() } else { long.trim().into() })).unwrap();
    assert!(filled.lines().all(|line| line.chars().count() <= 120), "{filled}");
    assert!(filled.contains("\n  word word"), "the paragraph is indented as before: {filled}");
    assert!(filled.contains("<!-- sahara: t -->\n\n| a |\n| - |\n\n<!-- / -->\n"), "{filled}");
    let again = fill(&filled, |key| Some(if key == "t" { "| a |\n| - |".into() } else { long.trim().into() })).unwrap();
    assert_eq!(again, filled);
    assert_eq!(fill(&filled, |_| None).unwrap(), filled);
    let open = marked("<!-- sahara: k --> never closed").unwrap_err().to_string();
    assert!(open.contains("\"k\" is not closed"), "{open}");
}

fn results(runs: &Runs) -> anyhow::Result<Results> {
    Results::new(&document(runs, &STUDIES, vec![]), runs)
}

fn assert_files_match_paper(results: &Results) {
    let paper = results.paper.replace('\n', " ");
    for (name, _) in &results.tables {
        assert_eq!(paper.matches(&format!("(results/{name}, ")).count(), 1, "{name}");
    }
    assert_eq!(paper.matches("(results/").count(), results.tables.len());
    let shown: BTreeSet<&str> =
        results.paper.split("](figures/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    let written: BTreeSet<&str> = results.figures.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(shown, written);
    let different: BTreeSet<&Vec<u8>> = results.figures.iter().map(|(_, bytes)| bytes).collect();
    assert_eq!(different.len(), results.figures.len(), "no figure is kept twice");
}

#[test]
fn a_figure_equal_to_that_of_the_answer_is_stored_once() {
    let results = results(&runs(&[("replicate", &["Dragon"]), ("attribution", &["Dragon"])])).unwrap();
    assert_files_match_paper(&results);
    assert_eq!(results.paper.matches("](figures/answer.svg)").count(), 2, "{}", results.paper);
}

#[test]
fn every_statement_is_in_the_paper_and_in_the_data() {
    let results = results(&cube().1).unwrap();
    let plain = |text: &str| text.replace(['\\', '`'], "").split_whitespace().collect::<Vec<_>>().join(" ");
    let paper = plain(&results.paper);
    for key in ["answer.verdict", "claims.tally", "run.machine", "compare.right", "replicate.hard"] {
        assert!(results.data.statements.contains_key(key), "{key}");
    }
    for (key, statement) in results.data.statements.iter().filter(|(key, _)| *key != "claims.tally") {
        assert!(paper.contains(&plain(&statement.text)), "{key}: {}", statement.text);
    }
    assert!(!results.paper.contains("{{") && results.paper.lines().all(|line| line.trim_end() == line));
    assert_files_match_paper(&results);

    let mut results = self::results(&runs(&[("compare", &["Cube"])])).unwrap();
    let text = "A <!-- sahara: compare.right -->?<!-- / --> b <!-- sahara: replicate.hard -->?<!-- / -->\n";
    let filled = results.fill(text, &STUDIES).unwrap();
    let not = "Not measured in this run (`sahara study replicate --dir runs`)";
    assert!(filled.contains("sah-kd is the fastest.") && plain(&filled).contains(&plain(not)), "{filled}");
    assert!(results.data.statements.contains_key("replicate.hard"), "the data file says so as well");
}

#[test]
fn results_need_one_commit_and_state_the_threads() {
    let two = |changed: Provenance| {
        let files = [journal("compare", &["Cube"], &provenance("x")), journal("replicate", &["Cube"], &changed)];
        results(&read(folder(&files.concat()).path()))
    };
    let other = Provenance { commit: "0ther".into(), ..provenance("x") };
    let Err(error) = two(other) else { panic!("two commits were accepted as one run") };
    assert!(error.to_string().contains("more than one commit (0ther, c0ffee)"), "{error}");
    for (threads, part) in [(1, "on one thread ("), (2, "unless another number is given")] {
        let sentence = two(Provenance { threads, ..provenance("x") }).unwrap().data.run.sentence();
        assert!(sentence.contains(part), "{sentence}");
    }
}

/// Removes code, marked places and link targets from `text`.
fn unmarked(text: &str) -> String {
    let filled = fill(text, |_| Some(String::new())).unwrap();
    let prose: Vec<&str> = filled.split("```").step_by(2).collect();
    let prose: String = prose.concat().split('`').step_by(2).collect();
    prose
        .split("](")
        .enumerate()
        .map(|(i, part)| if i == 0 { part } else { part.split_once(')').map_or("", |p| p.1) })
        .collect()
}

/// Each number in the text, with a few words around it.
fn numbers(text: &str) -> Vec<String> {
    let part = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
    let begins = |at: &usize| !text[..*at].ends_with(part);
    let starts = text.match_indices(|c: char| c.is_ascii_digit()).map(|(at, _)| at).filter(begins);
    let around = |at: usize| {
        let before =
            text[..at].rfind([' ', '\n']).map_or(0, |blank| text[..blank].rfind([' ', '\n']).map_or(0, |b| b + 1));
        text[before..].split_whitespace().take(4).collect::<Vec<_>>().join(" ")
    };
    starts.map(around).collect()
}

/// Numbers in README that are not measured.
const ALLOWED: [&str; 3] = ["are 95 % prediction", "from 1.", "Apache 2.0,"];

#[test]
fn numbers_of_readme_are_marked_or_allowed_and_exit_statuses_match_the_help() {
    let text = unmarked(&readme());
    let (before, statuses) = text.split_once("Exit status: ").unwrap();
    let (statuses, after) = statuses.split_once("\n\n").unwrap();
    for status in statuses.split_once(". ").map_or(statuses, |first| first.0).split(", ") {
        let Some((number, words)) = status.split_once(' ').filter(|s| s.0.parse::<u8>().is_ok()) else { continue };
        let known = crate::cli::exit_status::STATUSES
            .lines()
            .find_map(|line| line.trim().strip_prefix(number)?.strip_prefix("  "));
        let word = words.split_whitespace().find(|word| word.len() > 3).unwrap();
        assert!(known.is_some_and(|known| known.contains(word)), "README.md: {status}; --help: {known:?}");
    }
    let stray = [before, after].map(numbers).concat();
    let stray: Vec<&String> = stray.iter().filter(|s| !ALLOWED.iter().any(|allowed| s.contains(allowed))).collect();
    assert!(
        stray.is_empty(),
        "mark these in README.md, so that `{COMMAND}` fills them in, or leave them out: {stray:?}"
    );
    assert_eq!(numbers("it is 1.8 as fast\nin 5 s; 3 %").len(), 3, "it finds what is a number");
    assert_eq!(numbers(&unmarked("a `4 %` [b](5%) <!-- sahara: k -->6 %<!-- / --> c\n```\n7 %\n```\n")), [""; 0]);
}
