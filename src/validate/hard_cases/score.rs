//! Scores the hits of a structure on a hard case.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::answers::Answers;
use super::case::{HardCase, Property};
use super::set::Set;
use crate::accel::BuildError;
use crate::oracle::DepthRule;
use crate::oracle::{Oracle, Truth};
use crate::validate::{ErrorCounts, ExpectedHits, Reference, Validation, count_errors, validate_hits};

/// The mesh, the rays and the exact hits of one case.
pub struct CaseTruth {
    /// `None` if the case has no rays.
    set: Option<(Set, Vec<Option<Truth>>)>,
    /// The key is the name of a triangle test.
    references: BTreeMap<&'static str, Reference>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Score {
    Rays(Box<RayScore>),
    Property(Property),
    Failed(Failure),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    Hang,
    Panic,
    /// The process of the structure ended without a result.
    Crash,
    /// The reason why the structure cannot be built over the mesh.
    Refused(String),
    /// The reason why the structure declines a ray of the case.
    Declined(String),
}

#[derive(Clone, Debug, PartialEq)]
pub struct RayScore {
    /// Differences from the exact hits, counted by [`DepthRule::STRICT`].
    pub error_counts: ErrorCounts,
    /// The number of hits whose depth [`DepthRule::COARSE`] rejects.
    pub coarse_depth: u64,
    /// The result of the comparison with brute force.
    pub validation: Validation,
    /// Whether `validation` distinguishes errors of the structure from errors of its triangle test.
    pub knows_structure_errors: bool,
    /// The number of contradictions between two queries of the same ray.
    pub contradictions: u64,
    /// The number of results that differ from the correctly rounded exact hit. If the ray hits several primitives at
    /// the same exact `t`, the lowest primitive number is expected.
    pub inexact: u64,
    /// See [`Answers::slowness`].
    pub slowness: Option<f64>,
    pub build_ns: u64,
}

impl Failure {
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

impl CaseTruth {
    pub fn new(case: &HardCase, rays: usize) -> Self {
        let with_truths = |set: Set| {
            let oracle = Oracle::new(&set.mesh);
            let truths = set.rays.par_iter().map(|ray| oracle.nearest(ray)).collect();
            (set, truths)
        };
        Self { set: case.set(rays).map(with_truths), references: BTreeMap::new() }
    }

    /// Scores the results of a structure. `test` is the name of the triangle test of the structure.
    ///
    /// # Errors
    /// If brute force cannot be built over the mesh.
    ///
    /// # Panics
    /// If the number of hits differs from the number of rays.
    pub fn score(&mut self, test: &'static str, answers: Answers) -> Result<Score, BuildError> {
        let Some((set, truths)) = &self.set else {
            return Ok(Score::Property(answers.property.unwrap_or_default()));
        };
        if !self.references.contains_key(test) {
            self.references.insert(test, Reference::of_test(test, &set.mesh)?);
        }
        let reference = &self.references[test];
        let (mesh, rays, hits) = (&set.mesh, &set.rays, &reference.closest_hits(&set.rays));
        let validation = validate_hits(&ExpectedHits { reference, mesh, rays, hits }, &answers.hits);

        let inexact = truths.iter().zip(&answers.hits).filter(|(truth, hit)| match (truth, hit) {
            (Some(truth), Some(hit)) => {
                (hit.t.to_bits(), hit.prim.index()) != (truth.rounded().to_bits(), truth.ids[0])
            }
            (truth, hit) => truth.is_some() != hit.is_some(),
        });
        Ok(Score::Rays(Box::new(RayScore {
            error_counts: count_errors(truths, &answers.hits, DepthRule::STRICT),
            coarse_depth: count_errors(truths, &answers.hits, DepthRule::COARSE).wrong_depth,
            inexact: inexact.count() as u64,
            validation,
            knows_structure_errors: reference.knows_structure_errors(),
            contradictions: answers.any_hit_errors + answers.unrepeatable,
            slowness: answers.slowness,
            build_ns: answers.build_ns,
        })))
    }
}

impl Score {
    /// `None` for a property or a failure.
    pub fn rays(&self) -> Option<&RayScore> {
        match self {
            Self::Rays(score) => Some(score),
            _ => None,
        }
    }

    /// Whether the structure completes the case without errors. Triangle-test errors count as errors.
    pub fn is_clean(&self) -> bool {
        match self {
            Self::Rays(score) => score.error_counts.errors() == 0 && score.is_sound(),
            Self::Property(property) => property.broken == 0,
            Self::Failed(_) => false,
        }
    }

    /// Whether the structure has no errors except triangle-test errors. The structure may decline the case.
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
        self.validation.errors() == 0 && self.contradictions == 0
    }

    /// A description of the worst error.
    pub fn example(&self) -> Option<String> {
        self.validation.worst_error().map(ToString::to_string)
    }
}
