//! Finds phrases to avoid in help texts, messages, documents and comments.

use std::path::Path;

use super::documented::files;
use crate::study::Studies;

const GLOSSARY: &str = include_str!("../../papers/GLOSSARY.md");

/// Unchecked phrases of the glossary. Each phrase also has a correct meaning.
const AMBIGUOUS: [&str; 9] =
    ["a case", "a ray", "a job", "a second", "a triangle", "the others", "the rest", "the same", "stands in for"];

/// Single words that are checked. All other single words of the glossary are not checked.
const WORDS: [&str; 8] = ["anew", "caster", "likewise", "owes", "surely", "whatever", "whoever", "yardstick"];

/// Words that must not begin a doc comment.
const OPENINGS: [&str; 6] = ["Likewise", "Nothing", "Of", "That", "Those", "What"];

/// Correct technical terms that contain a phrase of the glossary.
const TECHNICAL: [&str; 2] = ["box is lost", "hit is lost"];

/// The file of the claims is not checked. Claims must not change after the measurement.
const CLAIMS: &str = "src/study/CLAIMS.md";

/// The checked phrases of the section "Words to avoid". Patterns such as "hold X against Y" are not checked.
fn not_used() -> Vec<String> {
    let section = GLOSSARY.split("\n## Words to avoid\n").nth(1).expect("the section");
    let section = section.split("\n## ").next().unwrap_or(section);
    let cells = section.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").next()).skip(1);
    // Drop remarks in parentheses.
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

fn helps(command: &mut clap::Command, into: &mut Vec<String>) {
    let mut narrow = command.clone().term_width(80);
    into.extend([narrow.render_long_help(), narrow.render_help()].map(|help| help.to_string()));
    command.get_subcommands_mut().filter(|own| own.get_name() != "help").for_each(|own| helps(own, into));
}

/// The string literals above the tests of a source file. Each literal is joined into one line.
fn literals(source: &str) -> Vec<String> {
    let source = source.split("\n#[cfg(test)]\n").next().unwrap_or(source);
    let code = source.lines().map(|line| format!(" {line}").split(" // ").next().unwrap_or_default().to_owned());
    let code = code.filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    // Remove quotes inside literals. Every remaining quote begins or ends a literal.
    let code = code.replace("\\\\", "").replace("\\\"", "").replace("'\"'", "");
    let in_a_line = |text: &str| text.split_whitespace().filter(|word| *word != "\\").collect::<Vec<_>>().join(" ");
    code.split('"').skip(1).step_by(2).map(in_a_line).collect()
}

/// The comments of a source file and their line numbers. Text in backticks becomes `{}`.
fn comments(source: &str) -> Vec<(usize, String)> {
    let slashes = |comment: &str| comment.split(' ').next().map(String::from);
    let mut found: Vec<(usize, String)> = vec![];
    let mut end = 0;
    for (number, line) in source.lines().enumerate() {
        let is_code = |at: &usize| line[..*at].matches('"').count() % 2 == 0;
        let Some(at) = line.match_indices("//").map(|(at, _)| at).find(is_code) else { continue };
        let (before, comment) = line.split_at(at);
        let continues = end == number && before.trim().is_empty();
        match found.last_mut().filter(|(_, last)| continues && slashes(last) == slashes(comment)) {
            Some((_, last)) => *last += comment.trim_start_matches(['/', '!']),
            None => found.push((number + 1, comment.to_owned())),
        }
        end = number + 1;
    }
    let prose = |text: String| text.split('`').step_by(2).collect::<Vec<_>>().join("{}");
    found.into_iter().map(|(line, text)| (line, prose(text))).collect()
}

/// The text of a document without the parts between `<!-- sahara: ` and `<!-- / -->`.
fn written(text: &str) -> String {
    let parts = text.split("<!-- sahara: ").map(|part| part.split_once("<!-- / -->").map_or(part, |(_, rest)| rest));
    parts.collect()
}

/// Returns a message for each phrase that occurs in `text`. Letter case and line breaks are ignored.
fn found(phrases: &[String], text: &str) -> Vec<String> {
    // A placeholder such as `{what}` counts as a word.
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
    assert_eq!(literals(source), ["one two", "a b"]);
    let source = "/// One\n/// `anew` two.\n//! Three\nlet a = \"//\"; // four";
    let expected = [(1, "/// One {} two."), (3, "//! Three"), (4, "// four")];
    assert_eq!(comments(source), expected.map(|(line, text)| (line, text.to_owned())));
}

#[test]
fn helps_fit_a_screen_and_no_text_has_a_phrase_that_the_glossary_replaces() {
    let (mut messages, mut prose, mut documents) = (vec![], vec![], vec![]);
    let mut helps_of_all = vec![];
    helps(&mut super::command(&Studies::builtin()), &mut helps_of_all);
    let lines = helps_of_all.iter().flat_map(|help| help.lines());
    let too_long: Vec<&str> = lines.filter(|line| line.chars().count() > 80).collect();
    assert!(too_long.is_empty(), "{too_long:#?}");
    let helps = helps_of_all.into_iter().map(|help| ("a help".to_owned(), help)).collect();

    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (path, text) in ["src", "tests", "benches"].iter().flat_map(|folder| files(&root.join(folder), ".rs")) {
        if path.ends_with("wording.rs") {
            continue;
        }
        let path = path.strip_prefix(root).unwrap();
        let place = path.display();
        prose.extend(comments(&text).into_iter().map(|(line, comment)| (format!("{place}:{line}"), comment)));
        if path.starts_with("src") && !path.ends_with("tests.rs") && !path.iter().any(|part| part == "tests") {
            // Users do not see the messages of `expect`.
            let shown = literals(&text.replace(".expect(\"", " // "));
            messages.extend(shown.into_iter().map(|literal| (place.to_string(), literal)));
        }
    }
    for (path, text) in files(root, ".md") {
        // Skip the folder `papers` and the claims.
        if !path.starts_with(root.join("papers")) && !path.ends_with(CLAIMS) {
            documents.push((path.display().to_string(), written(&text)));
        }
    }

    let phrases = not_used();
    let mut used = vec![];
    for (texts, least) in [(helps, 40), (messages, 2000), (prose, 4000), (documents, 10)] {
        assert!(texts.len() > least, "{} texts, not more than {least}", texts.len());
        for (place, text) in texts {
            let doc = text.strip_prefix("///").or(text.strip_prefix("//!")).unwrap_or_default();
            let opening = doc.split_whitespace().next().filter(|word| OPENINGS.contains(word));
            let opening = opening.map(|word| format!("{word:?} as the first word"));
            let faults = found(&phrases, &text).into_iter().chain(opening);
            used.extend(faults.map(|fault| format!("{place}: {}", fault.chars().take(200).collect::<String>())));
        }
    }
    assert!(used.is_empty(), "{used:#?}");
}
