//! Answers against the truth.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::ask::Answers;
use super::case::{Content, HardCase, Property, Rank};
use super::set::Set;
use crate::accel::BuildError;
use crate::oracle::{Oracle, Truth};
use crate::validate::{DepthRule, ErrorCounts, Reference, count_errors, validate_answers};

/// The mesh, rays and truth of one case, made once for all structures.
pub struct Court {
    /// Nothing for a property.
    set: Option<(Set, Vec<Option<Truth>>)>,
    /// By the triangle test that they run.
    references: BTreeMap<&'static str, Reference>,
}

/// How one structure did on one case.
#[derive(Clone, Debug, PartialEq)]
pub enum Score {
    Rays(RayScore),
    Property(Property),
    /// There are no answers.
    Failed(Failure),
}

/// Why a structure gave no answers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// It took longer than the limit, and was ended.
    Hang,
    /// Its code panicked, building or answering.
    Panic,
    /// Its process ended otherwise.
    Crash,
    /// It does not admit the mesh; the sentence says why.
    Refused(String),
    /// It declines what the rays need; the sentence says what. Neither right nor wrong.
    Declined(String),
}

/// Numbers of one structure on the rays of one case.
#[derive(Clone, Debug, PartialEq)]
pub struct RayScore {
    /// Against the truth, by the strict rule of depth.
    pub judged: ErrorCounts,
    /// Wrong depths by the coarse rule: what shows in a picture.
    pub coarse_depth: u64,
    /// Hits that were lost or invented although the structure's own triangle test, run over all triangles, says otherwise.
    /// Nothing where that test is not known.
    pub structure_errors: Option<u64>,
    /// The worst of them, in a sentence.
    pub example: Option<String>,
    /// Rays for which any hit contradicts closest hit, or a batch a single ray.
    pub contradictions: u64,
    /// Answers that are not the nearest `f32` of the true `t`, or not at the lowest number of the nearest primitives: what a
    /// test that calls itself exact must not give.
    pub inexact: u64,
    /// Time of the rays over that of ordinary ones.
    pub slowness: Option<f64>,
    pub build_ns: u64,
}

impl Failure {
    /// As printed.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Hang => "hang",
            Self::Panic => "panic",
            Self::Crash => "crash",
            Self::Refused(_) => "refused",
            Self::Declined(_) => "declined",
        }
    }
}

impl Court {
    /// Finds the truth of the first `rays` rays of `case`.
    pub fn new(case: &HardCase, rays: usize) -> Self {
        let set = match case.content {
            Content::Rays { rays: most, make, .. } => {
                let set = make(rays.min(most));
                let oracle = Oracle::new(&set.mesh);
                let truths = set.rays.par_iter().map(|ray| oracle.nearest(ray)).collect();
                Some((set, truths))
            }
            Content::Property(_) => None,
        };
        Self { set, references: BTreeMap::new() }
    }

    /// Scores the answers of a structure over `test`.
    ///
    /// # Errors
    /// If brute force refuses the mesh.
    ///
    /// # Panics
    /// If the answers are not those to the rays of this case.
    pub fn score(&mut self, test: &'static str, answers: Answers) -> Result<Score, BuildError> {
        let Some((set, truths)) = &self.set else {
            return Ok(Score::Property(answers.head.property.unwrap_or_default()));
        };
        if !self.references.contains_key(test) {
            self.references.insert(test, Reference::of_test(test, &set.mesh)?);
        }
        let reference = &self.references[test];
        let known = reference.knows_structure_errors();
        let own = known.then(|| {
            let expected = reference.closest_hits(&set.rays);
            validate_answers(reference, &expected, &set.mesh, &set.rays, &answers.hits)
        });

        let inexact = truths.iter().zip(&answers.hits).filter(|(truth, hit)| match (truth, hit) {
            (Some(truth), Some(hit)) => {
                hit.t.to_bits() != truth.rounded().to_bits() || hit.prim.index() != truth.ids[0]
            }
            (truth, hit) => truth.is_some() != hit.is_some(),
        });
        Ok(Score::Rays(RayScore {
            judged: count_errors(truths, &answers.hits, DepthRule::STRICT),
            coarse_depth: count_errors(truths, &answers.hits, DepthRule::COARSE).wrong_depth,
            inexact: inexact.count() as u64,
            structure_errors: own.as_ref().map(|own| own.structure_errors),
            example: own.as_ref().and_then(|own| own.worst_error().map(ToString::to_string)),
            contradictions: answers.head.any_hit_errors + answers.head.unrepeatable,
            slowness: answers.head.slowness,
            build_ns: answers.head.build_ns,
        }))
    }
}

impl Score {
    /// Nothing missed, invented, at a wrong depth (strictly) or lost, and no contradiction.
    pub fn is_clean(&self) -> bool {
        match self {
            Self::Rays(score) => score.judged.errors() == 0 && score.is_sound(),
            Self::Property(property) => property.broken == 0,
            Self::Failed(_) => false,
        }
    }

    /// Nothing that the structure, as against its triangle test, is to blame for.
    pub fn is_sound(&self) -> bool {
        match self {
            Self::Rays(score) => score.is_sound(),
            Self::Property(property) => property.broken == 0,
            Self::Failed(failure) => matches!(failure, Failure::Declined(_)),
        }
    }
}

impl RayScore {
    fn is_sound(&self) -> bool {
        self.structure_errors.unwrap_or(0) == 0 && self.contradictions == 0
    }
}

/// Sums over the ranked cases of one structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    pub cases: u64,
    pub clean: u64,
    /// Cases without answers.
    pub failed: u64,
    pub rays: u64,
    pub hits: u64,
    pub missed: u64,
    pub wrong_depth: u64,
    /// Those of them that the coarse rule finds wrong.
    pub coarse_depth: u64,
    pub false_hits: u64,
    pub structure_errors: u64,
}

impl Totals {
    /// Over the cases whose rank is among `ranks`; for one column of a table.
    pub fn over<'a>(scores: impl IntoIterator<Item = (&'a HardCase, &'a Score)>, ranks: &[Rank]) -> Self {
        let mut totals = Self::default();
        for (_, score) in scores.into_iter().filter(|(case, _)| ranks.contains(&case.rank)) {
            totals.cases += 1;
            totals.clean += u64::from(score.is_clean());
            match score {
                Score::Rays(score) => {
                    let judged = &score.judged;
                    totals.rays += judged.rays;
                    totals.hits += judged.hits;
                    totals.missed += judged.missed;
                    totals.wrong_depth += judged.wrong_depth;
                    totals.coarse_depth += score.coarse_depth;
                    totals.false_hits += judged.false_hits;
                    totals.structure_errors += score.structure_errors.unwrap_or(0);
                }
                Score::Property(_) => {}
                Score::Failed(_) => totals.failed += 1,
            }
        }
        totals
    }

    /// Misses, false hits and wrong depths.
    pub fn errors(&self) -> u64 {
        self.missed + self.wrong_depth + self.false_hits
    }
}
