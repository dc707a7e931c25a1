//! Whether the structures of an epoch fit into memory together.

use crate::measure::machine::memory;
use crate::registry::Choice;
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
    fits_into(memory(), choices.len(), scene.mesh.len()).map_err(|[needed, there]| StudyError::Memory {
        scene: scene.name.clone(),
        structures: choices.len(),
        needed,
        there,
    })
}

/// The gigabytes needed and those there are, where the first are more.
fn fits_into(memory: Option<u64>, structures: usize, triangles: usize) -> Result<(), [f64; 2]> {
    let needed = structures as u64 * triangles as u64 * BYTES;
    match memory {
        Some(there) if needed > there => Err([needed, there].map(|bytes| bytes as f64 / 1e9)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_structures_as_fit_are_measured() {
        let there = Some(24_000_000_000);
        assert_eq!(fits_into(there, 14, 10_000_000), Ok(()));
        assert_eq!(fits_into(there, 38, 10_000_000), Err([38.0, 24.0]));
        assert_eq!(fits_into(there, 38, 100_000), Ok(()));
        assert_eq!(fits_into(None, 1000, 1 << 30), Ok(()), "nothing is refused where nothing is known");
    }
}
