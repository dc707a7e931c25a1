//! Compares the hits of an external program with the hits of the reference.

use super::compare::same;
use super::{ExpectedHits, Kind, Validation, validate_hits};
use crate::accel::{BuildError, DynAccel};
use crate::geometry::Ray;
use crate::measure::spread;

/// The maximum number of rays whose closest-hit query is repeated.
const AGAIN: usize = 256;

/// Like [`validate_known`](super::validate_known), but sends at most three batches of rays to `subject`,
/// because each call of a runner takes long.
///
/// # Errors
/// If the program of the structure has failed.
pub fn validate_remote(subject: &dyn DynAccel, expected: &ExpectedHits) -> Result<Validation, BuildError> {
    let rays = expected.rays;
    let found = subject.closest(rays);
    let any = if subject.capabilities().any_hit { subject.any(rays) } else { vec![] };
    let some: Vec<usize> = spread(&(0..rays.len()).collect::<Vec<_>>(), AGAIN);
    let again = subject.closest(&some.iter().map(|&index| rays[index]).collect::<Vec<Ray>>());
    has_replied(subject)?;

    let mut sums = validate_hits(expected, &found);
    for (index, any) in any.into_iter().enumerate().filter(|(index, any)| *any != found[*index].is_some()) {
        let verdict = format!("the any-hit query returns {any}");
        sums.worst.push(expected.worst(index, found[index], Kind::AnyHitDisagrees, verdict));
        sums.any_hit_errors += 1;
    }
    for (index, again) in some.into_iter().zip(again).filter(|(index, again)| !same(found[*index], *again)) {
        let again = again.map_or("a miss".to_owned(), |hit| format!("t = {:?} at {:?}", hit.t, hit.prim));
        let verdict = format!("in another batch, the closest-hit query returns {again}");
        sums.worst.push(expected.worst(index, found[index], Kind::Unrepeatable, verdict));
        sums.unrepeatable += 1;
    }
    sums.keep_worst();
    Ok(sums)
}

/// Checks that the external program of `subject` has not failed. A structure without an external program passes.
///
/// # Errors
/// If the program has failed. The hits of `subject` are then meaningless.
pub fn has_replied(subject: &dyn DynAccel) -> Result<(), BuildError> {
    let failure = subject.remote().and_then(|remote| remote.failure());
    failure.map_or(Ok(()), |why| Err(BuildError::Remote(why)))
}
