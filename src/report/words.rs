//! Functions that write text for tables, studies and pages.

use super::number::figures;
use crate::measure::{Estimate, Interval};

/// A stand-in is a generated mesh that replaces a real mesh.
pub fn scene_name(scene: &str, stand_in: bool) -> String {
    if stand_in { format!("{scene} (stand-in)") } else { scene.into() }
}

/// Examples: `20.6 [19.2, 21.4]`, `20.6` and `20.6 (one epoch)`.
pub fn interval(x: Estimate) -> String {
    written(x, figures)
}

pub fn written(x: Estimate, number: impl Fn(f64) -> String) -> String {
    match x.interval {
        Some(interval) if interval.low == interval.high => number(x.estimate),
        _ => format!("{} {}", number(x.estimate), interval_text(x, number)),
    }
}

/// Examples: `[19.2, 21.4]` and `(one epoch)`.
pub fn interval_text(x: Estimate, number: impl Fn(f64) -> String) -> String {
    match x.interval {
        Some(Interval { low, high, .. }) => format!("[{}, {}]", number(low), number(high)),
        None => ONE_EPOCH.into(),
    }
}

/// Adds a full stop if the text does not end with `.`, `?` or `!`.
pub fn ended(words: &str) -> String {
    if words.ends_with(['.', '?', '!']) { words.into() } else { format!("{words}.") }
}

pub const ONE_EPOCH: &str = "(one epoch)";

/// `width` is in characters. Words longer than `width` are not split.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = vec![];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// `A`, `A and B`, or `A, B and C`.
pub fn listed<S: AsRef<str>>(words: &[S]) -> String {
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    match words.split_last() {
        None => String::new(),
        Some((only, [])) => (*only).into(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

/// A slug contains only lower-case letters, digits and hyphens. Different texts may give the same slug.
pub fn slug(text: &str) -> String {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let slug = words.collect::<Vec<_>>().join("-").to_ascii_lowercase();
    if slug.is_empty() { "x".into() } else { slug }
}

/// Returns `NAME` for the label `NAME:key=value,..`.
pub fn bare(label: &str) -> &str {
    label.split(':').next().unwrap_or(label)
}

pub fn distinct<'a>(names: impl Iterator<Item = &'a String>) -> Vec<String> {
    each_once(names).into_iter().cloned().collect()
}

/// Removes repeated items and keeps the order.
pub fn each_once<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    each_once_by(items, T::eq)
}

pub fn each_once_by<T>(items: impl IntoIterator<Item = T>, same: impl Fn(&T, &T) -> bool) -> Vec<T> {
    let mut found: Vec<T> = vec![];
    for item in items {
        if !found.iter().any(|other| same(other, &item)) {
            found.push(item);
        }
    }
    found
}

/// Removes the folder from the program's path.
pub fn command_line(command: &str) -> String {
    let (program, rest) = command.split_once(' ').unwrap_or((command, ""));
    let program = program.trim_matches('\'').rsplit(['/', '\\']).next().unwrap_or(program);
    let name = if program.starts_with("sahara") { "sahara" } else { program };
    format!("{name} {rest}").trim_end().into()
}

#[cfg(test)]
mod tests {
    use super::super::Table;
    use super::*;

    #[test]
    fn lists_and_intervals_read_as_text() {
        assert_eq!([listed::<&str>(&[]), listed(&["a"]), listed(&["a", "b", "c"])], ["", "a", "a, b and c"]);
        assert_eq!(interval(Estimate::between(2.0, 1.5, 2.5)), "2.00 [1.50, 2.50]");
        assert_eq!(interval(Estimate::between(2.0, 2e-4, 4580.56)), "2.00 [2.00e-4, 4581]");
        assert_eq!(interval(Estimate::between(2.0, 0.00421, 2.5)), "2.00 [0.00421, 2.50]");
        assert_eq!(interval(Estimate::between(-0.5, -0.75, 0.25)), "-0.500 [-0.750, 0.250]");
        assert_eq!(interval(Estimate::exact(2.0)), "2.00");
        assert_eq!(interval(Estimate::alone(2.0)), "2.00 (one epoch)");
        let table = |x: Estimate| Table::new("", [""], [vec![x.into()]]).with_interval_note().notes;
        assert!(table(Estimate::exact(2.0)).is_empty());
        assert!(table(Estimate::alone(2.0))[0].contains("no interval"));
        assert_eq!(scene_name("Dragon", true), "Dragon (stand-in)");
    }

    #[test]
    fn duplicates_are_removed_in_order() {
        assert_eq!(each_once([3, 1, 3, 2, 1]), [3, 1, 2]);
        assert_eq!(each_once_by(["b", "a", "B"], |one, other| one.eq_ignore_ascii_case(other)), ["b", "a"]);
    }

    #[test]
    fn slugs_are_names() {
        assert_eq!([slug("Dragon (stand-in)"), slug("<script>"), slug("!")], ["dragon-stand-in", "script", "x"]);
    }
}
