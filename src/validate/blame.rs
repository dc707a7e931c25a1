//! Decides whether the structure, its triangle test or the reference causes a difference.

use std::cmp::Ordering;

use glam::Vec3;

use super::rounding::{Margin, Precision, nearest_certain_hit};
use super::{Kind, Reference, ScalarTest};
use crate::exact::{self, ExactT};
use crate::geometry::{Hit, Mesh, PrimId, Ray};
use crate::oracle::DepthRule;

/// The kind of a difference, and the reason in one sentence.
pub(super) type Blame = (Kind, String);

pub(super) struct Dispute<'a> {
    pub reference: &'a Reference,
    pub mesh: &'a Mesh,
    pub ray: &'a Ray,
    pub expected: Option<Hit>,
    pub found: Option<Hit>,
}

impl Dispute<'_> {
    /// `None` if structure and reference agree.
    pub fn blame(&self) -> Option<Blame> {
        match (self.reference.test, self.expected, self.found) {
            (_, None, None) => None,
            (_, Some(e), Some(f)) if e.same_bits(f) => None,
            (Some(test), ..) => Some(self.same_test(test)),
            (None, Some(e), Some(f)) if e.prim == f.prim && DepthRule::STRICT.allows(e.t.into(), f.t, true) => None,
            (None, ..) => {
                let blame = self.other_test()?;
                Some(match self.reference.disputed {
                    Some(own) => self.own_test(own, blame),
                    None => blame,
                })
            }
        }
    }

    /// `own` is the triangle test of the structure. `other` is the result of `other_test`.
    fn own_test(&self, own: ScalarTest, other: Blame) -> Blame {
        let of = |hit: Option<Hit>| hit.and_then(|hit| own(self.ray, self.corners(hit.prim)?));
        let by_the_test = |sentence: &str| (Kind::TriangleTest, format!("{}, but {sentence}", other.1));
        match (other.0, self.found) {
            // The traversal is right if `own` finds no hit nearer than `found` on the expected triangle.
            (Kind::Lost | Kind::NearerLost, found) => match (of(self.expected), found) {
                (None, _) => by_the_test("the structure's own triangle test misses it"),
                (Some(t), Some(f)) if t >= f.t => {
                    by_the_test(&format!("the structure's own triangle test hits it at t = {t:?}"))
                }
                _ => other,
            },
            // A wrong hit is a triangle-test error if `own` returns this hit.
            (Kind::WrongT | Kind::Invented, Some(f)) => match of(self.found) {
                Some(t) if DepthRule::COARSE.allows(t.into(), f.t, true) => {
                    by_the_test("the structure's own triangle test gives the same result")
                }
                _ => other,
            },
            _ => other,
        }
    }

    /// Judges a structure if the reference has the same triangle test.
    fn same_test(&self, test: ScalarTest) -> Blame {
        // The test must return `f.t` for the found primitive.
        if let Some(f) = self.found {
            let solid = self.corners(f.prim).filter(|_| !self.mesh.is_degenerate(f.prim.index()));
            let right_t = self.expected.is_some_and(|e| e.t.to_bits() == f.t.to_bits());
            match solid.and_then(|corners| test(self.ray, corners)) {
                Some(t) if t.to_bits() == f.t.to_bits() => {}
                tested if right_t => {
                    let there = tested.map_or("no hit".into(), |t| format!("t = {t:?}"));
                    return (Kind::WrongPrimitive, format!("the triangle test gives {there} at {:?}", f.prim));
                }
                Some(t) => {
                    let ulps = t.to_bits().abs_diff(f.t.to_bits());
                    let sentence = format!("the triangle test gives t = {t:?} at {:?}, {ulps} ulps away", f.prim);
                    return (Kind::WrongT, sentence);
                }
                None => {
                    let sentence = format!("the triangle test gives no hit at {:?}{}", f.prim, outside(self.ray, f));
                    return (Kind::Invented, sentence);
                }
            }
        }
        match (self.expected, self.found) {
            (Some(e), Some(f)) if f.t == e.t => self.tie(e, f),
            (Some(e), found) if found.is_none_or(|f| f.t > e.t) => self.lost(e),
            _ => (Kind::Invented, "the reference has no such hit".into()),
        }
    }

    /// Exact arithmetic judges a missing hit or a hit behind `expected`.
    fn lost(&self, expected: Hit) -> Blame {
        let Some(nearer) = self.true_hit(expected) else {
            let sentence = format!("by exact arithmetic the ray does not hit {:?} in its interval", expected.prim);
            return (Kind::TriangleTest, sentence);
        };
        let sure = exactly(expected.prim, nearer.round());
        let Some(f) = self.found else { return (Kind::Lost, sure) };
        if nearer.compare(f.t).is_some_and(Ordering::is_ge) {
            let sentence =
                format!("{sure}, which is not before the computed t of {:?}: the traversal may skip it", f.prim);
            return (Kind::TriangleTest, sentence);
        }
        match self.true_hit(f) {
            Some(t) if t <= nearer => (Kind::TriangleTest, format!("{sure} and {:?} no later", f.prim)),
            Some(t) => (Kind::NearerLost, format!("{sure} and {:?} later, at t = {:?}", f.prim, t.round())),
            None => (Kind::NearerLost, format!("{sure} and does not hit {:?} in its interval", f.prim)),
        }
    }

    /// Judges a hit with the expected `t` on another primitive.
    fn tie(&self, expected: Hit, found: Hit) -> Blame {
        let lower = self.true_hit(expected).filter(|t| t.compare(found.t).is_some_and(Ordering::is_le));
        if lower.is_some() && expected.prim.index() < found.prim.index() {
            let sentence = format!("by exact arithmetic the ray also hits {:?}, at this t or before", expected.prim);
            return (Kind::HigherId, sentence);
        }
        (Kind::Tie, "both primitives have this computed t".into())
    }

    /// The nearer of the two returned hits that exact arithmetic confirms. No other triangle is tested.
    fn nearest(&self) -> Option<(ExactT, PrimId)> {
        let truths = [self.expected, self.found].map(|hit| Some((self.true_hit(hit?)?, hit?.prim)));
        truths.into_iter().flatten().min_by(|(a, _), (b, _)| a.cmp(b))
    }

    /// Judges a structure by exact arithmetic. The reference may have another triangle test.
    fn other_test(&self) -> Option<Blame> {
        let (truth, found) = (self.nearest(), self.found);
        if let Some(blame) = found.and_then(|hit| self.no_hit(hit, truth.as_ref())) {
            return Some(blame);
        }
        // A lost hit is an error if rounding cannot explain the loss.
        let limit = found.map_or(f64::INFINITY, |hit| hit.t.into());
        let is_found = |t: &ExactT, prim| {
            found.is_some_and(|f| f.prim == prim || DepthRule::STRICT.allows(t.approximate(), f.t, false))
        };
        if let Some((t, prim)) = truth.as_ref().filter(|(t, prim)| !is_found(t, *prim)) {
            let margin = self.margin(*prim);
            let kind = if found.is_some() { Kind::NearerLost } else { Kind::Lost };
            if margin.latest() < limit && !margin.may_miss(self.ray) {
                return Some((kind, exactly(*prim, t.round())));
            }
            // Every single-precision triangle test must return a hit on the triangle of `nearest_certain_hit`.
            if self.reference.precision == Precision::Single
                && let Some((t, prim)) = nearest_certain_hit(self.mesh, self.ray, limit)
            {
                return Some((kind, exactly(prim, t as f32)));
            }
        }
        self.rounded(truth)
    }

    /// `None` if a triangle test with the precision `reference.precision` may return `found`.
    fn no_hit(&self, found: Hit, truth: Option<&(ExactT, PrimId)>) -> Option<Blame> {
        let prim = found.prim;
        let is_there =
            truth.is_some_and(|(t, near)| *near != prim && DepthRule::COARSE.allows(t.approximate(), found.t, false));
        let wrong = |kind, sentence| Some((if is_there { Kind::WrongPrimitive } else { kind }, sentence));
        if self.corners(prim).is_none() {
            return wrong(Kind::Invented, format!("the mesh has no {prim:?}"));
        }
        let margin = self.margin(prim);
        match self.true_hit(found) {
            Some(t) if DepthRule::STRICT.allows(t.approximate(), found.t, true) || margin.may_round_to(found.t) => None,
            Some(t) => wrong(Kind::WrongT, exactly_but_off(prim, t.round(), found.t)),
            None if margin.may_hit(self.ray, found.t) => None,
            None => {
                let why = outside(self.ray, found);
                wrong(Kind::Invented, format!("by exact arithmetic the ray does not hit {prim:?} in its interval{why}"))
            }
        }
    }

    /// Judges a difference that rounding may explain. `None` if structure and reference are both right.
    fn rounded(&self, truth: Option<(ExactT, PrimId)>) -> Option<Blame> {
        let is_right = |hit: Option<Hit>| match (&truth, hit) {
            (None, None) => true,
            (Some((t, _)), Some(hit)) => DepthRule::STRICT.allows(t.approximate(), hit.t, true),
            _ => false,
        };
        let sure = match &truth {
            Some((t, prim)) => exactly(*prim, t.round()),
            None => "by exact arithmetic the ray hits neither of the returned triangles in its interval".into(),
        };
        match (is_right(self.expected), is_right(self.found), &truth, self.found) {
            (true, true, ..) => None,
            (false, true, ..) => Some((Kind::Reference, sure)),
            (_, false, Some((t, prim)), Some(f)) if *prim == f.prim => {
                Some((Kind::Depth, exactly_but_off(*prim, t.round(), f.t)))
            }
            _ => {
                let sentence = format!("{sure}; rounding in single precision may explain the difference");
                Some((Kind::TriangleTest, sentence))
            }
        }
    }

    fn corners(&self, prim: PrimId) -> Option<[Vec3; 3]> {
        ((prim.index() as usize) < self.mesh.len()).then(|| self.mesh.corners(prim.index()))
    }

    /// `prim` must be in the mesh.
    fn margin(&self, prim: PrimId) -> Margin {
        Margin::new(self.ray, self.mesh.corners(prim.index()), self.reference.precision)
    }

    /// The exact `t` at the primitive of `hit`. `None` if no exact hit is in the interval of the ray.
    fn true_hit(&self, hit: Hit) -> Option<ExactT> {
        let corners = self.corners(hit.prim).filter(|_| self.ray.is_valid())?;
        exact::hit(self.ray, corners).filter(|t| t.is_within(self.ray))
    }
}

fn outside(ray: &Ray, found: Hit) -> String {
    let (t_min, t_max) = ray.interval();
    if t_min <= found.t && found.t < t_max {
        return String::new();
    }
    let rule = if found.t < 0.0 { "; hits at negative t never count" } else { "" };
    format!(", and t = {:?} is not in [{t_min:?}, {t_max:?}){rule}", found.t)
}

fn exactly(prim: PrimId, t: f32) -> String {
    format!("by exact arithmetic the ray hits {prim:?} at t = {t:?}")
}

fn exactly_but_off(prim: PrimId, t: f32, found: f32) -> String {
    format!("{}, {} ulps away", exactly(prim, t), t.to_bits().abs_diff(found.to_bits()))
}
