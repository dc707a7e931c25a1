//! The comparison itself.

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;

use super::asked::{Asked, Call, message};
use super::blame::{Blame, blame, gap};
use super::{Kind, Reference, Validation, WorstRay};
use crate::accel::DynAccel;
use crate::geometry::{Hit, Mesh, Ray};
use crate::oracle::Oracle;
use crate::panics::caught;

/// Rays a batch: part of the result's definition, so that no thread count changes it.
pub(super) const BATCH: usize = 256;

/// Holds `subject` against `reference` on every ray: the closest hit, that any hit agrees with it, and that asking again
/// for one ray alone gives the same answer; batches are loaded ([`Accel::load`](crate::accel::Accel::load)), as they are timed.
///
/// `mesh` is the one that both were built from. Rays that the structure declines are left out and counted. A panic is caught
/// and ends its batch; against endless loops see [`validate_watched`](super::validate_watched). Runs on all threads of the
/// pool; the result does not depend on how many.
/// Costs two closest and two any-hit queries of `subject` a ray, one closest hit of `reference`, and some microseconds a
/// ray on which they differ.
pub fn validate(subject: &dyn DynAccel, reference: &Reference, mesh: &Mesh, rays: &[Ray]) -> Validation {
    validate_known(subject, reference, &reference.closest_hits(rays), mesh, rays)
}

/// As [`validate`], with `expected` the answers of `reference` to `rays`: for several structures it is asked once.
///
/// # Panics
/// If there are not as many answers as rays.
pub fn validate_known(
    subject: &dyn DynAccel,
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Mesh,
    rays: &[Ray],
) -> Validation {
    let (admitted, expected) = admitted(subject, rays, expected);
    let batches = admitted.par_chunks(BATCH).zip(expected.par_chunks(BATCH));
    let of_batch = |(rays, expected)| validate_batch(subject, reference, expected, mesh, rays, &Asked::default());
    let batches: Vec<Validation> = batches.map(of_batch).collect();
    Validation::of_batches(rays.len() - admitted.len(), batches)
}

/// The rays that `subject` does not decline, and what is expected of them.
pub(super) fn admitted(subject: &dyn DynAccel, rays: &[Ray], expected: &[Option<Hit>]) -> (Vec<Ray>, Vec<Option<Hit>>) {
    assert_eq!(rays.len(), expected.len(), "one answer a ray");
    let can = subject.capabilities();
    let known = rays.iter().copied().zip(expected.iter().copied());
    known.filter(|(ray, _)| can.declines(ray).is_none()).unzip()
}

/// Holds closest hits that were found elsewhere against `expected`, the answers of `reference`: as [`validate`], without what
/// only asking can tell.
///
/// # Panics
/// If there are not as many answers as rays.
pub fn validate_answers(
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Mesh,
    rays: &[Ray],
    found: &[Option<Hit>],
) -> Validation {
    assert!(rays.len() == found.len() && rays.len() == expected.len(), "one answer a ray");
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

/// Holds answers to the any-hit query that were found elsewhere against `expected`, the closest hits of `reference`,
/// with the exact oracle as judge where they differ. Where the triangle test is shared, a hit that the reference does
/// not have is invented, whatever is exactly so.
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
    let shares_test = reference.test.is_some();
    let mut oracle = None;
    for (index, (ray, &found)) in rays.iter().zip(found).enumerate() {
        let expected = expected[index];
        if found == expected.is_some() {
            continue;
        }
        let truth = oracle.get_or_insert_with(|| Oracle::new(mesh)).nearest(ray);
        let kind = match (found, truth.is_some()) {
            (true, _) if shares_test => Kind::Invented,
            (true, false) => Kind::Invented,
            (false, true) => Kind::Lost,
            _ if shares_test => Kind::TriangleTest,
            _ => Kind::Reference,
        };
        let verdict = match truth {
            Some(truth) => format!("any hit says {found}; exactly, there is a hit at {:?}", truth.rounded()),
            None => format!("any hit says {found}; exactly, nothing is hit in the interval"),
        };
        let (index, gap) = (index as u64, f64::INFINITY);
        sums.note(WorstRay { index, ray: *ray, expected, found: None, kind, verdict, gap }, shares_test);
    }
    sums.keep_worst();
    sums
}

/// One batch; `asked` shows to another thread what the structure is being asked.
pub(super) fn validate_batch(
    subject: &dyn DynAccel,
    reference: &Reference,
    expected: &[Option<Hit>],
    mesh: &Mesh,
    rays: &[Ray],
    asked: &Asked,
) -> Validation {
    let mut sums = Validation { rays: rays.len() as u64, ..Validation::default() };

    // Ask each ray alone, and only then the batch: what panics or hangs does so at a ray that can be named.
    let mut alone = Vec::with_capacity(rays.len());
    for (index, ray) in rays.iter().enumerate() {
        match ask(asked, Call::Ray(index), || answer(subject, ray)) {
            Ok(answer) => alone.push(answer),
            Err(message) => return sums.ended(expected[index], rays, Call::Ray(index), Kind::Panicked, message),
        }
    }
    // In the form in which it is timed.
    let (found, any) = match ask(asked, Call::Batch, || loaded_answers(subject, rays)) {
        Ok(answers) => answers,
        Err(message) => return sums.ended(expected[0], rays, Call::Batch, Kind::Panicked, message),
    };

    sums.hits = expected.iter().flatten().count() as u64;
    let can = subject.capabilities();
    let checks_any = can.any_hit;
    for (index, ray) in rays.iter().enumerate() {
        let (expected, found, any) = (expected[index], found[index], any[index]);
        if can.excuses(ray, expected) {
            sums.declined += 1;
            continue;
        }
        let mut note = |kind, verdict: String| {
            let index = index as u64;
            sums.worst.push(WorstRay { index, ray: *ray, expected, found, kind, verdict, gap: gap(expected, found) });
        };

        // Of an answer that is not always the same nothing more can be said.
        let (again, any_again) = alone[index];
        if !same(again, found) || checks_any && any_again != any {
            let alone = again.map_or("nothing".to_owned(), |hit| format!("t = {:?} at {:?}", hit.t, hit.prim));
            note(Kind::Unrepeatable, format!("asked alone, closest hit says {alone}, any hit {any_again}"));
            sums.unrepeatable += 1;
            continue;
        }
        if checks_any && any != found.is_some() {
            note(Kind::AnyHitDisagrees, format!("any hit says {any}"));
            sums.any_hit_errors += 1;
        }

        tally(&mut sums, reference, mesh, index, ray, expected, found);
    }
    sums.keep_worst();
    sums
}

/// Prefilled with an answer that nobody gives: a structure must write every slot.
fn unwritten() -> Option<Hit> {
    Some(Hit::new(f32::NEG_INFINITY, u32::MAX - 1))
}

fn answer(subject: &dyn DynAccel, ray: &Ray) -> (Option<Hit>, bool) {
    let mut found = [unwritten()];
    subject.closest_hits(&[*ray], &mut found);
    let mut any = [found[0].is_none()];
    subject.any_hits(&[*ray], &mut any);
    (found[0], any[0])
}

fn loaded_answers(subject: &dyn DynAccel, rays: &[Ray]) -> (Vec<Option<Hit>>, Vec<bool>) {
    let loaded = subject.load(Cow::Borrowed(rays));
    let mut found = vec![unwritten(); rays.len()];
    loaded.closest_hits(&mut found);
    let mut any: Vec<bool> = found.iter().map(Option::is_none).collect();
    loaded.any_hits(&mut any);
    (found, any)
}

fn ask<R>(asked: &Asked, call: Call, question: impl FnOnce() -> R) -> Result<R, String> {
    asked.begin(call);
    let answer = caught(question);
    asked.end();
    answer.map_err(|payload| message(payload.as_ref()))
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
