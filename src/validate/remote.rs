//! Compares a program in any language with the reference.

use std::sync::Arc;

use super::compare::same;
use super::{Kind, Reference, Validation, WorstRay, validate_hits};
use crate::accel::DynAccel;
use crate::geometry::{Hit, Mesh, Ray};
use crate::measure::spread;

/// Rays that are traced again in another batch.
const AGAIN: usize = 256;

/// Like [`validate_known`](super::validate_known), for a structure that takes long to receive a ray: each query runs
/// once for all rays, and once more for some of them.
pub fn validate_remote(
    subject: &dyn DynAccel,
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Arc<Mesh>,
    rays: &[Ray],
) -> Validation {
    let found = subject.closest(rays);
    let any = if subject.capabilities().any_hit { Some(subject.any(rays)) } else { None };
    let some: Vec<usize> = spread(&(0..rays.len()).collect::<Vec<_>>(), AGAIN);
    let again = subject.closest(&some.iter().map(|&index| rays[index]).collect::<Vec<_>>());
    if let Some(why) = subject.remote().and_then(|remote| remote.failure()) {
        let mut ended = Validation { rays: rays.len() as u64, panics: 1, ..Validation::default() };
        if let Some(ray) = rays.first() {
            ended.worst.push(worst(0, ray, expected[0], None, Kind::Panicked, why));
        }
        return ended;
    }

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
        let alone = again.map_or("nothing".to_owned(), |hit| format!("t = {:?} at {:?}", hit.t, hit.prim));
        let verdict = format!("in a batch of other rays closest hit says {alone}");
        sums.worst.push(worst(index, &rays[index], expected[index], found[index], Kind::Unrepeatable, verdict));
        sums.unrepeatable += 1;
    }
    sums.keep_worst();
    sums
}

fn worst(index: usize, ray: &Ray, expected: Option<Hit>, found: Option<Hit>, kind: Kind, verdict: String) -> WorstRay {
    WorstRay { index: index as u64, ray: *ray, expected, found, kind, verdict, gap: f64::INFINITY }
}
