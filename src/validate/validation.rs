//! The result of a comparison of a structure with its reference.

use std::fmt::{Display, Formatter};

use serde::{Deserialize, Serialize};

use crate::geometry::{Hit, Ray};
use crate::names::named_enum;

/// The counts and the worst rays of a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Validation {
    /// Compared rays, including all rays of batches with a panic or a hang.
    pub rays: u64,
    /// Rays that the structure declines ([`Capabilities`](crate::accel::Capabilities)). The hits of these rays are
    /// not checked.
    pub declined: u64,
    /// Rays for which the reference returns a hit.
    pub hits: u64,
    /// Rays on which structure and reference return different hits, except ties.
    ///
    /// If the triangle tests differ, [`DepthRule::STRICT`](crate::oracle::DepthRule::STRICT) defines which differences
    /// of `t` are ignored. Otherwise every bit of `t` counts.
    pub differing: u64,
    /// Errors of the structure, not of its triangle test. Zero for a correct structure.
    pub structure_errors: u64,
    /// Differences that rounding of the structure's triangle test may explain.
    pub test_errors: u64,
    /// Differences that are errors of the reference. Zero if structure and reference share the triangle test.
    pub reference_errors: u64,
    /// Wrong results that rounding cannot explain. Zero if structure and reference share the triangle test.
    pub answer_errors: u64,
    /// Errors of `t` that `DepthRule::STRICT` does not allow. Rounding may explain these errors. Zero if structure and
    /// reference share the triangle test.
    pub depth_errors: u64,
    /// Rays whose any-hit and closest-hit results contradict each other.
    pub any_hit_errors: u64,
    /// Rays that have different results in a batch and on their own, or in two batches.
    pub unrepeatable: u64,
    /// Batches in which the structure panicked.
    pub panics: u64,
    /// Batches in which a query took too long. A hang ends the comparison.
    pub hangs: u64,
    /// Rays on which structure and reference return different primitives at the same `t`. Not errors.
    pub ties: u64,
    /// Ties with [`Kind::HigherId`]. These ties are errors only if the structure promises the lowest primitive number.
    pub higher_ids: u64,
    /// At most [`Validation::WORST`] rays, worst first.
    pub worst: Vec<WorstRay>,
}

/// A ray with a difference, a panic or a hang.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstRay {
    /// Index among the compared rays.
    pub index: u64,
    pub ray: Ray,
    pub expected: Option<Hit>,
    pub found: Option<Hit>,
    pub kind: Kind,
    /// The reason for `kind`, in one sentence.
    pub verdict: String,
}

named_enum! {
    /// Kinds of differences, from the worst to the mildest. Kinds before `Depth` are errors.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Kind {
        Hangs = "hangs",
        #[serde(rename = "panics")]
        Panicked = "panics",
        /// The structure returns a miss although the ray has an exact hit.
        Lost = "lost",
        /// The structure misses the nearest exact hit, but returns another hit.
        NearerLost = "nearer-lost",
        /// The structure returns a hit that its triangle test does not find. If the triangle test is unknown, exact
        /// arithmetic judges the hit.
        Invented = "invented",
        /// The ray hits the returned primitive, but at another `t`.
        WrongT = "wrong-t",
        /// At the returned `t`, the ray hits another primitive, not the returned one.
        WrongPrimitive = "wrong-primitive",
        AnyHitDisagrees = "any-hit-disagrees",
        Unrepeatable = "unrepeatable",
        /// The error of `t` is larger than `DepthRule::STRICT` allows. Rounding may explain this error.
        Depth = "depth",
        /// An error of the triangle test, not of the structure.
        TriangleTest = "triangle-test",
        /// An error of the reference, not of the structure.
        Reference = "reference",
        /// A tie in which the reference's primitive has the lower number. Exact arithmetic confirms a hit on this
        /// primitive, at this `t` or before. An error only if the structure promises the lowest primitive number.
        HigherId = "higher-id",
        /// Structure and reference return different primitives at the same `t`. Not an error.
        Tie = "tie",
    }
}

impl Kind {
    pub fn is_error(self) -> bool {
        self < Self::Depth
    }
}

impl Validation {
    /// The maximum number of rays in `worst`.
    pub const WORST: usize = 10;

    /// All errors that rounding does not explain. 0 for a correct structure.
    pub fn errors(&self) -> u64 {
        self.structure_errors + self.answer_errors + self.any_hit_errors + self.unrepeatable + self.panics + self.hangs
    }

    pub fn worst_error(&self) -> Option<&WorstRay> {
        self.worst.first().filter(|w| w.kind.is_error())
    }

    /// `batches` must be sorted by ray index. `declined` is the number of declined rays outside the batches.
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
