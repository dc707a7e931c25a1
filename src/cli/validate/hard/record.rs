//! Scores as data.

use serde::Serialize;

use crate::measure::Provenance;
use crate::registry::Choice;
use crate::validate::Ulps;
use crate::validate::hard_cases::{HardCase, Property, Rank, Score};

/// A run as JSON.
#[derive(Debug, Serialize)]
pub struct HardRun {
    /// Of this form.
    pub schema: u32,
    pub provenance: Provenance,
    /// Case by case, structure by structure.
    pub results: Vec<HardRecord>,
}

/// One structure on one case. Numbers that are not known are null.
#[derive(Debug, Serialize)]
pub struct HardRecord {
    pub number: u32,
    pub case: &'static str,
    pub rank: Rank,
    pub structure: String,
    pub label: String,
    pub triangle_test: String,
    /// `answered`, `hang`, `panic`, `crash`, `refused` or `declined`.
    pub outcome: &'static str,
    pub clean: bool,
    pub rays: Option<u64>,
    pub hits: Option<u64>,
    pub missed: Option<u64>,
    pub false_hits: Option<u64>,
    /// By more than 4 ulps and more than 1e-6.
    pub wrong_depth: Option<u64>,
    /// Those of them by more than 1 %, or 0.1 % at another primitive.
    pub coarse_depth: Option<u64>,
    pub wrong_primitive: Option<u64>,
    pub structure_errors: Option<u64>,
    pub contradictions: Option<u64>,
    pub inexact: Option<u64>,
    pub ulps: Option<Ulps>,
    pub slowness: Option<f64>,
    pub build_ns: Option<u64>,
    /// Of a case that is a property.
    pub property: Option<Property>,
}

impl HardRun {
    /// 2: `wrong_depth` is strict, and `coarse_depth` stands beside it.
    pub const SCHEMA: u32 = 2;
}

impl HardRecord {
    pub fn new(case: &HardCase, choice: &Choice, score: &Score) -> Self {
        let rays = score.rays();
        let judged = rays.map(|rays| &rays.judged);
        Self {
            number: case.number,
            case: case.name,
            rank: case.rank,
            structure: choice.entry.name.clone(),
            label: choice.label.clone(),
            triangle_test: choice.triangle_test().into(),
            outcome: match score {
                Score::Failed(failure) => failure.name(),
                _ => "answered",
            },
            clean: score.is_clean(),
            rays: judged.map(|judged| judged.rays),
            hits: judged.map(|judged| judged.hits),
            missed: judged.map(|judged| judged.missed),
            false_hits: judged.map(|judged| judged.false_hits),
            wrong_depth: judged.map(|judged| judged.wrong_depth),
            coarse_depth: rays.map(|rays| rays.coarse_depth),
            wrong_primitive: judged.map(|judged| judged.wrong_primitive),
            structure_errors: rays.and_then(|rays| rays.structure_errors),
            contradictions: rays.map(|rays| rays.contradictions),
            inexact: rays.map(|rays| rays.inexact),
            ulps: judged.and_then(|judged| judged.ulps),
            slowness: rays.and_then(|rays| rays.slowness),
            build_ns: rays.map(|rays| rays.build_ns),
            property: match score {
                Score::Property(property) => Some(property.clone()),
                _ => None,
            },
        }
    }
}
