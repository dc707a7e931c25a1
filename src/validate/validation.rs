//! The result of a comparison of a structure with its reference.

use std::fmt::{Display, Formatter};

use serde::{Deserialize, Serialize};

use crate::geometry::{Hit, Ray};
use crate::names::named_enum;

/// Sums over the rays of a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Validation {
    /// Compared rays, including all rays of a batch that a panic or an endless loop ended.
    pub rays: u64,
    /// Rays that the structure declines ([`Capabilities`](crate::accel::Capabilities)). Their hits are not checked.
    pub declined: u64,
    /// Rays with a hit of the reference.
    pub hits: u64,
    /// Rays on which structure and reference return different hits. Ties do not count. With the same triangle test,
    /// every bit of `t` counts. Otherwise a `t` that [`DepthRule::STRICT`](crate::oracle::DepthRule::STRICT) allows
    /// does not count.
    pub differing: u64,
    /// Hits that the structure lost or invented. Zero in a correct structure.
    pub structure_errors: u64,
    /// Differences that rounding of the structure's triangle test causes.
    pub test_errors: u64,
    /// Differences in which the structure is right and the reference wrong. Zero if the triangle test is the same.
    pub reference_errors: u64,
    /// Wrong hits that rounding of the structure's triangle test cannot explain. Zero if the reference knows this test,
    /// because these hits are then structure errors.
    pub answer_errors: u64,
    /// Depths that `DepthRule::STRICT` rejects, but that rounding in single precision explains. Zero if structure and
    /// reference share the triangle test.
    pub depth_errors: u64,
    /// Rays on which any hit and closest hit contradict each other.
    pub any_hit_errors: u64,
    /// Rays whose hit differs between a batch and a single ray. These rays get no further check.
    pub unrepeatable: u64,
    /// Batches that a panic of the structure ended.
    pub panics: u64,
    /// Batches that took too long. The first one ends the comparison.
    pub hangs: u64,
    /// Rays on which the structure returns another primitive that is hit at the `t` of the reference. Not an error.
    pub ties: u64,
    /// Ties in which the reference's primitive has the lower number. In exact arithmetic, this primitive is hit at or
    /// before the returned `t`. An error only if the structure promises the lowest number.
    pub higher_ids: u64,
    /// At most [`Validation::WORST`] rays, worst first.
    pub worst: Vec<WorstRay>,
}

/// A ray on which structure and reference differ, the structure contradicts itself, or a query panics or hangs.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstRay {
    /// Index among the compared rays.
    pub index: u64,
    pub ray: Ray,
    pub expected: Option<Hit>,
    pub found: Option<Hit>,
    pub kind: Kind,
    /// The reason, in one sentence.
    pub verdict: String,
}

named_enum! {
    /// The kind of a difference. The kinds are ordered from the worst on, and the kinds before `Depth` are errors.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Kind {
        Hangs = "hangs",
        #[serde(rename = "panics")]
        Panicked = "panics",
        /// The structure returns a miss although the ray has an exact hit.
        Lost = "lost",
        /// The structure misses the nearest exact hit, and returns a farther hit or one that does not exist.
        NearerLost = "nearer-lost",
        /// The structure returns a hit that its triangle test does not find. If the test is unknown, exact arithmetic
        /// decides.
        Invented = "invented",
        /// The triangle test hits the returned primitive, but at another `t`.
        WrongT = "wrong-t",
        /// The returned `t` is right, but the returned primitive is not hit there.
        WrongPrimitive = "wrong-primitive",
        AnyHitDisagrees = "any-hit-disagrees",
        Unrepeatable = "unrepeatable",
        /// The primitive is right. `t` is wrong by more than `DepthRule::STRICT` allows, but rounding explains this.
        Depth = "depth",
        /// An error of the triangle test, not of the structure.
        TriangleTest = "triangle-test",
        /// The structure is right, and the reference is wrong.
        Reference = "reference",
        /// `t` is right, but a primitive with a lower number is hit there too. Wrong only if the lowest number is
        /// promised.
        HigherId = "higher-id",
        /// `t` is right, and the returned primitive is hit there too. Not an error.
        Tie = "tie",
    }
}

impl Kind {
    pub fn is_error(self) -> bool {
        self < Self::Depth
    }
}

impl Validation {
    /// The maximum number of stored rays.
    pub const WORST: usize = 10;

    /// All errors that rounding does not explain. 0 for a correct structure.
    pub fn errors(&self) -> u64 {
        self.structure_errors + self.answer_errors + self.any_hit_errors + self.unrepeatable + self.panics + self.hangs
    }

    pub fn worst_error(&self) -> Option<&WorstRay> {
        self.worst.first().filter(|w| w.kind.is_error())
    }

    /// `batches` must be in the order of their rays. `declined` counts the rays that no batch contains.
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

    pub(super) fn note(&mut self, ray: WorstRay, knows_structure_errors: bool) {
        match ray.kind {
            Kind::Tie => self.ties += 1,
            Kind::HigherId => {
                self.ties += 1;
                self.higher_ids += 1;
            }
            Kind::TriangleTest => self.test_errors += 1,
            Kind::Reference => self.reference_errors += 1,
            Kind::Depth => self.depth_errors += 1,
            _ if knows_structure_errors => self.structure_errors += 1,
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
