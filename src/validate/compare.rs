//! Compares a structure with its reference, ray by ray.

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;

use super::blame::Dispute;
use super::query_clock::{Call, QueryClock};
use super::rounding::{Precision, may_be_hit, nearest_certain_hit};
use super::{Kind, Reference, Validation, WorstRay};
use crate::accel::DynAccel;
use crate::geometry::{Hit, Mesh, Ray};
use crate::oracle::Oracle;

/// Rays per batch. The fixed size makes the result independent of the number of threads.
pub(super) const BATCH: usize = 256;

/// Rays over a mesh, and the hits of a reference for these rays.
#[derive(Clone, Copy)]
pub struct ExpectedHits<'a> {
    pub reference: &'a Reference,
    pub mesh: &'a Arc<Mesh>,
    pub rays: &'a [Ray],
    /// One hit per ray. The comparisons panic otherwise.
    pub hits: &'a [Option<Hit>],
}

impl ExpectedHits<'_> {
    fn batches(&self) -> Vec<Self> {
        assert_eq!(self.rays.len(), self.hits.len(), "one hit per ray");
        let batches = self.rays.chunks(BATCH).zip(self.hits.chunks(BATCH));
        batches.map(|(rays, hits)| Self { rays, hits, ..*self }).collect()
    }

    fn no_difference(&self) -> Validation {
        let hits = self.hits.iter().flatten().count() as u64;
        Validation { rays: self.rays.len() as u64, hits, ..Validation::default() }
    }

    pub(super) fn worst(&self, index: usize, found: Option<Hit>, kind: Kind, verdict: String) -> WorstRay {
        WorstRay { index: index as u64, ray: self.rays[index], expected: self.hits[index], found, kind, verdict }
    }

    pub(super) fn ended(&self, call: Call, kind: Kind, why: String) -> Validation {
        let rays = self.rays.len();
        let (index, verdict) = match call {
            Call::Ray(index) => (index, why),
            Call::Batch => {
                (0, format!("{why}; no single ray causes it, but the batch of {rays} rays that begins with this ray"))
            }
        };
        Validation {
            rays: rays as u64,
            panics: u64::from(kind == Kind::Panicked),
            hangs: u64::from(kind == Kind::Hangs),
            worst: vec![self.worst(index, None, kind, verdict)],
            ..Validation::default()
        }
    }

    fn dispute(&self, index: usize, found: Option<Hit>) -> Dispute<'_> {
        let Self { reference, mesh, rays, hits } = self;
        Dispute { reference, mesh, ray: &rays[index], expected: hits[index], found }
    }

    fn tally(&self, sums: &mut Validation, index: usize, found: Option<Hit>) {
        let Some((kind, verdict)) = self.dispute(index, found).blame() else { return };
        sums.note(self.worst(index, found, kind, verdict), self.reference.knows_structure_errors());
    }
}

/// Compares `subject` with `reference` on every ray.
///
/// The closest hit is compared with the hit of the reference. The any-hit result must agree with the closest hit of
/// `subject`. A ray must have the same hits on its own and in a batch.
///
/// `subject` and `reference` must be built over `mesh`. Rays that `subject` declines are only counted. A panic of
/// `subject` ends the current batch. Use [`validate_watched`](super::validate_watched) if `subject` may loop endlessly.
pub fn validate(subject: &dyn DynAccel, reference: &Reference, mesh: &Arc<Mesh>, rays: &[Ray]) -> Validation {
    validate_known(subject, &ExpectedHits { reference, mesh, rays, hits: &reference.closest_hits(rays) })
}

/// Like [`validate`], but receives the hits of the reference.
pub fn validate_known(subject: &dyn DynAccel, expected: &ExpectedHits) -> Validation {
    let (rays, hits) = not_declined(subject, expected.rays, expected.hits);
    let batches = ExpectedHits { rays: &rays, hits: &hits, ..*expected }.batches();
    let of_batch = |batch| validate_batch(subject, batch, &QueryClock::default());
    let batches: Vec<Validation> = batches.par_iter().map(of_batch).collect();
    Validation::of_batches(expected.rays.len() - rays.len(), batches)
}

pub(super) fn not_declined(
    subject: &dyn DynAccel,
    rays: &[Ray],
    expected: &[Option<Hit>],
) -> (Vec<Ray>, Vec<Option<Hit>>) {
    assert_eq!(rays.len(), expected.len(), "one hit per ray");
    let capabilities = subject.capabilities();
    let known = rays.iter().copied().zip(expected.iter().copied());
    known.filter(|(ray, _)| capabilities.declines(ray).is_none()).unzip()
}

/// Compares the closest hits `found` with the hits of the reference.
///
/// # Panics
/// If there is not one hit per ray.
pub fn validate_hits(expected: &ExpectedHits, found: &[Option<Hit>]) -> Validation {
    assert_eq!(expected.rays.len(), found.len(), "one hit per ray");
    let of_batch = |(batch, found): (&ExpectedHits, &[Option<Hit>])| {
        let mut sums = batch.no_difference();
        for (index, found) in found.iter().enumerate() {
            batch.tally(&mut sums, index, *found);
        }
        sums.keep_worst();
        sums
    };
    let batches: Vec<Validation> = expected.batches().par_iter().zip(found.par_chunks(BATCH)).map(of_batch).collect();
    Validation::of_batches(0, batches)
}

/// Returns the ray index and the kind of each difference between `found` and the expected hits.
///
/// Structure and reference may have different triangle tests. In this case,
/// [`DepthRule::STRICT`](crate::oracle::DepthRule::STRICT) decides whether two `t` on one primitive differ.
pub fn differences(expected: &ExpectedHits, found: &[Option<Hit>]) -> Vec<(usize, Kind)> {
    let differs = |index: usize| Some((index, expected.dispute(index, found[index]).blame()?.0));
    (0..expected.rays.len()).into_par_iter().filter_map(differs).collect()
}

/// Compares the any-hit results `found` with the closest hits of the reference. If the reference has the same triangle
/// test, a hit that the reference misses is an error. Exact arithmetic judges all other differences.
///
/// If rounding may explain a difference, `subject` also traces the ray with the closest-hit query. The two queries must
/// agree, because a triangle test rounds the same way in both queries.
///
/// # Panics
/// If there is not one result per ray.
pub fn validate_any_hits(expected: &ExpectedHits, found: &[bool], subject: Option<&dyn DynAccel>) -> Validation {
    let ExpectedHits { reference, mesh, rays, hits } = *expected;
    assert!(rays.len() == found.len() && rays.len() == hits.len(), "one hit per ray");
    let mut sums = expected.no_difference();
    let shares_test = reference.test.is_some();
    let rounds = !shares_test && reference.precision == Precision::Single;
    let (mut oracle, mut excused) = (None, vec![]);
    for (index, ray) in rays.iter().enumerate().filter(|(index, _)| found[*index] != hits[*index].is_some()) {
        let found = found[index];
        let truth = oracle.get_or_insert_with(|| Oracle::new(mesh)).nearest(ray);
        let kind = match (found, truth.is_some()) {
            (true, _) if shares_test => Kind::Invented,
            (true, false) if rounds && may_be_hit(mesh, ray) => Kind::TriangleTest,
            (false, true) if rounds && nearest_certain_hit(mesh, ray, f64::INFINITY).is_none() => Kind::TriangleTest,
            (true, false) => Kind::Invented,
            (false, true) => Kind::Lost,
            _ if shares_test => Kind::TriangleTest,
            _ => Kind::Reference,
        };
        let exact =
            truth.map_or("no hit in the interval".into(), |truth| format!("a hit at t = {:?}", truth.rounded()));
        let verdict = format!("the any-hit query returns {found}; exact arithmetic finds {exact}");
        let ray = expected.worst(index, None, kind, verdict);
        if rounds && kind == Kind::TriangleTest { excused.push(ray) } else { sums.note(ray, shares_test) }
    }

    let rays: Vec<Ray> = excused.iter().map(|own| own.ray).collect();
    let closest = subject.filter(|_| !rays.is_empty()).map_or(vec![], |subject| subject.closest(&rays));
    for (place, mut own) in excused.into_iter().enumerate() {
        match closest.get(place) {
            Some(hit) if hit.is_some() != found[own.index as usize] => {
                (own.kind, own.found) = (Kind::AnyHitDisagrees, *hit);
                sums.any_hit_errors += 1;
                sums.worst.push(own);
            }
            _ => sums.note(own, shares_test),
        }
    }
    sums.keep_worst();
    sums
}

pub(super) fn validate_batch(subject: &dyn DynAccel, batch: &ExpectedHits, clock: &QueryClock) -> Validation {
    // Tracing each ray on its own identifies the ray that causes a panic or hang.
    let mut single = Vec::with_capacity(batch.rays.len());
    for (index, ray) in batch.rays.iter().enumerate() {
        match clock.run(Call::Ray(index), || trace_single(subject, ray)) {
            Ok(hits) => single.push(hits),
            Err(message) => return batch.ended(Call::Ray(index), Kind::Panicked, message),
        }
    }
    // Trace the loaded batch, because timed passes also trace loaded rays.
    let (found, any) = match clock.run(Call::Batch, || traced_loaded(subject, batch.rays)) {
        Ok(hits) => hits,
        Err(message) => return batch.ended(Call::Batch, Kind::Panicked, message),
    };

    let mut sums = batch.no_difference();
    let capabilities = subject.capabilities();
    let checks_any = capabilities.any_hit;
    for (index, ray) in batch.rays.iter().enumerate() {
        let (found, any) = (found[index], any[index]);
        if capabilities.excuses(ray, batch.hits[index]) {
            sums.declined += 1;
            continue;
        }
        let (on_its_own, any_alone) = single[index];
        if !same(on_its_own, found) || checks_any && any_alone != any {
            let closest = on_its_own.map_or("none".to_owned(), |hit| format!("t = {:?} at {:?}", hit.t, hit.prim));
            let verdict =
                format!("traced on its own, the ray has the closest hit {closest} and the any-hit result {any_alone}");
            sums.worst.push(batch.worst(index, found, Kind::Unrepeatable, verdict));
            sums.unrepeatable += 1;
            continue;
        }
        if checks_any && any != found.is_some() {
            let verdict = format!("the any-hit query returns {any}");
            sums.worst.push(batch.worst(index, found, Kind::AnyHitDisagrees, verdict));
            sums.any_hit_errors += 1;
        }
        batch.tally(&mut sums, index, found);
    }
    sums.keep_worst();
    sums
}

/// An initial value that no structure returns.
fn unwritten() -> Option<Hit> {
    Some(Hit::new(f32::NEG_INFINITY, u32::MAX - 1))
}

fn trace_single(subject: &dyn DynAccel, ray: &Ray) -> (Option<Hit>, bool) {
    let mut found = [unwritten()];
    subject.closest_hits(&[*ray], &mut found);
    // The initial value of `any` contradicts the closest hit, to detect an unwritten result.
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

pub(super) fn same(a: Option<Hit>, b: Option<Hit>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => a.same_bits(b),
        (a, b) => a.is_none() && b.is_none(),
    }
}

#[cfg(test)]
mod tests;
