//! Whether all structures of an epoch fit into memory together.

use crate::measure::machine::memory;
use crate::registry::Choice;
use crate::report::words::distinct;
use crate::scene::Scene;
use crate::study::StudyError;

/// Approximate bytes per triangle of a structure. Finished trees take 50 to 110 bytes; the last two builds take twice
/// as much during the build.
const BYTES: u64 = 100;

/// Rejects a case that the system would kill when it builds the last structures: all structures of an epoch exist at
/// the same time, because their samples alternate.
pub fn fits(choices: &[Choice], scene: &Scene) -> Result<(), StudyError> {
    let structures = choices.len();
    // A twin is built in addition to the named structures.
    let twins = structures - distinct(choices.iter().map(|choice| &choice.label)).len();
    fits_into(memory(), structures, scene.mesh.len()).map_err(|TooMany { fitting, needed, there }| StudyError::Memory {
        scene: scene.name.clone(),
        structures,
        needed,
        there,
        most: fitting.saturating_sub(twins),
    })
}

/// Whether `structures` structures over `triangles` triangles certainly fit, including the mesh and the memory of the
/// last build.
pub fn may_fit(structures: usize, triangles: usize) -> bool {
    fits_into(memory(), structures + 2, triangles).is_ok()
}

/// There are more structures than fit into memory.
#[derive(Debug, PartialEq)]
struct TooMany {
    /// The number of structures that fit.
    fitting: usize,
    /// Gigabytes.
    needed: f64,
    there: f64,
}

/// Whether this number of structures fits into `memory` bytes.
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
