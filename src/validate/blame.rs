//! Whether the structure, its triangle test or the reference causes a difference.

use std::cmp::Ordering;

use super::{DepthRule, Kind, Reference, ScalarTest};
use crate::exact::{self, ExactT};
use crate::geometry::{Hit, Mesh, PrimId, Ray};

/// How far from the box of a primitive a hit on it may be, relatively: what float tests round.
const OUTSIDE: f64 = 1e-3;

/// The verdict on a difference.
pub(super) struct Blame {
    pub kind: Kind,
    pub sentence: String,
}

/// Judges the hit `found` where the reference has `expected`; nothing if they agree.
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
        (None, Some(e), Some(f)) if close(e.t, f.t, e.prim == f.prim) => {
            if !may_be_at(mesh, ray, f) {
                let sentence = format!("the point hit lies outside the box of {:?}", f.prim);
                return Some(verdict(Kind::WrongPrimitive, sentence));
            }
            let strictly = DepthRule::STRICT.allows(e.t.into(), f.t, e.prim == f.prim);
            (!strictly).then(|| strict(mesh, ray, e, f))
        }
        (None, ..) => {
            let verdict = other_test(mesh, ray, expected, found);
            Some(match reference.disputed {
                Some(own) => own_test(own, mesh, ray, expected, found, verdict),
                None => verdict,
            })
        }
    }
}

/// The verdict on two tests, given what the structure's own says of the triangles in dispute.
fn own_test(own: ScalarTest, mesh: &Mesh, ray: &Ray, expected: Option<Hit>, found: Option<Hit>, other: Blame) -> Blame {
    let exists = |hit: &Hit| (hit.prim.index() as usize) < mesh.len();
    let of = |hit: Option<Hit>| hit.filter(exists).and_then(|hit| own(ray, mesh.corners(hit.prim.index())));
    let by_the_test = |sentence: &str| verdict(Kind::TriangleTest, format!("{}, but {sentence}", other.sentence));
    match (other.kind, found) {
        // What its test does not find, or not in front of what was found, no walk can return.
        (Kind::Lost | Kind::NearerLost, _) => match (of(expected), found) {
            (None, _) => by_the_test("the structure's own test does not hit it"),
            (Some(t), Some(f)) if t >= f.t => by_the_test(&format!("the structure's own test hits it at {t:?}")),
            _ => other,
        },
        // What its test gives, whatever is true, it may return.
        (Kind::WrongT | Kind::Invented, Some(f)) => match of(found) {
            Some(t) if close(t, f.t, true) => by_the_test("so says the structure's own test"),
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
    // A hit must be one that the test gives at that primitive.
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
            _ => return verdict(Kind::Invented, format!("the triangle test gives no hit at {:?}", f.prim)),
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

/// The structure returns less than its test found: an error if that hit is real.
fn lost(mesh: &Mesh, ray: &Ray, expected: Hit, found: Option<Hit>) -> Blame {
    let Some(nearer) = true_hit(mesh, ray, expected) else {
        return verdict(Kind::TriangleTest, format!("exactly, {:?} is not hit in the interval", expected.prim));
    };
    let sure = format!("exactly, {:?} is hit at {:?}", expected.prim, nearer.round());
    let Some(f) = found else { return verdict(Kind::Lost, sure) };
    if nearer.compare(f.t).is_some_and(Ordering::is_ge) {
        // What lies behind a hit as computed may be culled.
        return verdict(Kind::TriangleTest, format!("{sure}, not before the computed t of {:?}", f.prim));
    }
    match true_hit(mesh, ray, f) {
        Some(t) if t <= nearer => verdict(Kind::TriangleTest, format!("{sure}, {:?} not later", f.prim)),
        Some(t) => verdict(Kind::NearerLost, format!("{sure}, {:?} later, at {:?}", f.prim, t.round())),
        None => verdict(Kind::NearerLost, format!("{sure}, {:?} is not hit in the interval", f.prim)),
    }
}

/// The same computed `t` at two primitives. The lower number must win if the traversal had to come to it.
fn tie(mesh: &Mesh, ray: &Ray, expected: Hit, found: Hit) -> Blame {
    let lower = true_hit(mesh, ray, expected).filter(|t| t.compare(found.t).is_some_and(Ordering::is_le));
    if lower.is_some() && expected.prim.index() < found.prim.index() {
        return verdict(Kind::HigherId, format!("exactly, {:?} is hit too, no later", expected.prim));
    }
    verdict(Kind::Tie, "both primitives have this computed t".into())
}

/// Whether the point of a hit lies in the box of its primitive, up to what float tests round. That of a neighbour across an
/// edge does, that of a wrong number hardly ever.
fn may_be_at(mesh: &Mesh, ray: &Ray, hit: Hit) -> bool {
    if hit.prim.index() as usize >= mesh.len() {
        return false;
    }
    let bounds = mesh.triangle_bounds(hit.prim.index());
    (0..3).all(|axis| {
        let (start, way) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]) * f64::from(hit.t));
        let slack = OUTSIDE * (start.abs() + way.abs());
        let (low, high) = (f64::from(bounds.min[axis]), f64::from(bounds.max[axis]));
        (low - slack..=high + slack).contains(&(start + way))
    })
}

/// Two hits that agree but for their depth: the exact answer tells which of them is off.
fn strict(mesh: &Mesh, ray: &Ray, expected: Hit, found: Hit) -> Blame {
    let Some((t, prim)) = nearest(mesh, ray, Some(expected), Some(found)) else {
        return verdict(Kind::TriangleTest, "exactly, neither is a hit in the interval".into());
    };
    let rounded = t.round();
    let sure = format!("exactly, {prim:?} is hit at {rounded:?}");
    if DepthRule::STRICT.allows(t.approximate(), found.t, found.prim == prim) {
        return verdict(Kind::Reference, sure);
    }
    verdict(Kind::Depth, format!("{sure}, {} ulps away", rounded.to_bits().abs_diff(found.t.to_bits())))
}

/// The nearest of two hits that truly is one.
fn nearest(mesh: &Mesh, ray: &Ray, expected: Option<Hit>, found: Option<Hit>) -> Option<(ExactT, PrimId)> {
    let truths = [expected, found].map(|hit| Some((true_hit(mesh, ray, hit?)?, hit?.prim)));
    truths.into_iter().flatten().min_by(|(a, _), (b, _)| a.cmp(b))
}

/// Two tests round differently: only the exact answer can judge, and it judges structure and test together.
fn other_test(mesh: &Mesh, ray: &Ray, expected: Option<Hit>, found: Option<Hit>) -> Blame {
    match (nearest(mesh, ray, expected, found), found) {
        (None, None) => verdict(Kind::Reference, "exactly, nothing is hit there in the interval".into()),
        (None, Some(f)) => verdict(Kind::Invented, format!("exactly, {:?} is not hit in the interval", f.prim)),
        (Some((t, prim)), None) => verdict(Kind::Lost, format!("exactly, {prim:?} is hit at {:?}", t.round())),
        (Some((t, prim)), Some(f)) => {
            let t = t.round();
            let sure = format!("exactly, {prim:?} is hit at {t:?}");
            match (close(t, f.t, f.prim == prim), f.t > t, f.prim == prim) {
                (true, ..) => verdict(Kind::Reference, sure),
                (false, _, true) => verdict(Kind::WrongT, sure),
                (false, true, false) => verdict(Kind::NearerLost, sure),
                (false, false, false) => verdict(Kind::Invented, sure),
            }
        }
    }
}

fn verdict(kind: Kind, sentence: String) -> Blame {
    Blame { kind, sentence }
}

/// The exact `t` of the primitive of a hit, if the ray really meets it in its interval.
fn true_hit(mesh: &Mesh, ray: &Ray, hit: Hit) -> Option<ExactT> {
    let exists = (hit.prim.index() as usize) < mesh.len() && ray.is_valid();
    exists.then(|| exact::hit(ray, mesh.corners(hit.prim.index())))?.filter(|t| t.is_within(ray))
}

fn close(expected: f32, found: f32, same_primitive: bool) -> bool {
    DepthRule::COARSE.allows(expected.into(), found, same_primitive)
}
