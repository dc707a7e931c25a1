//! Words that sections share.

use crate::report::{Cell, Table};

/// A table of texts.
pub fn table<const N: usize>(title: &str, columns: [&str; N], rows: Vec<[String; N]>) -> Table {
    Table {
        title: title.into(),
        columns: columns.map(String::from).into(),
        rows: rows.into_iter().map(|row| row.map(Cell::from).into()).collect(),
        notes: vec![],
    }
}

/// Letters, digits and hyphens, from any text; what is left of different texts may be the same.
pub fn slug(text: &str) -> String {
    let mut slug = String::new();
    for c in text.chars() {
        match c {
            c if c.is_ascii_alphanumeric() => slug.push(c.to_ascii_lowercase()),
            _ if slug.ends_with('-') || slug.is_empty() => {}
            _ => slug.push('-'),
        }
    }
    let slug = slug.trim_end_matches('-');
    if slug.is_empty() { "x".into() } else { slug.into() }
}

/// Labels without the triangle test, where all that name one name the same.
pub fn short_labels(labels: &[String]) -> Vec<String> {
    let parts = |label: &String| {
        let (name, keys) = label.split_once(':').unwrap_or((label, ""));
        let (tests, others): (Vec<String>, Vec<String>) =
            keys.split(',').filter(|key| !key.is_empty()).map(String::from).partition(|key| key.starts_with("test="));
        (name.to_owned(), tests, others)
    };
    let tests: Vec<String> = labels.iter().flat_map(|label| parts(label).1).collect();
    if distinct(tests.iter()).len() > 1 {
        return labels.to_vec();
    }
    let short = labels.iter().map(|label| match parts(label) {
        (name, _, others) if others.is_empty() => name,
        (name, _, others) => format!("{name}:{}", others.join(",")),
    });
    // One structure with its default test and with another is two.
    let short: Vec<String> = short.collect();
    if distinct(short.iter()).len() < labels.len() { labels.to_vec() } else { short }
}

/// Distinct names in the order of their first appearance.
pub fn distinct<'a>(names: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut found: Vec<String> = vec![];
    for name in names {
        if !found.contains(name) {
            found.push(name.clone());
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_read_as_sentences_and_slugs_as_names() {
        let short = |labels: [&str; 2]| short_labels(&labels.map(String::from)).join(" ");
        assert_eq!(short(["a:test=x", "b:leaf=4,test=x"]), "a b:leaf=4");
        assert_eq!(short(["a:test=x", "b:test=y"]), "a:test=x b:test=y");
        assert_eq!(short(["a:test=x", "a"]), "a:test=x a");
        assert_eq!([slug("Dragon (stand-in)"), slug("<script>"), slug("!")], ["dragon-stand-in", "script", "x"]);
    }
}
