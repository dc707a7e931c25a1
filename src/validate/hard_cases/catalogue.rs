//! All cases, by name.

use super::case::HardCase;
use super::{boxes, closed, crowds, extremes, flats, found, intervals, invalid, lengths, properties, slender};

/// A name that is no case.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no hard case {name:?}; the nearest names are: {nearest}; `sahara list hard` names all")]
pub struct UnknownCase {
    name: String,
    nearest: String,
}

/// All cases, in the order of their numbers.
pub fn catalogue() -> Vec<&'static HardCase> {
    let families: [&'static [HardCase]; 11] = [
        closed::CASES,
        boxes::CASES,
        flats::CASES,
        lengths::CASES,
        slender::CASES,
        crowds::CASES,
        extremes::CASES,
        intervals::CASES,
        invalid::CASES,
        properties::CASES,
        found::CASES,
    ];
    let mut cases: Vec<&HardCase> = families.into_iter().flatten().collect();
    // Stable: the two scales of number 23 keep their order.
    cases.sort_by_key(|case| case.number);
    cases
}

/// The first of [`find_all`].
///
/// # Errors
/// As there.
pub fn find(name: &str) -> Result<&'static HardCase, UnknownCase> {
    Ok(find_all(name)?[0])
}

/// The case called `name`, in any case of letters, or all that are numbered so: number 23 is two.
///
/// # Errors
/// If there is none: names the three that differ least.
pub fn find_all(name: &str) -> Result<Vec<&'static HardCase>, UnknownCase> {
    let mut cases = catalogue();
    let mut names: Vec<&str> = cases.iter().map(|case| case.name).collect();
    cases.retain(|case| case.name.eq_ignore_ascii_case(name) || case.number.to_string() == name);
    if !cases.is_empty() {
        return Ok(cases);
    }
    names.sort_by_key(|known| (!known.contains(name), strsim::osa_distance(name, known)));
    Err(UnknownCase { name: name.into(), nearest: names[..3].join(", ") })
}
