//! The result of a comparison.

use std::fmt::{Display, Formatter};

use serde::{Deserialize, Serialize};

use crate::geometry::{Hit, Ray};
use crate::names::named_enum;

/// Sums over the rays of a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Validation {
    /// Compared rays, including all rays of a batch that a panic or an endless loop ended.
    pub rays: u64,
    /// Rays that the structure declines ([`Capabilities`](crate::accel::Capabilities)): they were not traced.
    pub declined: u64,
    /// Rays with a hit of the reference.
    pub hits: u64,
    /// Rays with another `t` than the reference, bit for bit, or with a hit instead of a miss or the reverse. With
    /// different triangle tests: rays on which the two differ by more than 4 ulps and more than 1e-6, relatively.
    pub differing: u64,
    /// Hits lost or invented by the structure; zero in a correct structure.
    pub structure_errors: u64,
    /// Differences that the triangle test causes: by exact arithmetic its hit is a miss or not the nearer hit.
    pub test_errors: u64,
    /// Differences that the reference causes if it has another triangle test: the structure's hit is right.
    pub reference_errors: u64,
    /// Wrong hits of a structure whose triangle test the reference does not share, if rounding of that test cannot
    /// explain them.
    pub answer_errors: u64,
    /// Depths that [`DepthRule::STRICT`](crate::oracle::DepthRule::STRICT) rejects, but that rounding in single
    /// precision explains; only if the reference has another triangle test.
    pub depth_errors: u64,
    /// Rays on which any hit and closest hit contradict each other.
    pub any_hit_errors: u64,
    /// Rays whose hit in a batch differs from the hit on their own; such a hit gets no further check.
    pub unrepeatable: u64,
    /// Batches that a panic of the structure ended.
    pub panics: u64,
    /// Batches that took too long. The first one ends the comparison.
    pub hangs: u64,
    /// Rays with the `t` of the reference at another primitive that also has it: not an error.
    pub ties: u64,
    /// Ties in which the reference's primitive has the lower number and is exactly hit no later: an error only of a
    /// structure that promises the lowest number.
    pub higher_ids: u64,
    /// At most [`Validation::WORST`] rays, worst first.
    pub worst: Vec<WorstRay>,
}

/// A ray on which structure and reference differ.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstRay {
    /// Index among the compared rays.
    pub index: u64,
    pub ray: Ray,
    /// The hit of the reference.
    pub expected: Option<Hit>,
    /// The hit of the structure.
    pub found: Option<Hit>,
    pub kind: Kind,
    /// The reason, in one sentence.
    pub verdict: String,
}

named_enum! {
    /// The kind of a difference, the worst first.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Kind {
        /// A query does not return in time.
        Hangs = "hangs",
        /// The structure panics.
        #[serde(rename = "panics")]
        Panicked = "panics",
        /// The structure misses an exact hit.
        Lost = "lost",
        /// The structure returns a hit behind the exact hit, or one that exact arithmetic does not confirm.
        NearerLost = "nearer-lost",
        /// A hit that the triangle test over all triangles does not return.
        Invented = "invented",
        /// The right primitive at a `t` that the triangle test does not return.
        WrongT = "wrong-t",
        /// The right `t`, at a primitive that is not hit there.
        WrongPrimitive = "wrong-primitive",
        /// Any hit contradicts closest hit.
        AnyHitDisagrees = "any-hit-disagrees",
        /// In a batch the ray has another hit than on its own.
        Unrepeatable = "unrepeatable",
        /// `t` is wrong by more than the strict rule of depth allows, but rounding explains it. Everything else is
        /// right.
        Depth = "depth",
        /// An error of the triangle test, not of the structure.
        TriangleTest = "triangle-test",
        /// The reference, which has another triangle test, is wrong; the structure's hit is right.
        Reference = "reference",
        /// The same `t`, but a lower number is also hit there: wrong only if the lowest number is promised.
        HigherId = "higher-id",
        /// The same `t` at another primitive: not an error.
        Tie = "tie",
    }
}

impl Kind {
    /// Whether the structure's hit is wrong.
    pub fn is_error(self) -> bool {
        self < Self::Depth
    }
}

impl Validation {
    /// The maximum number of stored rays.
    pub const WORST: usize = 10;

    /// Errors of all kinds that no rounding explains; 0 for a correct structure.
    pub fn errors(&self) -> u64 {
        self.structure_errors + self.answer_errors + self.any_hit_errors + self.unrepeatable + self.panics + self.hangs
    }

    /// The worst ray whose hit is wrong.
    pub fn worst_error(&self) -> Option<&WorstRay> {
        self.worst.first().filter(|w| w.kind.is_error())
    }

    /// The sum of all batches, in the order of their rays; `declined` further rays were not traced.
    pub(super) fn of_batches(declined: usize, batches: impl IntoIterator<Item = Self>) -> Self {
        let mut whole = Self { declined: declined as u64, ..Self::default() };
        for mut batch in batches {
            for ray in &mut batch.worst {
                ray.index += whole.rays;
            }
            macro_rules! add {
                ($($count:ident),*) => { $(whole.$count += batch.$count;)* };
            }
            add!(rays, declined, hits, differing, structure_errors, test_errors, reference_errors, answer_errors);
            add!(depth_errors, any_hit_errors, unrepeatable, panics, hangs, ties, higher_ids);
            whole.worst.append(&mut batch.worst);
            whole.keep_worst();
        }
        whole
    }

    /// Counts a ray on which structure and reference differ. `tells_structure_errors`: whether the reference
    /// distinguishes errors of the structure from errors of its triangle test.
    pub(super) fn note(&mut self, ray: WorstRay, tells_structure_errors: bool) {
        match ray.kind {
            Kind::Tie => self.ties += 1,
            Kind::HigherId => {
                self.ties += 1;
                self.higher_ids += 1;
            }
            Kind::TriangleTest => self.test_errors += 1,
            Kind::Reference => self.reference_errors += 1,
            Kind::Depth => self.depth_errors += 1,
            _ if tells_structure_errors => self.structure_errors += 1,
            _ => self.answer_errors += 1,
        }
        self.differing += u64::from(!matches!(ray.kind, Kind::Tie | Kind::HigherId));
        self.worst.push(ray);
    }

    pub(super) fn keep_worst(&mut self) {
        self.worst.sort_by(|a, b| a.kind.cmp(&b.kind).then(b.gap().total_cmp(&a.gap())).then(a.index.cmp(&b.index)));
        self.worst.truncate(Self::WORST);
    }
}

impl WorstRay {
    /// Relative distance of the two `t`; infinite if one of the results is a miss.
    fn gap(&self) -> f64 {
        match (self.expected, self.found) {
            (Some(e), Some(f)) => (f64::from(e.t) - f64::from(f.t)).abs() / f64::from(e.t.abs().max(f32::MIN_POSITIVE)),
            _ => f64::INFINITY,
        }
    }
}

impl Display for WorstRay {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let answer = |hit: Option<Hit>| match hit {
            Some(hit) => format!("t = {:?} at {:?}", hit.t, hit.prim),
            None => "a miss".into(),
        };
        let (kind, expected) = (self.kind.name(), answer(self.expected));
        let found = if self.kind <= Kind::Panicked { "no result".into() } else { answer(self.found) };
        write!(f, "{kind} on ray \"{}\": expected {expected}, got {found}; {}", self.ray, self.verdict)
    }
}
