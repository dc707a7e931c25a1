//! The result of a structure in a scene, and the verdict over all scenes.

use serde_json::{Value, json};

use crate::accel::BuildError;
use crate::cli::terminal::Terminal;
use crate::measure::Provenance;
use crate::names::named;
use crate::output::OutputFile;
use crate::registry::{Choice, plain_name};
use crate::request::known_defect;
use crate::study::{Status, Verdict};
use crate::validate::{Kind, Validation};

#[derive(Debug, thiserror::Error)]
pub enum BuildFailure {
    #[error("it hangs: its build did not finish within {0} s (see --limit)")]
    Hangs(f64),
    #[error(transparent)]
    Refused(#[from] BuildError),
}

/// The result of one structure, or of one file of hits, in one scene.
pub struct Outcome {
    pub scene: String,
    pub label: String,
    pub triangle_test: String,
    /// `false` only for the structures of `Registry::builtin`.
    pub is_external: bool,
    /// Wrong hits of a structure with a known defect do not change the exit status.
    pub has_known_defect: bool,
    pub found: Result<Validation, BuildFailure>,
}

impl Outcome {
    pub fn new(scene: &str, choice: &Choice, found: Result<Validation, BuildFailure>) -> Self {
        Self {
            scene: scene.into(),
            label: plain_name(&choice.label).into(),
            triangle_test: choice.triangle_test().into(),
            is_external: !choice.entry.is_builtin,
            has_known_defect: known_defect(&choice.entry.name).is_some(),
            found,
        }
    }

    pub fn status(&self, strict: bool) -> Status {
        match &self.found {
            Err(BuildFailure::Hangs(_)) => Status::Wrong,
            Err(BuildFailure::Refused(_)) => Status::Refused,
            Ok(_) if self.has_known_defect => Status::Right,
            Ok(found) => {
                let verdict = Verdict::from(found);
                if verdict.wrong > 0 || strict && verdict.rounded > 0 { Status::Wrong } else { Status::Right }
            }
        }
    }

    pub fn has_example(&self) -> bool {
        !self.has_known_defect && self.found.as_ref().is_ok_and(|found| !found.worst.is_empty())
    }

    fn verdict(&self) -> Verdict {
        match &self.found {
            Ok(found) => found.into(),
            Err(BuildFailure::Hangs(_)) => Verdict { rays: 1, wrong: 1, rounded: 0, fault: Some(Kind::Hangs) },
            Err(BuildFailure::Refused(_)) => Verdict::default(),
        }
    }

    pub fn record(&self) -> Value {
        let mut record = json!({
            "scene": self.scene,
            "label": self.label,
            "triangle_test": self.triangle_test,
            "outcome": match &self.found {
                Ok(_) => "answered",
                Err(BuildFailure::Hangs(_)) => "hang",
                Err(BuildFailure::Refused(_)) => "refused",
            },
            "verdict": self.verdict(),
        });
        let Ok(found) = &self.found else { return record };
        let worst = found.worst.iter().map(|worst| {
            let hit = |hit: Option<crate::geometry::Hit>| hit.map(|hit| json!([hit.t, hit.prim.index()]));
            json!({
                "ray": worst.ray.to_string(),
                "kind": worst.kind,
                "expected": hit(worst.expected),
                "found": hit(worst.found),
                "sentence": worst.verdict,
            })
        });
        record["rays"] = found.rays.into();
        record["declined"] = found.declined.into();
        record["hits"] = found.hits.into();
        record["structure_errors"] = (found.errors() - found.answer_errors).into();
        record["answer_errors"] = found.answer_errors.into();
        record["depth_errors"] = found.depth_errors.into();
        record["test_errors"] = found.test_errors.into();
        record["reference_errors"] = found.reference_errors.into();
        record["ties"] = found.ties.into();
        record["worst"] = worst.collect();
        record
    }
}

/// The verdict on a structure over all scenes or hard cases.
pub struct StructureVerdict {
    pub label: String,
    pub is_external: bool,
    pub verdict: Verdict,
    /// The first scene or hard case in which the structure was not checked, and the reason.
    pub unchecked: Option<(String, String)>,
}

impl StructureVerdict {
    pub fn sentence(&self) -> String {
        let Self { label, verdict, .. } = self;
        match &self.unchecked {
            None => verdict.sentence(label),
            Some((_, why)) if verdict.rays == 0 => format!("{label} was not checked: {why}."),
            Some((scene, why)) => format!("{} It was not checked in {scene}: {why}.", verdict.sentence(label)),
        }
    }
}

pub fn verdicts(outcomes: &[Outcome]) -> Vec<StructureVerdict> {
    let mut all: Vec<StructureVerdict> = vec![];
    for outcome in outcomes {
        let verdict = outcome.verdict();
        let unchecked = match &outcome.found {
            Err(BuildFailure::Refused(why)) => Some((outcome.scene.clone(), why.to_string())),
            _ => None,
        };
        if let Some(own) = named(&mut all, &outcome.label, |own| &own.label) {
            own.verdict = own.verdict.and(verdict);
            own.unchecked = own.unchecked.take().or(unchecked);
        } else {
            let (label, is_external) = (outcome.label.clone(), outcome.is_external);
            all.push(StructureVerdict { label, is_external, verdict, unchecked });
        }
    }
    all
}

/// Prints the verdicts on external structures. Writes the run to `json` in the format of `src/study/SCHEMA.md`.
pub fn finish(
    verdicts: &[StructureVerdict],
    results: &[Value],
    json: Option<OutputFile>,
    terminal: &Terminal,
) -> anyhow::Result<()> {
    terminal.print_lines(verdicts.iter().filter(|own| own.is_external).map(StructureVerdict::sentence));
    let Some(file) = json else { return Ok(()) };
    let verdict =
        |own: &StructureVerdict| json!({ "label": own.label, "verdict": own.verdict, "sentence": own.sentence() });
    let run = json!({
        "schema": 3,
        // Each structure traces its rays on one thread.
        "provenance": Provenance::capture(1),
        "verdicts": verdicts.iter().map(verdict).collect::<Vec<_>>(),
        "results": results,
    });
    Ok(file.write(&serde_json::to_vec_pretty(&run)?)?)
}
