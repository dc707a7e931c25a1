//! Answers to any hit that were found elsewhere.

use std::sync::Arc;

use super::{Kind, Reference, Validation, WorstRay};
use crate::geometry::{Hit, Mesh, Ray};
use crate::oracle::Oracle;

/// Holds answers to the any-hit query against `expected`, the closest hits of `reference`, with the exact oracle as judge where they differ. Where the triangle
/// test is shared, a hit that the reference does not have is invented, whatever is exactly so.
///
/// # Panics
/// If there are not as many answers as rays.
pub fn validate_any_answers(
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Arc<Mesh>,
    rays: &[Ray],
    found: &[bool],
) -> Validation {
    assert!(rays.len() == found.len() && rays.len() == expected.len(), "one answer a ray");
    let hits = expected.iter().flatten().count() as u64;
    let mut sums = Validation { rays: rays.len() as u64, hits, ..Validation::default() };
    let mut oracle = None;
    for (index, (ray, &found)) in rays.iter().zip(found).enumerate() {
        let expected = expected[index];
        if found == expected.is_some() {
            continue;
        }
        let truth = oracle.get_or_insert_with(|| Oracle::new(mesh)).nearest(ray);
        let kind = match (found, truth.is_some()) {
            (true, _) if reference.test.is_some() => Kind::Invented,
            (true, false) => Kind::Invented,
            (false, true) => Kind::Lost,
            _ if reference.test.is_some() => Kind::TriangleTest,
            _ => Kind::Reference,
        };
        let verdict = match truth {
            Some(truth) => format!("any hit says {found}; exactly, there is a hit at {:?}", truth.rounded()),
            None => format!("any hit says {found}; exactly, nothing is hit in the interval"),
        };
        let index = index as u64;
        sums.worst.push(WorstRay { index, ray: *ray, expected, found: None, kind, verdict, gap: f64::INFINITY });
        sums.differing += 1;
        match kind {
            Kind::TriangleTest => sums.test_errors += 1,
            Kind::Reference => sums.reference_errors += 1,
            _ if reference.test.is_some() => sums.structure_errors += 1,
            _ => sums.answer_errors += 1,
        }
    }
    sums.keep_worst();
    sums
}
