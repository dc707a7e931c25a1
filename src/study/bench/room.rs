//! Whether the structures of an epoch fit into memory together.

use crate::measure::machine::memory;
use crate::registry::Choice;
use crate::report::words::distinct;
use crate::scene::Scene;
use crate::study::StudyError;

/// What a structure holds of a triangle, about: finished trees hold 50 to 110 bytes, and the last to be built twice as many on the way.
const BYTES: u64 = 100;

/// Refuses what the system would end in the middle, when the last structures are built: all of an epoch are held at once, for they take
/// turns.
///
/// # Errors
/// If the structures need more than the machine has, about.
pub fn fits(choices: &[Choice], scene: &Scene) -> Result<(), StudyError> {
    let structures = choices.len();
    // A twin is built beside those that are named.
    let twins = structures - distinct(choices.iter().map(|choice| &choice.label)).len();
    fits_into(memory(), structures, scene.mesh.len()).map_err(|(fitting, [needed, there])| StudyError::Memory {
        scene: scene.name.clone(),
        structures,
        needed,
        there,
        most: fitting.saturating_sub(twins),
    })
}

/// How many structures fit, and the gigabytes needed and those there are, where the first are more.
fn fits_into(memory: Option<u64>, structures: usize, triangles: usize) -> Result<(), (usize, [f64; 2])> {
    let each = triangles as u64 * BYTES;
    let needed = structures as u64 * each;
    match memory {
        Some(there) if needed > there => {
            Err(((there / each) as usize, [needed, there].map(|bytes| bytes as f64 / 1e9)))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_structures_as_fit_are_measured() {
        let there = Some(24_500_000_000);
        assert_eq!(fits_into(there, 14, 10_000_000), Ok(()));
        assert_eq!(fits_into(there, 24, 10_000_000), Ok(()));
        assert_eq!(fits_into(there, 38, 10_000_000), Err((24, [38.0, 24.5])));
        assert_eq!(fits_into(there, 38, 100_000), Ok(()));
        assert_eq!(fits_into(None, 1000, 1 << 30), Ok(()), "nothing is refused where nothing is known");
    }

    #[test]
    fn a_refusal_says_how_many_structures_may_be_named() {
        let refusal = |most| StudyError::Memory { scene: "A".into(), structures: 9, needed: 27.0, there: 25.0, most };
        let numbers = "A: 9 structures at once need about 27 GB, and there are 25 GB of memory: name ";
        let said = [0, 7].map(|most| refusal(most).to_string());
        let advice = ["a smaller scene", "at most 7 structures with -s, or a smaller scene"];
        assert_eq!(said, advice.map(|advice| format!("{numbers}{advice}")));
    }
}
