//! Defines the tests that every structure must pass, as functions and as the macro `conformance!`.

mod soundness;

use std::sync::Arc;
use std::time::Duration;

use super::{LIMIT, Reference, Stratum, Validation, validate_watched, watched};
use crate::accel::{Accel, BuildError, DynAccel};
use crate::geometry::Mesh;

pub use soundness::{counting, shapes};

pub struct Subject {
    pub name: String,
    /// See [`Accel::TRIANGLE_TEST`].
    pub triangle_test: &'static str,
    /// Whether the structure must return the lowest primitive number among hits at equal `t`.
    pub lowest_id: bool,
    /// Time limit of a build or a query.
    pub limit: Duration,
    pub build: Build,
}

pub type Build = Arc<dyn Fn(&Arc<Mesh>) -> Result<Box<dyn DynAccel>, BuildError> + Send + Sync>;

/// The result for one mesh and one stratum.
pub struct Finding {
    pub mesh: String,
    pub stratum: Stratum,
    pub validation: Validation,
}

pub type Named = (String, Arc<Mesh>);

const SEED: u64 = 2003;

impl Subject {
    pub fn new(
        name: &str,
        triangle_test: &'static str,
        build: impl Fn(&Arc<Mesh>) -> Result<Box<dyn DynAccel>, BuildError> + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), triangle_test, lowest_id: false, limit: LIMIT, build: Arc::new(build) }
    }

    pub fn of<A: Accel>(name: &str, config: A::Config) -> Self {
        Self::new(name, A::TRIANGLE_TEST, move |mesh| Ok(Box::new(A::build(mesh, &config)?)))
    }

    fn built(&self, name: &str, mesh: &Arc<Mesh>) -> Result<Arc<dyn DynAccel>, String> {
        let (build, own) = (Arc::clone(&self.build), Arc::clone(mesh));
        let refusal = |why: String| format!("{} does not build over {name:?}: {why}", self.name);
        let built = watched(self.limit, move || build(&own)).map_err(|ended| refusal(ended.to_string()))?;
        built.map(Arc::from).map_err(|error| refusal(error.to_string()))
    }
}

/// Compares the subject with a reference, on `count` rays per mesh and stratum. A hang ends the comparison.
///
/// # Errors
/// If the subject or the reference cannot be built over a mesh.
pub fn findings(subject: &Subject, meshes: &[Named], count: usize) -> Result<Vec<Finding>, String> {
    let mut findings = vec![];
    for (name, mesh) in meshes {
        let accel = subject.built(name, mesh)?;
        let reference = Reference::of_test(subject.triangle_test, mesh).map_err(|error| error.to_string())?;
        let reference = Arc::new(reference);
        for stratum in Stratum::ALL {
            let rays = stratum.rays(mesh, count, SEED);
            let expected = reference.closest_hits(&rays);
            let validation = validate_watched(&accel, &reference, &expected, mesh, &rays, subject.limit);
            let hangs = validation.hangs > 0;
            findings.push(Finding { mesh: name.clone(), stratum, validation });
            if hangs {
                return Ok(findings);
            }
        }
    }
    Ok(findings)
}

/// Checks that [`findings`] finds no error.
///
/// If `lowest_id` is set, a hit must have the lowest primitive number at equal `t`.
///
/// If this crate lacks the structure's triangle test, differences that rounding may explain are accepted.
///
/// # Errors
/// If a check fails, if a structure cannot be built, or if the subject declines every ray.
pub fn answers(subject: &Subject, meshes: &[Named], count: usize) -> Result<(), String> {
    let wrong = |finding: &Finding| {
        let v = &finding.validation;
        let ids = if subject.lowest_id { v.higher_ids } else { 0 };
        v.errors() + ids > 0
    };
    let findings = findings(subject, meshes, count)?;
    let traced: u64 = findings.iter().map(|f| f.validation.rays).sum();
    if traced == 0 && findings.iter().any(|f| f.validation.declined > 0) {
        return Err(format!("{} declines every ray, so nothing is compared", subject.name));
    }
    let lines = findings.iter().filter(|f| wrong(f)).map(|f| f.line(&subject.name));
    outcome(lines.collect())
}

impl Finding {
    /// Returns the counts and the worst ray in one line.
    pub fn line(&self, subject: &str) -> String {
        let v = &self.validation;
        let worst = v.worst.first().map_or("no ray".into(), ToString::to_string);
        format!(
            "{subject} on {:?}, {} rays: of {} rays, {} structure errors, {} answer errors, {} any-hit errors, {} unrepeatable, \
             {} panics, {} hangs, {} triangle-test errors, {} ties ({} at a higher number), {} declined; worst: {worst}",
            self.mesh,
            self.stratum.name(),
            v.rays,
            v.structure_errors,
            v.answer_errors,
            v.any_hit_errors,
            v.unrepeatable,
            v.panics,
            v.hangs,
            v.test_errors,
            v.ties,
            v.higher_ids,
            v.declined,
        )
    }
}

fn outcome(lines: Vec<String>) -> Result<(), String> {
    const SHOWN: usize = 10;
    if lines.is_empty() {
        return Ok(());
    }
    let more = lines.len().saturating_sub(SHOWN);
    let shown = lines[..lines.len().min(SHOWN)].join("\n");
    Err(if more > 0 { format!("{shown}\nand {more} more") } else { shown })
}

/// Makes a test module that checks a structure against the contract of [`Accel`].
///
/// Example: `sahara::conformance!(my_tree, MyTree, MyConfig::default());`
///
/// A fourth argument `lowest_id` requires the lowest primitive number among hits at equal `t`.
#[macro_export]
macro_rules! conformance {
    ($module:ident, $accel:ty, $config:expr $(, $lowest_id:ident)?) => {
        mod $module {
            use super::*;
            use $crate::validate::{conformance, degenerate_meshes, stacked_sheets};

            fn subject() -> conformance::Subject {
                let subject = conformance::Subject::of::<$accel>(stringify!($module), $config);
                conformance::Subject { $($lowest_id: true,)? ..subject }
            }

            fn passes(outcome: Result<(), String>) {
                if let Err(report) = outcome {
                    panic!("{report}");
                }
            }

            #[test]
            fn answers_are_right() {
                passes(conformance::answers(&subject(), &degenerate_meshes(), 200));
            }

            #[test]
            fn stacks_are_deep_enough() {
                passes(conformance::answers(&subject(), &stacked_sheets(), 10));
            }

            #[test]
            fn counting_changes_nothing() {
                passes(conformance::counting(&subject(), &degenerate_meshes(), 20));
            }

            #[test]
            fn shapes_are_possible() {
                passes(conformance::shapes(&subject(), &degenerate_meshes()));
            }
        }
    };
}
