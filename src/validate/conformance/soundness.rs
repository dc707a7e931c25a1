//! Checks of a structure that do not need the right hits.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Duration;

use super::{Named, SEED, Subject, outcome};
use crate::accel::{Counts, DynAccel};
use crate::geometry::{Hit, Ray};
use crate::validate::{Stratum, WatchError, watched};

/// Hits with and without counting, and hits of loaded rays.
struct Traced {
    plain: Vec<Option<Hit>>,
    loaded: Vec<Option<Hit>>,
    counted: Vec<Option<Hit>>,
    counts: Counts,
    any: Vec<bool>,
    any_loaded: Vec<bool>,
    any_counted: Vec<bool>,
    any_counts: Counts,
}

/// Runs every query within a time limit; any hit only if the structure supports it.
fn trace(accel: &Arc<dyn DynAccel>, rays: &[Ray], limit: Duration) -> Result<Traced, WatchError> {
    let (accel, rays) = (Arc::clone(accel), rays.to_vec());
    watched(limit, move || {
        let (none, no) = (vec![None; rays.len()], vec![false; rays.len()]);
        let (mut plain, mut loaded, mut counted) = (none.clone(), none.clone(), none);
        let (mut any, mut any_loaded, mut any_counted) = (no.clone(), no.clone(), no);
        let (mut counts, mut any_counts) = (Counts::default(), Counts::default());
        let kept = accel.load(Cow::Borrowed(&rays));
        accel.closest_hits(&rays, &mut plain);
        kept.closest_hits(&mut loaded);
        accel.closest_hits_counted(&rays, &mut counted, &mut counts);
        if accel.capabilities().any_hit {
            accel.any_hits(&rays, &mut any);
            kept.any_hits(&mut any_loaded);
            // Query again after both: loaded rays must stay unchanged.
            kept.closest_hits(&mut loaded);
            accel.any_hits_counted(&rays, &mut any_counted, &mut any_counts);
        }
        drop(kept);
        Traced { plain, loaded, counted, counts, any, any_loaded, any_counted, any_counts }
    })
}

/// Counting changes nothing: the hits are the same, at the same primitive if the lowest is promised, and counts
/// declared unobserved stay zero. Loading changes nothing either: loaded rays have the same hits as other rays, bit for
/// bit.
///
/// # Errors
/// One line per failing mesh.
pub fn counting(subject: &Subject, meshes: &[Named], count: usize) -> Result<(), String> {
    let mut lines = vec![];
    for (name, mesh) in meshes {
        let accel = subject.built(name, mesh)?;
        let (observed, asks_any) = (accel.observed(), accel.capabilities().any_hit);
        for stratum in Stratum::ALL {
            let rays = stratum.rays(mesh, count, SEED);
            let rays = accel.capabilities().admitted(&rays);
            let place = format!("{} on {name:?}, {} rays", subject.name, stratum.name());
            let traced = match trace(&accel, &rays, subject.limit) {
                Ok(traced) => traced,
                Err(ended) => {
                    // A single ray may cause the failure.
                    let alone = rays.iter().find(|ray| trace(&accel, &[**ray], subject.limit).is_err());
                    let which = alone.map_or("all rays".into(), |ray| format!("ray \"{ray}\""));
                    return Err(format!("{place}: tracing {which} with counts failed: {ended}"));
                }
            };

            // The choice among several primitives at one `t` is free, unless the lowest is promised.
            let number = |h: Hit| if subject.lowest_id { h.prim.index() } else { 0 };
            let answer = |hit: Option<Hit>| hit.map(|h| (h.t, number(h)));
            let differ = traced.plain.iter().zip(&traced.counted).position(|(a, b)| answer(*a) != answer(*b));
            let differ = differ.or_else(|| traced.any.iter().zip(&traced.any_counted).position(|(a, b)| a != b));
            if let Some(i) = differ {
                lines.push(format!("{place}: counting changes the hit of ray \"{}\"", rays[i]));
            }

            let bits = |hit: Option<Hit>| hit.map(|h| (h.t.to_bits(), h.prim));
            let differ = traced.plain.iter().zip(&traced.loaded).position(|(a, b)| bits(*a) != bits(*b));
            let differ = differ.or_else(|| traced.any.iter().zip(&traced.any_loaded).position(|(a, b)| a != b));
            if let Some(i) = differ {
                lines.push(format!("{place}: loading changes the hit of ray \"{}\"", rays[i]));
            }

            let hit = traced.plain.iter().any(Option::is_some);
            let mut all = vec![("closest", traced.counts)];
            all.extend(asks_any.then_some(("any", traced.any_counts)));
            for (which, c) in all {
                if !observed.steps && c.steps() > 0 || !observed.tests && c.tests > 0 {
                    lines.push(format!(
                        "{place}: the {which}-hit query counts events that `OBSERVED` does not declare: {c:?}"
                    ));
                }
                if hit && (observed.steps && c.steps() == 0 || observed.tests && c.tests == 0) {
                    lines.push(format!(
                        "{place}: the {which}-hit query finds hits, but counts no step or no test: {c:?}"
                    ));
                }
                if c.empty_leaves > c.leaves {
                    lines.push(format!("{place}: the {which}-hit query counts more empty leaves than leaves: {c:?}"));
                }
            }
        }
    }
    outcome(lines)
}

/// The shape is possible: every triangle with an area is referenced, and the structure takes memory.
///
/// # Errors
/// One line per failing mesh.
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
        for (_, what) in wrong.iter().filter(|(wrong, _)| *wrong) {
            lines.push(format!("{} on {name:?}: {what}: {shape:?}, {footprint:?}", subject.name));
        }
    }
    outcome(lines)
}
