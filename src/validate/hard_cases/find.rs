//! Finds hard cases by name or number.

use super::case::HardCase;
use super::catalogue::CASES;

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no hard case {name:?}; similar names: {nearest}; `sahara list hard` lists all")]
pub struct UnknownCase {
    name: String,
    nearest: String,
}

/// All cases, ordered by number.
pub fn catalogue() -> Vec<&'static HardCase> {
    CASES.iter().collect()
}

/// The first case that [`find_all`] returns.
///
/// # Errors
/// If no case matches.
pub fn find(name: &str) -> Result<&'static HardCase, UnknownCase> {
    Ok(find_all(name)?[0])
}

/// All cases whose name or number is `name`. Capital and small letters are equal.
///
/// # Errors
/// If no case matches.
pub fn find_all(name: &str) -> Result<Vec<&'static HardCase>, UnknownCase> {
    let mut cases = catalogue();
    cases.retain(|case| case.name.eq_ignore_ascii_case(name) || case.number.to_string() == name);
    if !cases.is_empty() {
        return Ok(cases);
    }
    let mut names: Vec<&str> = CASES.iter().map(|case| case.name).collect();
    names.sort_by_key(|known| (!known.contains(name), strsim::osa_distance(name, known)));
    Err(UnknownCase { name: name.into(), nearest: names[..3].join(", ") })
}
