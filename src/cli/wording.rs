//! No help, message, document or comment has a phrase that the glossary replaces.

use std::fs;
use std::path::{Path, PathBuf};

use crate::study::Studies;

const GLOSSARY: &str = include_str!("../../papers/GLOSSARY.md");

/// Phrases of the glossary that have another meaning as well, in which they are used.
const AMBIGUOUS: [&str; 9] =
    ["a case", "a ray", "a job", "a second", "a triangle", "the others", "the rest", "the same", "stands in for"];

/// Words of the glossary that have no other meaning. Whether most single words are wrong, only a reader can decide.
const WORDS: [&str; 8] = ["anew", "caster", "likewise", "owes", "surely", "whatever", "whoever", "yardstick"];

/// First words of a doc comment that hide its subject.
const OPENINGS: [&str; 6] = ["Likewise", "Nothing", "Of", "That", "Those", "What"];

/// The field's words for what a traversal must not do, with a phrase of the glossary in them.
const TECHNICAL: [&str; 2] = ["box is lost", "hit is lost"];

/// Claims stay as they were written before the measurement.
const CLAIMS: &str = "src/study/CLAIMS.md";

/// The phrases of the section "Words to avoid", without patterns such as "hold X against Y".
fn not_used() -> Vec<String> {
    let section = GLOSSARY.split("\n## Words to avoid\n").nth(1).expect("the section");
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

/// The comments of a source, each with the number of its first line. Consecutive lines with the same slashes are one
/// comment. Code in backticks is left out.
fn comments(source: &str) -> Vec<(usize, &str, String)> {
    let mut found: Vec<(usize, &str, String)> = vec![];
    let mut end = 0;
    for (number, line) in source.lines().enumerate() {
        let is_code = |at: &usize| line[..*at].matches('"').count() % 2 == 0;
        let Some(at) = line.match_indices("//").map(|(at, _)| at).find(is_code) else { continue };
        let text = line[at..].trim_start_matches('/').trim_start_matches('!');
        let slashes = &line[at..line.len() - text.len()];
        match found.last_mut().filter(|last| end == number && last.1 == slashes && line[..at].trim().is_empty()) {
            Some((.., last)) => *last += text,
            None => found.push((number + 1, slashes, text.trim().to_owned())),
        }
        end = number + 1;
    }
    let prose = |text: &str| text.split('`').step_by(2).collect::<Vec<_>>().join("{}");
    found.into_iter().map(|(line, slashes, text)| (line, slashes, prose(&text))).collect()
}

fn sources(folder: &Path, into: &mut Vec<(PathBuf, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") && !path.ends_with("wording.rs") {
            let text = fs::read_to_string(&path).unwrap();
            into.push((path, text));
        }
    }
}

/// The text of a document without what a run fills in.
fn written(text: &str) -> String {
    let parts = text.split("<!-- sahara: ").map(|part| part.split_once("<!-- / -->").map_or(part, |(_, rest)| rest));
    parts.collect()
}

/// The `phrases` that occur in `text`, in upper or lower case and across lines.
fn found(phrases: &[String], text: &str) -> Vec<String> {
    // A placeholder is a word of its own.
    let plain = |c: char| if c.is_alphanumeric() || "'{}".contains(c) { c.to_ascii_lowercase() } else { ' ' };
    let text: String = text.chars().map(plain).collect();
    let text = format!(" {} ", text.split_whitespace().collect::<Vec<_>>().join(" "));
    let text = TECHNICAL.iter().fold(text, |text, words| text.replace(&format!(" {words} "), " {} "));
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
    assert!(found(&phrases, "No hit is lost.").is_empty());
    assert_eq!(found(&phrases, "Nothing is lost.").len(), 1);
    let source =
        "let a = \"one \\\n    two\"; // \"no\"\nlet b = ('\"', \"a \\\" b\");\n#[cfg(test)]\nmod tests { \"x\" }";
    assert_eq!(literals(source), ["one two", "a \\\" b"]);
    let source = "/// One\n/// `anew` two.\n//! Three\nlet a = \"//\"; // four";
    let expected = [(1, "///", "One {} two."), (3, "//!", "Three"), (4, "//", "four")];
    assert_eq!(comments(source), expected.map(|(line, slashes, text)| (line, slashes, text.to_owned())));
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

    let mut files = vec![];
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut files);
    files.retain(|(path, _)| !path.ends_with("tests.rs") && !path.iter().any(|part| part == "tests"));
    let mut count = 0;
    for (path, text) in &files {
        // No user reads the sentence of an `expect`.
        let shown = literals(&text.replace(".expect(\"", ".expect(//"));
        count += shown.len();
        let of_literal = |own: &String| found(&phrases, own);
        used.extend(shown.iter().flat_map(of_literal).map(|phrase| format!("{}: {phrase}", path.display())));
    }
    assert!(count > 2000, "{count} literals");
    assert!(used.is_empty(), "{used:#?}");
}

#[test]
fn comments_have_no_phrase_that_the_glossary_replaces() {
    let (phrases, root) = (not_used(), Path::new(env!("CARGO_MANIFEST_DIR")));
    let mut files = vec![];
    ["src", "tests", "benches"].iter().for_each(|folder| sources(&root.join(folder), &mut files));
    let (mut count, mut used) = (0, vec![]);
    for (path, text) in &files {
        for (line, slashes, comment) in comments(text) {
            count += 1;
            let opening = comment.split_whitespace().next().filter(|word| OPENINGS.contains(word) && slashes != "//");
            let opening = opening.map(|word| format!("{word:?} as the first word"));
            let place = |phrase: String| format!("{}:{line}: {phrase}", path.strip_prefix(root).unwrap().display());
            used.extend(found(&phrases, &comment).into_iter().chain(opening).map(place));
        }
    }
    assert!(count > 5000, "{count} comments");
    assert!(used.is_empty(), "{used:#?}");
}

/// Exceptions: notes on papers, and results that a run has written.
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
