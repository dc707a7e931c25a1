//! Looks up names that people type, in any case, and suggests one for a misspelled name.

/// The first of `known` with the name `wanted`, in any case.
pub fn named<T>(known: impl IntoIterator<Item = T>, wanted: &str, name: impl Fn(&T) -> &str) -> Option<T> {
    known.into_iter().find(|one| name(one).eq_ignore_ascii_case(wanted))
}

/// The one of `known` that `wanted` was probably meant to be: at most a third of its letters differ, where two
/// neighbours that changed places count once (Damerau, "A technique for computer detection and correction of spelling
/// errors", 1964), or it is the only one that begins with `wanted`. None if there is no such name.
pub fn nearest<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted: String = wanted.chars().take(60).flat_map(char::to_lowercase).collect();
    let known: Vec<&str> = known.into_iter().collect();
    let distance = |name: &str| strsim::osa_distance(&wanted, &name.to_lowercase());
    let best = known.iter().copied().min_by_key(|name| distance(name))?;
    if 3 * distance(best) <= wanted.chars().count().max(best.chars().count()) {
        return Some(best);
    }
    let mut begins = known.into_iter().filter(|name| wanted.len() > 2 && name.to_lowercase().starts_with(&wanted));
    begins.next().filter(|_| begins.next().is_none())
}

/// ` (did you mean NAME?)`, or nothing.
pub fn suggestion<'a>(wanted: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(wanted, known).map_or(String::new(), |name| format!(" (did you mean {name}?)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENES: [&str; 5] = ["Cube", "Sponza", "Dragon", "Cornellbox", "Infinitycandy"];

    #[test]
    fn a_slip_is_understood_and_another_word_is_not() {
        let meant = |wanted| nearest(wanted, SCENES);
        assert_eq!(meant("sponsa"), Some("Sponza"));
        assert_eq!(meant("dargon"), Some("Dragon"));
        assert_eq!(meant("cub"), Some("Cube"));
        assert_eq!(meant("corn"), Some("Cornellbox"));
        for other in ["foo", "", "octree", "a long word that nobody knows", "c"] {
            assert_eq!(meant(other), None, "{other}");
        }
        assert_eq!(nearest("sah", ["sah-kd", "sah-bvh"]), None, "two begin so");
        assert_eq!(suggestion("CUEB", SCENES), " (did you mean Cube?)");
    }

    #[test]
    fn case_does_not_matter() {
        assert_eq!(named(SCENES, "dRAGON", |name| name), Some("Dragon"));
        assert_eq!(named(SCENES, "Drago", |name| name), None);
    }
}
