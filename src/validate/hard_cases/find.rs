//! Cases by name.

use super::case::HardCase;
use super::catalogue::CASES;

/// A name that is no case.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no hard case {name:?}; similar names: {nearest}; `sahara list hard` lists all")]
pub struct UnknownCase {
    name: String,
    nearest: String,
}

/// All cases, in the order of their numbers.
pub fn catalogue() -> Vec<&'static HardCase> {
    CASES.iter().collect()
}

/// The first of [`find_all`].
///
/// # Errors
/// As there.
pub fn find(name: &str) -> Result<&'static HardCase, UnknownCase> {
    Ok(find_all(name)?[0])
}

/// The case called `name`, in any case of letters, or all with that number: number 23 is two cases.
///
/// # Errors
/// If there is none: names the three that differ least.
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
