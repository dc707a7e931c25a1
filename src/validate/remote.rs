//! Compares a program in any language with the reference.

use std::sync::Arc;

use super::compare::same;
use super::{Kind, Reference, Validation, WorstRay, validate_hits};
use crate::accel::{BuildError, DynAccel};
use crate::geometry::{Hit, Mesh, Ray};
use crate::measure::spread;

/// Rays that are traced again in another batch.
const AGAIN: usize = 256;

/// Like [`validate_known`](super::validate_known), for a structure that takes long to receive a ray: each query runs
/// once for all rays, and once more for some of them.
///
/// # Errors
/// If its program has failed: then no ray is checked.
pub fn validate_remote(
    subject: &dyn DynAccel,
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Arc<Mesh>,
    rays: &[Ray],
) -> Result<Validation, BuildError> {
    let found = subject.closest(rays);
    let any = if subject.capabilities().any_hit { Some(subject.any(rays)) } else { None };
    let some: Vec<usize> = spread(&(0..rays.len()).collect::<Vec<_>>(), AGAIN);
    let again = subject.closest(&some.iter().map(|&index| rays[index]).collect::<Vec<_>>());
    has_replied(subject)?;

    let mut sums = validate_hits(reference, expected, mesh, rays, &found);
    for (index, ray) in rays.iter().enumerate() {
        if let Some(any) = any.as_ref().map(|any| any[index])
            && any != found[index].is_some()
        {
            let verdict = format!("the any-hit query returns {any}");
            sums.worst.push(worst(index, ray, expected[index], found[index], Kind::AnyHitDisagrees, verdict));
            sums.any_hit_errors += 1;
        }
    }
    for (&index, again) in some.iter().zip(again).filter(|(index, again)| !same(found[**index], *again)) {
        let alone = again.map_or("a miss".to_owned(), |hit| format!("t = {:?} at {:?}", hit.t, hit.prim));
        let verdict = format!("in another batch, the closest-hit query returns {alone}");
        sums.worst.push(worst(index, &rays[index], expected[index], found[index], Kind::Unrepeatable, verdict));
        sums.unrepeatable += 1;
    }
    sums.keep_worst();
    Ok(sums)
}

/// Checks that the program of a structure, if it has one, has replied to all requests.
///
/// # Errors
/// If it has failed: its hits have no meaning.
pub fn has_replied(subject: &dyn DynAccel) -> Result<(), BuildError> {
    let failure = subject.remote().and_then(|remote| remote.failure());
    failure.map_or(Ok(()), |why| Err(BuildError::Remote(why)))
}

fn worst(index: usize, ray: &Ray, expected: Option<Hit>, found: Option<Hit>, kind: Kind, verdict: String) -> WorstRay {
    WorstRay { index: index as u64, ray: *ray, expected, found, kind, verdict, gap: f64::INFINITY }
}
