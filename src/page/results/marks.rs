//! Fills marked places in Markdown. A place is the text between the marks `<!-- sahara: KEY -->` and `<!-- / -->`.

use std::ops::Range;

pub const OPEN: &str = "<!-- sahara: ";
const END: &str = " -->";
const CLOSE: &str = "<!-- / -->";

const WIDTH: usize = 120;

/// Returns the key and the byte range of each place. The range excludes the marks.
fn places(text: &str) -> anyhow::Result<Vec<(&str, Range<usize>)>> {
    let (mut places, mut at) = (vec![], 0);
    while let Some(open) = text[at..].find(OPEN) {
        let rest = &text[at + open + OPEN.len()..];
        let error = |key: &str| {
            let key: String = key.chars().take(40).collect();
            anyhow::anyhow!("the mark {key:?} is not closed: write `{CLOSE}` after its text")
        };
        let (key, after) = rest.split_once(END).ok_or_else(|| error(rest))?;
        let from = text.len() - after.len();
        let length = after.find(CLOSE).ok_or_else(|| error(key))?;
        if after[..length].contains(OPEN) {
            return Err(error(key));
        }
        places.push((key, from..from + length));
        at = from + length + CLOSE.len();
    }
    Ok(places)
}

/// Returns the key and the text of each place. Single spaces separate the words of the text.
pub fn marked(text: &str) -> anyhow::Result<Vec<(String, String)>> {
    let plain = |place: Range<usize>| text[place].split_whitespace().collect::<Vec<_>>().join(" ");
    Ok(places(text)?.into_iter().map(|(key, place)| (key.to_owned(), plain(place))).collect())
}

/// Replaces the text of each place with `of(key)`. If `of(key)` is `None`, the text is not changed.
///
/// If text precedes the first opening mark of a line, the paragraph is wrapped again.
pub fn fill(text: &str, of: impl Fn(&str) -> Option<String>) -> anyhow::Result<String> {
    let (mut filled, mut at) = (String::new(), 0);
    for (key, place) in places(text)? {
        filled += &text[at..place.start];
        at = place.end;
        match of(key) {
            Some(value) if value.contains('\n') => filled += &format!("\n\n{}\n\n", value.trim()),
            Some(value) => filled += &value,
            None => filled += &text[place],
        }
    }
    filled += &text[at..];
    let is_code = |fences: usize| fences % 2 == 1;
    let (mut out, mut paragraph, mut fences) = (String::new(), vec![], 0);
    for line in filled.lines() {
        let begins = line.starts_with("- ") || line.starts_with('|') || line.starts_with("```") || line.is_empty();
        if begins || is_code(fences) {
            flush(&mut paragraph, &mut out);
        }
        fences += usize::from(line.starts_with("```"));
        if line.is_empty() || line.starts_with('|') || line.starts_with("```") || is_code(fences) {
            out += line;
            out.push('\n');
        } else {
            paragraph.push(line);
        }
    }
    flush(&mut paragraph, &mut out);
    Ok(out)
}

fn flush(paragraph: &mut Vec<&str>, out: &mut String) {
    let lines = std::mem::take(paragraph);
    if !lines.iter().any(|line| line.contains(OPEN) && !line.starts_with(OPEN)) {
        lines.iter().for_each(|line| *out += &format!("{line}\n"));
        return;
    }
    let indent = if lines[0].starts_with("- ") { "  " } else { "" };
    let mut line = String::new();
    for word in words(&lines.join(" ")) {
        if !line.trim().is_empty() && line.chars().count() + 1 + word.chars().count() > WIDTH {
            *out += &format!("{line}\n");
            line = format!("{indent}{word}");
        } else {
            line = if line.is_empty() { word } else { format!("{line} {word}") };
        }
    }
    *out += &format!("{line}\n");
}

/// Splits a text where a line may break. Comments and code spans are not split.
///
/// Markdown does not format a line that begins with a comment. A comment therefore stays with the preceding word.
fn words(text: &str) -> Vec<String> {
    let (mut words, mut word, mut is_code): (Vec<String>, String, bool) = (vec![], String::new(), false);
    for piece in text.split_whitespace() {
        let in_comment = word.rfind("<!--").is_some_and(|at| !word[at..].contains("-->"));
        if !word.is_empty() && !is_code && !in_comment && !piece.starts_with("<!--") {
            words.push(std::mem::take(&mut word));
        }
        if !word.is_empty() {
            word.push(' ');
        }
        word += piece;
        is_code ^= piece.matches('`').count() % 2 == 1;
    }
    words.extend((!word.is_empty()).then_some(word));
    words
}
