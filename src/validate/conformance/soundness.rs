//! Checks a structure without knowledge of the correct hits.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Duration;

use super::{Named, SEED, Subject, outcome};
use crate::accel::{Counts, DynAccel};
use crate::geometry::{Hit, Ray};
use crate::validate::compare::same;
use crate::validate::{Stratum, WatchError, watched};

#[derive(Clone)]
struct Hits {
    closest: Vec<Option<Hit>>,
    any: Vec<bool>,
}

struct Traced {
    plain: Hits,
    loaded: Hits,
    counted: Hits,
    counts: [Counts; 2],
}

fn trace(accel: &Arc<dyn DynAccel>, rays: &[Ray], limit: Duration) -> Result<Traced, WatchError> {
    let (accel, rays) = (Arc::clone(accel), rays.to_vec());
    watched(limit, move || {
        let none = Hits { closest: vec![None; rays.len()], any: vec![false; rays.len()] };
        let (mut plain, mut loaded, mut counted) = (none.clone(), none.clone(), none);
        let mut counts = [Counts::default(); 2];
        let kept = accel.load(Cow::Owned(rays.clone()));
        accel.closest_hits(&rays, &mut plain.closest);
        kept.closest_hits(&mut loaded.closest);
        accel.closest_hits_counted(&rays, &mut counted.closest, &mut counts[0]);
        if accel.capabilities().any_hit {
            accel.any_hits(&rays, &mut plain.any);
            kept.any_hits(&mut loaded.any);
            // This repetition detects an any-hit query that changes the loaded rays.
            kept.closest_hits(&mut loaded.closest);
            accel.any_hits_counted(&rays, &mut counted.any, &mut counts[1]);
        }
        drop(kept);
        Traced { plain, loaded, counted, counts }
    })
}

/// Compares the hits of plain queries, counted queries and queries on loaded rays. Checks the counts against
/// [`Accel::OBSERVED`](crate::accel::Accel::OBSERVED).
///
/// # Errors
/// One line per violation. The check ends at the first build or query that fails or hangs.
pub fn counting(subject: &Subject, meshes: &[Named], count: usize) -> Result<(), String> {
    let mut lines = vec![];
    for (name, mesh) in meshes {
        let accel = subject.built(name, mesh)?;
        let observed = accel.observed();
        for stratum in Stratum::ALL {
            let mut rays = stratum.rays(mesh, count, SEED);
            rays.retain(|ray| accel.capabilities().declines(ray).is_none());
            let context = format!("{} on {name:?}, {} rays", subject.name, stratum.name());
            let traced = match trace(&accel, &rays, subject.limit) {
                Ok(traced) => traced,
                Err(ended) => {
                    let alone = rays.iter().find(|ray| trace(&accel, &[**ray], subject.limit).is_err());
                    let which = alone.map_or("all rays".into(), |ray| format!("ray \"{ray}\""));
                    return Err(format!("{context}: tracing {which} with counts failed: {ended}"));
                }
            };

            // Without `lowest_id`, a structure may return any of the primitives at the closest `t`.
            let number = |h: Hit| if subject.lowest_id { h.prim.index() } else { 0 };
            let answer = |hit: Option<Hit>| hit.map(|h| (h.t.to_bits(), number(h)));
            let agree = |a: Option<Hit>, b: Option<Hit>| answer(a) == answer(b);
            let plain = &traced.plain;
            let differ = |other: &Hits, agree: &dyn Fn(Option<Hit>, Option<Hit>) -> bool| {
                let same = |i: usize| agree(plain.closest[i], other.closest[i]) && plain.any[i] == other.any[i];
                (0..rays.len()).find(|&i| !same(i))
            };
            let counting = differ(&traced.counted, &agree).map(|i| ("counting", i));
            for (what, i) in counting.into_iter().chain(differ(&traced.loaded, &same).map(|i| ("loading", i))) {
                lines.push(format!("{context}: {what} changes the hit of ray \"{}\"", rays[i]));
            }

            let hit = plain.closest.iter().any(Option::is_some);
            let queries = if accel.capabilities().any_hit { &["closest", "any"][..] } else { &["closest"] };
            for (which, c) in queries.iter().zip(&traced.counts) {
                let wrong = [
                    (
                        !observed.steps && c.steps() > 0 || !observed.tests && c.tests > 0,
                        "counts events that `OBSERVED` does not declare",
                    ),
                    (
                        hit && (observed.steps && c.steps() == 0 || observed.tests && c.tests == 0),
                        "finds hits, but counts no step or no test",
                    ),
                    (c.empty_leaves > c.leaves, "counts more empty leaves than leaves"),
                ];
                let wrong = wrong.into_iter().filter(|(is_wrong, _)| *is_wrong);
                lines.extend(wrong.map(|(_, what)| format!("{context}: the {which}-hit query {what}: {c:?}")));
            }
        }
    }
    outcome(lines)
}

/// Checks the shape and the footprint of a structure for impossible numbers.
///
/// # Errors
/// One line per violation. The check ends at the first call that fails or hangs.
pub fn shapes(subject: &Subject, meshes: &[Named]) -> Result<(), String> {
    let mut lines = vec![];
    for (name, mesh) in meshes {
        let accel = subject.built(name, mesh)?;
        let own = Arc::clone(&accel);
        let numbers = watched(subject.limit, move || (own.shape(), own.footprint()));
        let ended = |ended| format!("{} on {name:?}: its shape: {ended}", subject.name);
        let ((shape, footprint), solid) = (numbers.map_err(ended)?, mesh.solid().count());
        let wrong = [
            (shape.references < solid, "fewer references than triangles that have an area"),
            (solid > 0 && shape.leaves == 0, "no leaf"),
            (shape.empty > shape.leaves, "more empty leaves than leaves"),
            (shape.largest_leaf > shape.references, "a leaf with more references than the whole tree"),
            (
                shape.largest_leaf * (shape.leaves - shape.empty.min(shape.leaves)) < shape.references,
                "leaves too small for the references",
            ),
            (shape.depth > shape.inner, "deeper than there are inner nodes"),
            (shape.sah_cost.is_some_and(|cost| cost.is_nan() || cost < 0.0), "a SAH cost that is NaN or negative"),
            (solid > 0 && footprint.total() == 0, "no bytes"),
        ];
        let wrong = wrong.into_iter().filter(|(is_wrong, _)| *is_wrong);
        lines.extend(wrong.map(|(_, what)| format!("{} on {name:?}: {what}: {shape:?}, {footprint:?}", subject.name)));
    }
    outcome(lines)
}
