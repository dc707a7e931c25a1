//! What every structure must pass: functions that return what they found, and a macro that makes tests of them.

use std::sync::Arc;

use super::{Reference, Stratum, Validation, validate};
use crate::accel::{Accel, BuildError, Counts, DynAccel};
use crate::geometry::{Hit, Mesh};

/// A structure under test.
pub struct Subject<'a> {
    /// What failures call it.
    pub name: String,
    /// [`Accel::TRIANGLE_TEST`].
    pub triangle_test: &'a str,
    /// Whether it promises the lowest number among primitives at equal `t`.
    pub lowest_id: bool,
    /// Builds it.
    pub build: Build<'a>,
}

/// Builds a structure.
pub type Build<'a> = Box<dyn Fn(&Arc<Mesh>) -> Result<Box<dyn DynAccel>, BuildError> + 'a>;

/// One mesh and one kind of rays, compared.
pub struct Finding {
    /// Name of the mesh.
    pub mesh: String,
    pub stratum: Stratum,
    pub validation: Validation,
}

/// A mesh by name.
pub type Named = (String, Arc<Mesh>);

const SEED: u64 = 2003;

impl Subject<'static> {
    /// The structure `A` with one configuration.
    pub fn of<A: Accel>(name: &str, config: A::Config) -> Self {
        Self {
            name: name.into(),
            triangle_test: A::TRIANGLE_TEST,
            lowest_id: false,
            build: Box::new(move |mesh| Ok(Box::new(A::build(mesh, &config)?))),
        }
    }

    /// Demands the lowest number among primitives at equal `t`, as the structures of this crate give it.
    pub fn with_lowest_id(self) -> Self {
        Self { lowest_id: true, ..self }
    }
}

impl Subject<'_> {
    fn built(&self, name: &str, mesh: &Arc<Mesh>) -> Result<Box<dyn DynAccel>, String> {
        (self.build)(mesh).map_err(|error| format!("{} does not build over {name:?}: {error}", self.name))
    }
}

/// Compares `count` rays of every stratum on every mesh, and hides nothing.
///
/// # Errors
/// If a mesh does not build.
pub fn findings(subject: &Subject, meshes: &[Named], count: usize) -> Result<Vec<Finding>, String> {
    let mut findings = vec![];
    for (name, mesh) in meshes {
        let accel = subject.built(name, mesh)?;
        let reference = Reference::of_test(subject.triangle_test, mesh).map_err(|error| error.to_string())?;
        for stratum in Stratum::ALL {
            let rays = stratum.rays(mesh, count, SEED);
            let validation = validate(&*accel, &reference, mesh, &rays);
            findings.push(Finding { mesh: name.clone(), stratum, validation });
        }
    }
    Ok(findings)
}

/// The answers are right: no structure error on any mesh and stratum, any hit agrees with closest hit, asking again gives
/// the same, and where it is promised the lowest primitive wins.
///
/// A structure whose triangle test this crate does not have is held to right answers on random rays alone: elsewhere its
/// test may be to blame.
///
/// # Errors
/// One line for each mesh and stratum that fails, with the worst ray.
pub fn answers(subject: &Subject, meshes: &[Named], count: usize) -> Result<(), String> {
    let wrong = |finding: &Finding| {
        let v = &finding.validation;
        let blamed = if finding.stratum == Stratum::Random { v.answer_errors } else { 0 };
        let ids = if subject.lowest_id { v.higher_ids } else { 0 };
        v.structure_errors + v.any_hit_errors + v.unrepeatable + blamed + ids > 0
    };
    let findings = findings(subject, meshes, count)?;
    let lines = findings.iter().filter(|f| wrong(f)).map(|f| f.line(&subject.name));
    outcome(lines.collect())
}

impl Finding {
    /// What failed, and the worst ray in the form in which it can be asked again.
    pub fn line(&self, subject: &str) -> String {
        let v = &self.validation;
        let worst = v.worst.first().map_or("no ray".into(), ToString::to_string);
        format!(
            "{subject} on {:?}, {} rays: of {} rays, {} structure errors, {} answer errors, {} any-hit errors, {} unrepeatable, \
             {} kernel differences, {} ties ({} at a higher number); worst: {worst}",
            self.mesh,
            self.stratum.name(),
            v.rays,
            v.structure_errors,
            v.answer_errors,
            v.any_hit_errors,
            v.unrepeatable,
            v.kernel_differences,
            v.ties,
            v.higher_ids,
        )
    }
}

/// Watching changes nothing: with counts, the hits are the same, at the same primitive where the lowest is promised; what is declared unobserved stays zero.
///
/// # Errors
/// One line for each mesh that fails.
pub fn counting(subject: &Subject, meshes: &[Named], count: usize) -> Result<(), String> {
    let mut lines = vec![];
    for (name, mesh) in meshes {
        let accel = subject.built(name, mesh)?;
        for stratum in Stratum::ALL {
            let rays = stratum.rays(mesh, count, SEED);
            let (mut plain, mut counted) = (vec![None; rays.len()], vec![None; rays.len()]);
            let (mut any, mut any_counted) = (vec![false; rays.len()], vec![false; rays.len()]);
            let (mut counts, mut any_counts) = (Counts::default(), Counts::default());
            accel.closest_hits(&rays, &mut plain);
            accel.closest_hits_counted(&rays, &mut counted, &mut counts);
            accel.any_hits(&rays, &mut any);
            accel.any_hits_counted(&rays, &mut any_counted, &mut any_counts);

            // Which of several primitives at one `t` is free, unless the lowest is promised.
            let number = |h: Hit| if subject.lowest_id { h.prim.index() } else { 0 };
            let answer = |hit: Option<Hit>| hit.map(|h| (h.t, number(h)));
            let differ = plain.iter().zip(&counted).position(|(a, b)| answer(*a) != answer(*b));
            let differ = differ.or_else(|| any.iter().zip(&any_counted).position(|(a, b)| a != b));
            let observed = accel.observed();
            let hit = plain.iter().any(Option::is_some);
            let place = format!("{} on {name:?}, {} rays", subject.name, stratum.name());
            if let Some(i) = differ {
                lines.push(format!("{place}: counting changes the answer of ray \"{}\"", rays[i]));
            }
            for (which, c) in [("closest", counts), ("any", any_counts)] {
                if !observed.steps && c.steps() > 0 || !observed.tests && c.tests > 0 {
                    lines.push(format!("{place}: {which} hit counts what it declares unobserved: {c:?}"));
                }
                if hit && (observed.steps && c.steps() == 0 || observed.tests && c.tests == 0) {
                    lines.push(format!("{place}: {which} hit finds something, but counts no step or no test: {c:?}"));
                }
                if c.empty_leaves > c.leaves {
                    lines.push(format!("{place}: {which} hit counts more empty leaves than leaves: {c:?}"));
                }
            }
        }
    }
    outcome(lines)
}

/// The numbers about the structure are possible: every triangle with an area is referenced, something takes memory.
///
/// # Errors
/// One line for each mesh that fails.
pub fn shapes(subject: &Subject, meshes: &[Named]) -> Result<(), String> {
    let mut lines = vec![];
    for (name, mesh) in meshes {
        let accel = subject.built(name, mesh)?;
        let (shape, footprint, solid) = (accel.shape(), accel.footprint(), mesh.solid().count());
        let wrong = [
            (shape.references < solid, "fewer references than triangles that have an area"),
            (solid > 0 && shape.leaves == 0, "no leaf"),
            (shape.empty > shape.leaves, "more empty leaves than leaves"),
            (shape.largest_leaf > shape.references, "a leaf with more than all references"),
            (
                shape.largest_leaf * (shape.leaves - shape.empty.min(shape.leaves)) < shape.references,
                "leaves too small for the references",
            ),
            (shape.depth > shape.inner, "deeper than there are inner nodes"),
            (shape.sah_cost.is_some_and(|cost| cost.is_nan() || cost < 0.0), "a SAH cost that is no cost"),
            (solid > 0 && footprint.total() == 0, "no bytes"),
        ];
        for (_, what) in wrong.iter().filter(|(wrong, _)| *wrong) {
            lines.push(format!("{} on {name:?}: {what}: {shape:?}, {footprint:?}", subject.name));
        }
    }
    outcome(lines)
}

/// Few lines in full, many cut short.
fn outcome(lines: Vec<String>) -> Result<(), String> {
    const SHOWN: usize = 10;
    if lines.is_empty() {
        return Ok(());
    }
    let more = lines.len().saturating_sub(SHOWN);
    let shown = lines[..lines.len().min(SHOWN)].join("\n");
    Err(if more > 0 { format!("{shown}\nand {more} more") } else { shown })
}

/// Makes a module of tests that hold a structure to the contract of [`Accel`]:
/// `sahara::conformance!(my_tree, MyTree, MyConfig::default());`
///
/// With `lowest_id` as a fourth argument, the lowest primitive number must win among equal `t`.
#[macro_export]
macro_rules! conformance {
    ($module:ident, $accel:ty, $config:expr) => {
        $crate::conformance!(@tests $module, $crate::validate::conformance::Subject::of::<$accel>(stringify!($module), $config));
    };
    ($module:ident, $accel:ty, $config:expr, lowest_id) => {
        $crate::conformance!(
            @tests $module,
            $crate::validate::conformance::Subject::of::<$accel>(stringify!($module), $config).with_lowest_id()
        );
    };
    (@tests $module:ident, $subject:expr) => {
        mod $module {
            use super::*;
            use $crate::validate::{conformance, degenerate_meshes};

            fn passes(outcome: Result<(), String>) {
                if let Err(report) = outcome {
                    panic!("{report}");
                }
            }

            #[test]
            fn answers_are_right() {
                passes(conformance::answers(&$subject, &degenerate_meshes(), 200));
            }

            #[test]
            fn counting_changes_nothing() {
                passes(conformance::counting(&$subject, &degenerate_meshes(), 20));
            }

            #[test]
            fn shapes_are_possible() {
                passes(conformance::shapes(&$subject, &degenerate_meshes()));
            }
        }
    };
}
