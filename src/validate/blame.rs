//! Whether the structure, its triangle test or the reference causes a difference.

use std::cmp::Ordering;

use super::rounding::{Margin, Precision, nearest_sure};
use super::{DepthRule, Kind, Reference, ScalarTest};
use crate::exact::{self, ExactT};
use crate::geometry::{Hit, Mesh, PrimId, Ray};

/// The verdict on a difference.
pub(super) struct Blame {
    pub kind: Kind,
    pub sentence: String,
}

/// Judges the hit `found` for which the reference has `expected`; `None` if they agree.
pub(super) fn blame(
    reference: &Reference,
    mesh: &Mesh,
    ray: &Ray,
    expected: Option<Hit>,
    found: Option<Hit>,
) -> Option<Blame> {
    match (reference.test, expected, found) {
        (_, None, None) => None,
        (_, Some(e), Some(f)) if e.same_bits(f) => None,
        (Some(test), ..) => Some(same_test(test, mesh, ray, expected, found)),
        (None, Some(e), Some(f)) if e.prim == f.prim && DepthRule::STRICT.allows(e.t.into(), f.t, true) => None,
        (None, ..) => {
            let verdict = other_test(reference.precision, mesh, ray, expected, found)?;
            Some(match reference.disputed {
                Some(own) => own_test(own, mesh, ray, expected, found, verdict),
                None => verdict,
            })
        }
    }
}

/// The verdict for two different tests. The structure's own test decides about the disputed triangles.
fn own_test(own: ScalarTest, mesh: &Mesh, ray: &Ray, expected: Option<Hit>, found: Option<Hit>, other: Blame) -> Blame {
    let exists = |hit: &Hit| (hit.prim.index() as usize) < mesh.len();
    let of = |hit: Option<Hit>| hit.filter(exists).and_then(|hit| own(ray, mesh.corners(hit.prim.index())));
    let by_the_test = |sentence: &str| verdict(Kind::TriangleTest, format!("{}, but {sentence}", other.sentence));
    match (other.kind, found) {
        // No traversal can return a hit that its test does not find, or does not find in front of the returned one.
        (Kind::Lost | Kind::NearerLost, _) => match (of(expected), found) {
            (None, _) => by_the_test("the structure's own triangle test misses it"),
            (Some(t), Some(f)) if t >= f.t => {
                by_the_test(&format!("the structure's own triangle test hits it at t = {t:?}"))
            }
            _ => other,
        },
        // It may return what its test returns, right or wrong.
        (Kind::WrongT | Kind::Invented, Some(f)) => match of(found) {
            Some(t) if DepthRule::COARSE.allows(t.into(), f.t, true) => {
                by_the_test("the structure's own triangle test gives the same result")
            }
            _ => other,
        },
        _ => other,
    }
}

/// Relative distance of two hits.
pub(super) fn gap(expected: Option<Hit>, found: Option<Hit>) -> f64 {
    match (expected, found) {
        (Some(e), Some(f)) => (f64::from(e.t) - f64::from(f.t)).abs() / f64::from(e.t.abs().max(f32::MIN_POSITIVE)),
        _ => f64::INFINITY,
    }
}

/// Both must return the same bits, and the reference has tested every triangle.
fn same_test(test: ScalarTest, mesh: &Mesh, ray: &Ray, expected: Option<Hit>, found: Option<Hit>) -> Blame {
    // The test must return this hit at this primitive.
    if let Some(f) = found {
        let solid = (f.prim.index() as usize) < mesh.len() && !mesh.is_degenerate(f.prim.index());
        let tested = if solid { test(ray, mesh.corners(f.prim.index())) } else { None };
        let right_t = expected.is_some_and(|e| e.t.to_bits() == f.t.to_bits());
        match tested {
            Some(t) if t.to_bits() == f.t.to_bits() => {}
            _ if right_t => {
                let there = tested.map_or("no hit".into(), |t| format!("t = {t:?}"));
                return verdict(Kind::WrongPrimitive, format!("the triangle test gives {there} at {:?}", f.prim));
            }
            Some(t) => {
                let ulps = t.to_bits().abs_diff(f.t.to_bits());
                let sentence = format!("the triangle test gives t = {t:?} at {:?}, {ulps} ulps away", f.prim);
                return verdict(Kind::WrongT, sentence);
            }
            _ => {
                let sentence = format!("the triangle test gives no hit at {:?}{}", f.prim, outside(ray, f));
                return verdict(Kind::Invented, sentence);
            }
        }
    }

    let Some(e) = expected else {
        return verdict(Kind::Invented, "the reference has no such hit".into());
    };
    match found {
        Some(f) if f.t == e.t => tie(mesh, ray, e, f),
        Some(f) if f.t < e.t => verdict(Kind::Invented, "the reference has no such hit".into()),
        _ => lost(mesh, ray, e, found),
    }
}

/// The structure returns less than its test found: an error if the missing hit is real.
fn lost(mesh: &Mesh, ray: &Ray, expected: Hit, found: Option<Hit>) -> Blame {
    let Some(nearer) = true_hit(mesh, ray, expected) else {
        let sentence = format!("by exact arithmetic the ray does not hit {:?} in its interval", expected.prim);
        return verdict(Kind::TriangleTest, sentence);
    };
    let sure = exactly(expected.prim, nearer.round());
    let Some(f) = found else { return verdict(Kind::Lost, sure) };
    if nearer.compare(f.t).is_some_and(Ordering::is_ge) {
        // It may cull hits behind the computed one.
        let sentence = format!("{sure}, which is not before the computed t of {:?}: the traversal may skip it", f.prim);
        return verdict(Kind::TriangleTest, sentence);
    }
    match true_hit(mesh, ray, f) {
        Some(t) if t <= nearer => verdict(Kind::TriangleTest, format!("{sure} and {:?} no later", f.prim)),
        Some(t) => verdict(Kind::NearerLost, format!("{sure} and {:?} later, at t = {:?}", f.prim, t.round())),
        None => verdict(Kind::NearerLost, format!("{sure} and does not hit {:?} in its interval", f.prim)),
    }
}

/// The same computed `t` at two primitives. The lower number must win if the traversal had to visit it.
fn tie(mesh: &Mesh, ray: &Ray, expected: Hit, found: Hit) -> Blame {
    let lower = true_hit(mesh, ray, expected).filter(|t| t.compare(found.t).is_some_and(Ordering::is_le));
    if lower.is_some() && expected.prim.index() < found.prim.index() {
        return verdict(
            Kind::HigherId,
            format!("by exact arithmetic the ray also hits {:?}, at this t or before", expected.prim),
        );
    }
    verdict(Kind::Tie, "both primitives have this computed t".into())
}

/// The nearest of two hits that is exactly a hit.
fn nearest(mesh: &Mesh, ray: &Ray, expected: Option<Hit>, found: Option<Hit>) -> Option<(ExactT, PrimId)> {
    let truths = [expected, found].map(|hit| Some((true_hit(mesh, ray, hit?)?, hit?.prim)));
    truths.into_iter().flatten().min_by(|(a, _), (b, _)| a.cmp(b))
}

/// The structure and the reference have different tests. Exact arithmetic judges structure and test together;
/// differences that rounding in this precision explains are blamed on the test.
fn other_test(
    precision: Precision,
    mesh: &Mesh,
    ray: &Ray,
    expected: Option<Hit>,
    found: Option<Hit>,
) -> Option<Blame> {
    let truth = nearest(mesh, ray, expected, found);
    if let Some(blame) = found.and_then(|hit| no_hit(precision, mesh, ray, hit, truth.as_ref())) {
        return Some(blame);
    }
    // The structure compares computed depths: it has lost a hit that is computed before this one.
    let limit = found.map_or(f64::INFINITY, |hit| hit.t.into());
    let is_found = |t: &ExactT, prim| {
        found.is_some_and(|f| f.prim == prim || DepthRule::STRICT.allows(t.approximate(), f.t, false))
    };
    if let Some((t, prim)) = truth.as_ref().filter(|(t, prim)| !is_found(t, *prim)) {
        let margin = Margin::new(ray, mesh.corners(prim.index()), precision);
        let kind = if found.is_some() { Kind::NearerLost } else { Kind::Lost };
        if margin.latest() < limit && !margin.may_miss(ray) {
            return Some(verdict(kind, exactly(*prim, t.round())));
        }
        // A test may miss the nearest triangle or place it behind a later one, but may not return a hit behind that
        // one.
        if precision == Precision::Single
            && let Some((t, prim)) = nearest_sure(mesh, ray, limit)
        {
            return Some(verdict(kind, exactly(prim, t as f32)));
        }
    }
    rounded(truth, expected, found)
}

/// The reason why no test of this precision returns that hit; `None` if one may return it.
fn no_hit(precision: Precision, mesh: &Mesh, ray: &Ray, found: Hit, truth: Option<&(ExactT, PrimId)>) -> Option<Blame> {
    let is_there =
        truth.is_some_and(|(t, prim)| *prim != found.prim && DepthRule::COARSE.allows(t.approximate(), found.t, false));
    let wrong = |kind, sentence| Some(verdict(if is_there { Kind::WrongPrimitive } else { kind }, sentence));
    if found.prim.index() as usize >= mesh.len() {
        return wrong(Kind::Invented, format!("the mesh has no {:?}", found.prim));
    }
    let margin = Margin::new(ray, mesh.corners(found.prim.index()), precision);
    match true_hit(mesh, ray, found) {
        Some(t) if DepthRule::STRICT.allows(t.approximate(), found.t, true) || margin.may_round_to(found.t) => None,
        Some(t) => {
            let ulps = t.round().to_bits().abs_diff(found.t.to_bits());
            wrong(Kind::WrongT, format!("{}, {ulps} ulps away", exactly(found.prim, t.round())))
        }
        None if margin.may_hit(ray, found.t) => None,
        None => {
            let (prim, why) = (found.prim, outside(ray, found));
            wrong(Kind::Invented, format!("by exact arithmetic the ray does not hit {prim:?} in its interval{why}"))
        }
    }
}

/// Describes a hit outside the interval of its ray; empty if it is inside.
fn outside(ray: &Ray, found: Hit) -> String {
    let (t_min, t_max) = ray.interval();
    if t_min <= found.t && found.t < t_max {
        return String::new();
    }
    let rule = if found.t < 0.0 { "; hits at negative t never count" } else { "" };
    format!(", and t = {:?} is not in [{t_min:?}, {t_max:?}){rule}", found.t)
}

/// Rounding may explain every lost or invented hit: decides whether structure or reference is wrong.
fn rounded(truth: Option<(ExactT, PrimId)>, expected: Option<Hit>, found: Option<Hit>) -> Option<Blame> {
    let is_right = |hit: Option<Hit>| match (&truth, hit) {
        (None, None) => true,
        (Some((t, _)), Some(hit)) => DepthRule::STRICT.allows(t.approximate(), hit.t, true),
        _ => false,
    };
    let sure = match &truth {
        Some((t, prim)) => exactly(*prim, t.round()),
        None => "by exact arithmetic the ray hits no such triangle in its interval".into(),
    };
    match (is_right(expected), is_right(found), &truth, found) {
        (true, true, ..) => None,
        (false, true, ..) => Some(verdict(Kind::Reference, sure)),
        (_, false, Some((t, prim)), Some(f)) if *prim == f.prim => {
            let ulps = t.round().to_bits().abs_diff(f.t.to_bits());
            Some(verdict(Kind::Depth, format!("{sure}, {ulps} ulps away")))
        }
        _ => Some(verdict(
            Kind::TriangleTest,
            format!("{sure}; rounding in single precision may explain the difference"),
        )),
    }
}

/// An exact hit as a clause.
fn exactly(prim: PrimId, t: f32) -> String {
    format!("by exact arithmetic the ray hits {prim:?} at t = {t:?}")
}

fn verdict(kind: Kind, sentence: String) -> Blame {
    Blame { kind, sentence }
}

/// The exact `t` of the primitive of a hit, if the ray meets it in its interval.
fn true_hit(mesh: &Mesh, ray: &Ray, hit: Hit) -> Option<ExactT> {
    let exists = (hit.prim.index() as usize) < mesh.len() && ray.is_valid();
    exists.then(|| exact::hit(ray, mesh.corners(hit.prim.index())))?.filter(|t| t.is_within(ray))
}
