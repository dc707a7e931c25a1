//! Whether the structures of an epoch fit into memory together.

use crate::measure::machine::memory;
use crate::registry::Choice;
use crate::report::words::distinct;
use crate::scene::Scene;
use crate::study::StudyError;

/// What a structure holds of a triangle, about: finished trees hold 50 to 110 bytes, and the last to be built twice as
/// many on the way.
const BYTES: u64 = 100;

/// Refuses what the system would end in the middle, when the last structures are built: all of an epoch are held at
/// once, for they take turns.
pub fn fits(choices: &[Choice], scene: &Scene) -> Result<(), StudyError> {
    let structures = choices.len();
    // A twin is built beside those that are named.
    let twins = structures - distinct(choices.iter().map(|choice| &choice.label)).len();
    fits_into(memory(), structures, scene.mesh.len()).map_err(|TooMany { fitting, needed, there }| StudyError::Memory {
        scene: scene.name.clone(),
        structures,
        needed,
        there,
        most: fitting.saturating_sub(twins),
    })
}

/// Whether so many structures over so many triangles surely fit: with the mesh, and what the last one takes on the way.
pub fn may_fit(structures: usize, triangles: usize) -> bool {
    fits_into(memory(), structures + 2, triangles).is_ok()
}

/// More structures than there is memory for.
#[derive(Debug, PartialEq)]
struct TooMany {
    /// How many fit.
    fitting: usize,
    /// Gigabytes.
    needed: f64,
    there: f64,
}

/// Whether so many structures fit into so many bytes.
fn fits_into(memory: Option<u64>, structures: usize, triangles: usize) -> Result<(), TooMany> {
    let each = triangles as u64 * BYTES;
    let needed = structures as u64 * each;
    match memory {
        Some(there) if needed > there => {
            Err(TooMany { fitting: (there / each) as usize, needed: needed as f64 / 1e9, there: there as f64 / 1e9 })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_structures_as_fit_are_measured_and_a_refusal_says_how_many() {
        let there = Some(24_500_000_000);
        assert_eq!(fits_into(there, 14, 10_000_000), Ok(()));
        assert_eq!(fits_into(there, 24, 10_000_000), Ok(()));
        let too_many = TooMany { fitting: 24, needed: 38.0, there: 24.5 };
        assert_eq!(fits_into(there, 38, 10_000_000), Err(too_many));
        assert_eq!(fits_into(there, 38, 100_000), Ok(()));
        assert_eq!(fits_into(None, 1000, 1 << 30), Ok(()), "nothing is refused where nothing is known");

        let refusal = |most| StudyError::Memory { scene: "A".into(), structures: 9, needed: 27.0, there: 25.0, most };
        let numbers = "A: 9 structures need about 27 GB at once, but this machine has 25 GB: name ";
        let said = [0, 1, 7].map(|most| refusal(most).to_string());
        let advice = ["", "at most 1 structure, or ", "at most 7 structures, or "];
        assert_eq!(said, advice.map(|advice| format!("{numbers}{advice}a smaller scene")));
    }
}
