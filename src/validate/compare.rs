//! Compares a structure with its reference, ray by ray.

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;

use super::blame::{Blame, blame, gap};
use super::query_clock::{Call, QueryClock, message};
use super::rounding::{Precision, may_be_hit, nearest_sure};
use super::{Kind, Reference, Validation, WorstRay};
use crate::accel::DynAccel;
use crate::geometry::{Hit, Mesh, Ray};
use crate::oracle::Oracle;
use crate::panics::caught;

/// Rays per batch. The result may depend on the batch size, so the size is fixed and does not follow the thread count.
pub(super) const BATCH: usize = 256;

/// Compares `subject` with `reference` on every ray. Three checks: the closest hit equals the reference's; the any-hit
/// result agrees with the closest hit; the ray has the same hits on its own and in a batch. Batches are loaded with
/// [`Accel::load`](crate::accel::Accel::load), as for timing.
///
/// Both structures must be built over `mesh`. Rays that the structure declines are left out and counted. A panic is
/// caught and ends its batch; [`validate_watched`](super::validate_watched) also stops endless loops. Runs on all
/// threads of the pool; the result does not depend on their number.
/// Cost per ray: two closest-hit and two any-hit queries of `subject` and one closest-hit query of `reference`; a few
/// microseconds more for a ray on which the hits differ.
pub fn validate(subject: &dyn DynAccel, reference: &Reference, mesh: &Mesh, rays: &[Ray]) -> Validation {
    validate_known(subject, reference, &reference.closest_hits(rays), mesh, rays)
}

/// Like [`validate`], but receives the hits of `reference` in `expected`: several structures can share them.
///
/// # Panics
/// If there is not one hit per ray.
pub fn validate_known(
    subject: &dyn DynAccel,
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Mesh,
    rays: &[Ray],
) -> Validation {
    let (admitted, expected) = admitted(subject, rays, expected);
    let batches = admitted.par_chunks(BATCH).zip(expected.par_chunks(BATCH));
    let of_batch = |(rays, expected)| validate_batch(subject, reference, expected, mesh, rays, &QueryClock::default());
    let batches: Vec<Validation> = batches.map(of_batch).collect();
    Validation::of_batches(rays.len() - admitted.len(), batches)
}

/// The rays that `subject` does not decline, and the hits of the reference for them.
pub(super) fn admitted(subject: &dyn DynAccel, rays: &[Ray], expected: &[Option<Hit>]) -> (Vec<Ray>, Vec<Option<Hit>>) {
    assert_eq!(rays.len(), expected.len(), "one hit per ray");
    let capabilities = subject.capabilities();
    let known = rays.iter().copied().zip(expected.iter().copied());
    known.filter(|(ray, _)| capabilities.declines(ray).is_none()).unzip()
}

/// Compares `found`, closest hits from elsewhere, with `expected`, the hits of `reference`. It makes the first check of
/// [`validate`] and not the two checks that query the structure.
///
/// # Panics
/// If there is not one hit per ray.
pub fn validate_hits(
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Mesh,
    rays: &[Ray],
    found: &[Option<Hit>],
) -> Validation {
    assert!(rays.len() == found.len() && rays.len() == expected.len(), "one hit per ray");
    let batches = rays.par_chunks(BATCH).zip(found.par_chunks(BATCH)).zip(expected.par_chunks(BATCH));
    let batches: Vec<Validation> = batches
        .map(|((rays, found), expected)| {
            let hits = expected.iter().flatten().count() as u64;
            let mut sums = Validation { rays: rays.len() as u64, hits, ..Validation::default() };
            for (index, ray) in rays.iter().enumerate() {
                tally(&mut sums, reference, mesh, index, ray, expected[index], found[index]);
            }
            sums.keep_worst();
            sums
        })
        .collect();
    Validation::of_batches(0, batches)
}

/// The indices of the rays on which `found` differs from `expected`, each with the kind of the difference. `expected`
/// are the hits of another tree over the triangle test of `reference`; the kind presumes that this tree is right.
/// Differences within the depth rule of `reference` are left out.
pub fn differences(
    reference: &Reference,
    mesh: &Mesh,
    rays: &[Ray],
    expected: &[Option<Hit>],
    found: &[Option<Hit>],
) -> Vec<(usize, Kind)> {
    let differs = |index: usize| {
        let (expected, found) = (expected[index], found[index]);
        if same(expected, found) {
            return None;
        }
        Some((index, blame(reference, mesh, &rays[index], expected, found)?.kind))
    };
    (0..rays.len()).into_par_iter().filter_map(differs).collect()
}

/// Compares `found`, any-hit results from elsewhere, with `expected`, the closest hits of `reference`. The exact oracle
/// judges the rays on which they differ.
///
/// If structure and reference share the triangle test, a hit that the reference lacks is `Invented`, even if the oracle
/// has a hit there. If rounding may explain a result, the structure `subject` also traces this ray with the closest-hit
/// query: a triangle test rounds the same way in both queries, so they must agree.
///
/// # Panics
/// If there is not one result per ray.
pub fn validate_any_hits(
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Arc<Mesh>,
    rays: &[Ray],
    found: &[bool],
    subject: Option<&dyn DynAccel>,
) -> Validation {
    assert!(rays.len() == found.len() && rays.len() == expected.len(), "one hit per ray");
    let hits = expected.iter().flatten().count() as u64;
    let mut sums = Validation { rays: rays.len() as u64, hits, ..Validation::default() };
    let shares_test = reference.test.is_some();
    let (mut oracle, mut excused) = (None, vec![]);
    for (index, (ray, &found)) in rays.iter().zip(found).enumerate() {
        let expected = expected[index];
        if found == expected.is_some() {
            continue;
        }
        let truth = oracle.get_or_insert_with(|| Oracle::new(mesh)).nearest(ray);
        // A test in single precision may find a hit that does not exist, or miss one.
        let rounds = !shares_test && reference.precision == Precision::Single;
        let kind = match (found, truth.is_some()) {
            (true, _) if shares_test => Kind::Invented,
            (true, false) if rounds && may_be_hit(mesh, ray) => Kind::TriangleTest,
            (false, true) if rounds && nearest_sure(mesh, ray, f64::INFINITY).is_none() => Kind::TriangleTest,
            (true, false) => Kind::Invented,
            (false, true) => Kind::Lost,
            _ if shares_test => Kind::TriangleTest,
            _ => Kind::Reference,
        };
        let verdict = match truth {
            Some(truth) => {
                format!("the any-hit query returns {found}; exact arithmetic finds a hit at t = {:?}", truth.rounded())
            }
            None => format!("the any-hit query returns {found}; exact arithmetic finds no hit in the interval"),
        };
        let (at, gap) = (index as u64, f64::INFINITY);
        let ray = WorstRay { index: at, ray: *ray, expected, found: None, kind, verdict, gap };
        if rounds && kind == Kind::TriangleTest { excused.push(ray) } else { sums.note(ray, shares_test) }
    }

    // Rounding excuses these results only if the closest-hit query rounds the same way: otherwise the two queries
    // disagree.
    let rays: Vec<Ray> = excused.iter().map(|own| own.ray).collect();
    let closest = subject.filter(|_| !rays.is_empty()).map(|subject| subject.closest(&rays));
    for (place, mut own) in excused.into_iter().enumerate() {
        let is_found = found[own.index as usize];
        match closest.as_ref().map(|closest| closest[place]) {
            Some(hit) if hit.is_some() != is_found => {
                (own.kind, own.found) = (Kind::AnyHitDisagrees, hit);
                sums.any_hit_errors += 1;
                sums.worst.push(own);
            }
            _ => sums.note(own, shares_test),
        }
    }
    sums.keep_worst();
    sums
}

/// Compares one batch. `clock` shows the running query to another thread.
pub(super) fn validate_batch(
    subject: &dyn DynAccel,
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Mesh,
    rays: &[Ray],
    clock: &QueryClock,
) -> Validation {
    let mut sums = Validation { rays: rays.len() as u64, ..Validation::default() };

    // Trace each ray on its own before the batch: a panic or hang then has a known ray.
    let mut single = Vec::with_capacity(rays.len());
    for (index, ray) in rays.iter().enumerate() {
        match returned(clock, Call::Ray(index), || traced_alone(subject, ray)) {
            Ok(hits) => single.push(hits),
            Err(message) => return sums.ended(expected[index], rays, Call::Ray(index), Kind::Panicked, message),
        }
    }
    // Trace the loaded batch, as the timing does.
    let (found, any) = match returned(clock, Call::Batch, || traced_loaded(subject, rays)) {
        Ok(hits) => hits,
        Err(message) => return sums.ended(expected[0], rays, Call::Batch, Kind::Panicked, message),
    };

    sums.hits = expected.iter().flatten().count() as u64;
    let capabilities = subject.capabilities();
    let checks_any = capabilities.any_hit;
    for (index, ray) in rays.iter().enumerate() {
        let (expected, found, any) = (expected[index], found[index], any[index]);
        if capabilities.excuses(ray, expected) {
            sums.declined += 1;
            continue;
        }
        let mut note = |kind, verdict: String| {
            let index = index as u64;
            sums.worst.push(WorstRay { index, ray: *ray, expected, found, kind, verdict, gap: gap(expected, found) });
        };

        // A hit that is not repeatable gets no further check.
        let (on_its_own, any_alone) = single[index];
        if !same(on_its_own, found) || checks_any && any_alone != any {
            let closest = on_its_own.map_or("none".to_owned(), |hit| format!("t = {:?} at {:?}", hit.t, hit.prim));
            note(
                Kind::Unrepeatable,
                format!("traced on its own, the ray has the closest hit {closest} and the any-hit result {any_alone}"),
            );
            sums.unrepeatable += 1;
            continue;
        }
        if checks_any && any != found.is_some() {
            note(Kind::AnyHitDisagrees, format!("the any-hit query returns {any}"));
            sums.any_hit_errors += 1;
        }

        tally(&mut sums, reference, mesh, index, ray, expected, found);
    }
    sums.keep_worst();
    sums
}

/// A hit that no structure returns: a structure must overwrite it in every slot.
fn unwritten() -> Option<Hit> {
    Some(Hit::new(f32::NEG_INFINITY, u32::MAX - 1))
}

fn traced_alone(subject: &dyn DynAccel, ray: &Ray) -> (Option<Hit>, bool) {
    let mut found = [unwritten()];
    subject.closest_hits(&[*ray], &mut found);
    // The any-hit slots start with the opposite of the closest hit: an unwritten slot then contradicts it.
    let mut any = [found[0].is_none()];
    subject.any_hits(&[*ray], &mut any);
    (found[0], any[0])
}

fn traced_loaded(subject: &dyn DynAccel, rays: &[Ray]) -> (Vec<Option<Hit>>, Vec<bool>) {
    let loaded = subject.load(Cow::Borrowed(rays));
    let mut found = vec![unwritten(); rays.len()];
    loaded.closest_hits(&mut found);
    let mut any: Vec<bool> = found.iter().map(Option::is_none).collect();
    loaded.any_hits(&mut any);
    (found, any)
}

/// The result of a query, or the message of its panic.
fn returned<R>(clock: &QueryClock, call: Call, query: impl FnOnce() -> R) -> Result<R, String> {
    clock.begin(call);
    let result = caught(query);
    clock.end();
    result.map_err(|payload| message(payload.as_ref()))
}

fn tally(
    sums: &mut Validation,
    reference: &Reference,
    mesh: &Mesh,
    index: usize,
    ray: &Ray,
    expected: Option<Hit>,
    found: Option<Hit>,
) {
    let Some(Blame { kind, sentence: verdict }) = blame(reference, mesh, ray, expected, found) else { return };
    let (index, gap) = (index as u64, gap(expected, found));
    let ray = WorstRay { index, ray: *ray, expected, found, kind, verdict, gap };
    sums.note(ray, reference.knows_structure_errors());
}

pub(super) fn same(a: Option<Hit>, b: Option<Hit>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => a.same_bits(b),
        (a, b) => a.is_none() && b.is_none(),
    }
}

#[cfg(test)]
mod tests;
