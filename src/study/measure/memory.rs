//! Checks that all structures of an epoch fit into memory together.

use crate::measure::machine::memory;
use crate::registry::Choice;
use crate::report::words::distinct;
use crate::scene::Scene;
use crate::study::StudyError;

/// Approximate memory of a structure, in bytes per triangle: 50 to 110 in finished trees, twice as many during a build.
const BYTES: u64 = 100;

/// All structures of an epoch exist at once, because samples alternate.
pub fn fits(choices: &[Choice], scene: &Scene) -> Result<(), StudyError> {
    // A twin has the label of another structure.
    let twins = choices.len() - distinct(choices.iter().map(|choice| &choice.label)).len();
    fits_into(memory(), [choices.len(), twins], scene.mesh.len(), &scene.name)
}

/// `structures` includes the twins. `most` in the error excludes the twins.
fn fits_into(
    memory: Option<u64>,
    [structures, twins]: [usize; 2],
    triangles: usize,
    scene: &str,
) -> Result<(), StudyError> {
    let each = triangles as u64 * BYTES;
    let needed = structures as u64 * each;
    let Some(there) = memory.filter(|there| needed > *there) else { return Ok(()) };
    let most = ((there / each) as usize).saturating_sub(twins);
    let [needed, there] = [needed, there].map(|bytes| bytes as f64 / 1e9);
    Err(StudyError::Memory { scene: scene.into(), structures, needed, there, most })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_structures_as_fit_are_measured_and_a_refusal_says_how_many() {
        let there = Some(24_500_000_000);
        for (memory, structures, triangles) in
            [(there, 14, 10_000_000), (there, 24, 10_000_000), (there, 38, 100_000), (None, 1000, 1 << 30)]
        {
            assert!(fits_into(memory, [structures, 0], triangles, "A").is_ok(), "{structures} in {memory:?}");
        }
        for (structures, twins, triangles, needed, advice) in [
            (38, 0, 10_000_000, 38, "at most 24 structures, or "),
            (25, 1, 10_000_000, 25, "at most 23 structures, or "),
            (3, 1, 120_000_000, 36, "at most 1 structure, or "),
            (2, 1, 210_000_000, 42, ""),
        ] {
            let refusal = fits_into(there, [structures, twins], triangles, "A").unwrap_err();
            let numbers = format!("{structures} structures need about {needed} GB at once, but this machine has 24 GB");
            assert_eq!(refusal.to_string(), format!("A: {numbers}: name {advice}a smaller scene"));
        }
    }
}
