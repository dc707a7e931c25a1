//! No text that a user reads has a phrase that the glossary replaces.

use std::fs;
use std::path::Path;

use crate::study::Studies;

const GLOSSARY: &str = include_str!("../../papers/GLOSSARY.md");

/// Phrases of the glossary that have another meaning as well, in which they are used.
const AMBIGUOUS: [&str; 9] =
    ["a case", "a ray", "a job", "a second", "a triangle", "the others", "the rest", "the same", "stands in for"];

/// Words of the glossary that have no other meaning: of most single words only a reader can tell.
const WORDS: [&str; 7] = ["anew", "caster", "owes", "surely", "whatever", "whoever", "yardstick"];

/// Claims stay as they were written before the measurement.
const CLAIMS: &str = "src/study/CLAIMS.md";

/// The phrases of the section "Not used", without those that stand for more than themselves.
fn not_used() -> Vec<String> {
    let section = GLOSSARY.split("\n## Not used\n").nth(1).expect("the section");
    let section = section.split("\n## ").next().unwrap_or(section);
    let cells = section.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").next()).skip(1);
    // A remark in parentheses says when a phrase is not used.
    let plain =
        |cell: &str| cell.split(" (").map(|part| part.rsplit_once(')').map_or(part, |(_, rest)| rest)).collect();
    let cells: Vec<String> = cells.map(plain).collect();
    let phrases = cells.iter().flat_map(|cell| cell.split([',', ';', ':'])).map(|phrase| phrase.trim().to_lowercase());
    let is_plain = |phrase: &String| {
        let mut words = phrase.split(' ');
        let has_place = words.any(|word| ["n", "x", "y"].contains(&word)) || phrase.contains(['"', '`', '=']);
        let is_checked = if phrase.contains(' ') { !has_place } else { WORDS.contains(&phrase.as_str()) };
        is_checked && !AMBIGUOUS.contains(&phrase.as_str())
    };
    phrases.filter(is_plain).collect()
}

/// The helps, long and short, of a command and of all commands below it, on a screen of 80 columns.
fn helps(command: &mut clap::Command, into: &mut Vec<String>) {
    let mut narrow = command.clone().term_width(80);
    into.extend([narrow.render_long_help(), narrow.render_help()].map(|help| help.to_string()));
    command.get_subcommands_mut().filter(|own| own.get_name() != "help").for_each(|own| helps(own, into));
}

/// The string literals of a source before its tests, each in one line.
fn literals(source: &str) -> Vec<String> {
    let source = source.split("\n#[cfg(test)]\n").next().unwrap_or(source);
    let (mut found, mut rest) = (vec![], source);
    while let Some(at) = rest.find(['"', '\'', '/']) {
        let tail = &rest[at..];
        if tail.starts_with("//") {
            rest = tail.split_once('\n').map_or("", |(_, after)| after);
        } else if let Some(text) = tail.strip_prefix('"') {
            let ends = text.char_indices().scan(false, |is_escaped, (i, c)| {
                let is_end = c == '"' && !*is_escaped;
                *is_escaped = c == '\\' && !*is_escaped;
                Some((i, is_end))
            });
            let end = ends.filter(|(_, is_end)| *is_end).map(|(i, _)| i).next().unwrap_or(text.len());
            let words: Vec<&str> = text[..end].split_whitespace().filter(|word| *word != "\\").collect();
            found.push(words.join(" "));
            rest = text.get(end + 1..).unwrap_or("");
        } else {
            // A quote in a character literal begins no string.
            let skipped = if tail.starts_with("'\"'") { 3 } else { 1 };
            rest = &tail[skipped..];
        }
    }
    found
}

fn sources(folder: &Path, into: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "tests" {
            sources(&path, into);
        } else if name.ends_with(".rs") && !["tests.rs", "wording.rs"].contains(&name.as_str()) {
            into.push((path.display().to_string(), fs::read_to_string(&path).unwrap()));
        }
    }
}

/// The text of a document without what a run fills in.
fn written(text: &str) -> String {
    let parts = text.split("<!-- sahara: ").map(|part| part.split_once("<!-- / -->").map_or(part, |(_, rest)| rest));
    parts.collect()
}

/// Those of the `phrases` that are in `text`, in any case and across lines.
fn found(phrases: &[String], text: &str) -> Vec<String> {
    // A placeholder is a word of its own.
    let plain = |c: char| if c.is_alphanumeric() || "'{}".contains(c) { c.to_ascii_lowercase() } else { ' ' };
    let text: String = text.chars().map(plain).collect();
    let text = format!(" {} ", text.split_whitespace().collect::<Vec<_>>().join(" "));
    let is_found = |phrase: &&String| text.contains(&format!(" {phrase} "));
    phrases.iter().filter(is_found).map(|phrase| format!("{phrase:?} in {text:?}")).collect()
}

#[test]
fn phrases_and_literals_are_found() {
    let phrases = not_used();
    for known in WORDS.into_iter().chain(["kind of rays", "wrong answers", "that of", "made anew", "is not there"]) {
        assert!(phrases.iter().any(|phrase| phrase == known), "{known} is not in {phrases:?}");
    }
    assert_eq!(found(&phrases, "(Made  anew,\nthat of").len(), 3);
    assert!(found(&phrases, "what ever, that offers {what} of {}, of {:?} which").is_empty());
    let source =
        "let a = \"one \\\n    two\"; // \"no\"\nlet b = ('\"', \"a \\\" b\");\n#[cfg(test)]\nmod tests { \"x\" }";
    assert_eq!(literals(source), ["one two", "a \\\" b"]);
}

#[test]
fn help_fits_a_screen_and_it_and_messages_have_no_phrase_that_the_glossary_replaces() {
    let phrases = not_used();
    let mut helps_of_all = vec![];
    helps(&mut super::command(&Studies::builtin()), &mut helps_of_all);
    assert!(helps_of_all.len() > 40, "{} helps", helps_of_all.len());
    let too_long: Vec<&str> =
        helps_of_all.iter().flat_map(|help| help.lines()).filter(|line| line.chars().count() > 80).collect();
    assert!(too_long.is_empty(), "{too_long:#?}");
    let mut used: Vec<String> = helps_of_all.iter().flat_map(|help| found(&phrases, help)).collect();

    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = vec![];
    for folder in
        ["cli", "fetch", "golden", "measure", "page", "registry", "report", "request", "runner", "scene", "study"]
    {
        sources(&source.join(folder), &mut files);
    }
    let mut count = 0;
    for (path, text) in &files {
        // What no user reads is a sentence to `expect`.
        let shown = literals(&text.replace(".expect(\"", ".expect(//"));
        count += shown.len();
        used.extend(shown.iter().flat_map(|own| found(&phrases, own)).map(|phrase| format!("{path}: {phrase}")));
    }
    assert!(count > 2000, "{count} literals");
    assert!(used.is_empty(), "{used:#?}");
}

/// But for notes on papers, and results that a run has written.
#[test]
fn documents_have_no_phrase_that_the_glossary_replaces() {
    let (phrases, root) = (not_used(), Path::new(env!("CARGO_MANIFEST_DIR")));
    let mut paths = vec![];
    super::documented::documents(root, &mut paths);
    paths.retain(|path| !path.starts_with(root.join("papers")) && !path.ends_with(CLAIMS));
    assert!(paths.len() > 10, "{paths:?}");
    let read = |path: &Path| written(&fs::read_to_string(path).unwrap());
    let of =
        |path: &Path| found(&phrases, &read(path)).into_iter().map(|own| own.chars().take(200).collect::<String>());
    let used: Vec<String> =
        paths.iter().flat_map(|path| of(path).map(|own| format!("{}: {own}", path.display()))).collect();
    assert!(used.is_empty(), "{used:#?}");
}
