use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use serde::{Deserialize, Serialize};

use super::*;
use crate::accel::{Accel, BuildError, Footprint, Observed, Observer, TreeShape};
use crate::brute_force::BruteForce;
use crate::geometry::{Hit, Mesh, Ray};
use crate::measure::{Provenance, SystemClock};
use crate::registry::Registry;
use crate::scene::{Builtin, WorkloadKind};
use crate::study::args::with_twin;
use crate::study::epoch::tests::settings;
use crate::study::epoch::{Asked, Epoch, Settings, join, measure};
use crate::study::{Study, StudyError};
use crate::triangle::{MollerTrumbore, TriangleTest};

struct Flawed {
    inner: BruteForce<MollerTrumbore>,
    flaw: Flaw,
    asked: AtomicUsize,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Flaw {
    #[default]
    None,
    /// Loses the hits of about every second ray, always the same.
    Lossy,
    /// Loses the hit of every 13th ray that it is asked for.
    Fickle,
    /// Panics on every ray.
    Panicking,
    /// Panics over every mesh with triangles.
    Unbuildable,
}

#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct FlawedConfig {
    flaw: Flaw,
}

impl Flawed {
    fn loses(&self, ray: &Ray) -> bool {
        match self.flaw {
            Flaw::None | Flaw::Unbuildable => false,
            Flaw::Panicking => panic!("a traversal panics"),
            Flaw::Lossy => ray.direction.x.to_bits() & 1 == 0,
            Flaw::Fickle => self.asked.fetch_add(1, Ordering::Relaxed).is_multiple_of(13),
        }
    }
}

impl Accel for Flawed {
    type Config = FlawedConfig;

    const TRIANGLE_TEST: &'static str = MollerTrumbore::NAME;
    const OBSERVED: Observed = Observed::NONE;

    fn build(mesh: &Arc<Mesh>, config: &FlawedConfig) -> Result<Self, BuildError> {
        assert!(config.flaw != Flaw::Unbuildable || mesh.is_empty(), "a builder panics");
        let inner = Accel::build(mesh, &Default::default())?;
        Ok(Self { inner, flaw: config.flaw, asked: AtomicUsize::new(0) })
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        if self.loses(ray) { None } else { self.inner.closest_hit(ray, observer) }
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        !self.loses(ray) && self.inner.any_hit(ray, observer)
    }

    fn footprint(&self) -> Footprint {
        Accel::footprint(&self.inner)
    }

    fn shape(&self) -> TreeShape {
        Accel::shape(&self.inner)
    }
}

/// The records of the structures on the primary and shadow rays of the cube.
fn run(specs: &[&str]) -> Result<Vec<Record>, StudyError> {
    compared(specs).map(|compared| compared.records)
}

fn compared(specs: &[&str]) -> Result<Compared, StudyError> {
    let registry = Registry::builtin().with::<Flawed>("flawed", FlawedConfig::default());
    let chosen = specs.iter().map(|spec| registry.choose(spec).unwrap()).collect();
    let kinds = vec![WorkloadKind::Primary, WorkloadKind::Mirror, WorkloadKind::Shadow];
    let settings = Settings {
        structures: with_twin(chosen),
        asked: Asked::Kinds(kinds, 1024),
        budget_ns: 60_000_000_000,
        slowest: 4.0,
        detailed: true,
        ..settings(&registry, &[])
    };
    let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
    let clock = SystemClock::start();
    let mut epochs: Vec<Epoch> = vec![];
    for number in 0..2 {
        epochs.push(measure(&scene, &settings, number, &clock, &mut |_| {})?);
    }
    let mut joined = join(epochs, CompareStudy::epoch, CompareStudy::WHOLE);
    joined.failures.pop().map_or(Ok(()), Err)?;
    Ok(super::compared(&joined.cases, &Provenance::of(&settings.threads)))
}

#[test]
fn a_right_structure_has_a_time_and_the_hits_of_all_others() {
    let records = run(&["brute-force", "median-kd", "flawed"]).unwrap();
    // The cube has no mirrors, and so no mirror rays.
    let cases: Vec<(&str, &str)> = records.iter().map(|r| (&r.label[..], &r.workload[..])).collect();
    let structures = ["brute-force", "median-kd", "flawed"];
    assert_eq!(cases, structures.map(|s| [(s, "primary"), (s, "shadow")]).concat());
    for record in &records {
        assert_eq!(record.structure_errors, Some(0));
        assert!(
            record.trace_ns > Some(0.0) && record.mrays_per_s > Some(0.0) && record.runs == 4 && record.epochs == 2
        );
        assert!(record.checked_rays > Some(0) && record.rays <= record.workload_rays);
    }
    // 1024 rays take no time worth cutting.
    let of = |workload: &str| records.iter().filter(|r| r.workload == workload).map(|r| r.hits).collect::<Vec<_>>();
    for workload in ["primary", "shadow"] {
        let hits = of(workload);
        assert!(hits.iter().all(|&n| n == hits[0]), "{workload} {hits:?}");
    }
    assert!(of("primary")[0] > 0);
    assert_eq!(records[0].tests_per_ray, Some(12.0));
    assert_eq!(records[4].tests_per_ray, None, "what is not observed is unknown");
}

#[test]
fn a_wrong_structure_has_errors_and_no_time() {
    let records = run(&["brute-force", "flawed:flaw=lossy"]).unwrap();
    let wrong: Vec<&Record> = records.iter().filter(|r| r.structure_errors > Some(0)).collect();
    assert!(!wrong.is_empty() && wrong.iter().all(|r| r.label == "flawed:flaw=lossy"));
    for record in wrong {
        assert!(record.is_disqualified());
        assert_eq!((record.trace_ns, record.mrays_per_s, record.runs), (None, None, 0));
    }
    assert!(records[0].trace_ns.is_some() && !records[0].is_disqualified());
}

#[test]
fn a_structure_that_changes_its_mind_is_no_measurement() {
    match run(&["flawed:flaw=fickle"]) {
        Err(StudyError::Unsteady { structure, .. }) => assert_eq!(structure, "flawed:flaw=fickle"),
        // Answers of two epochs may differ, or the check finds it first.
        Err(StudyError::Apart { structure, .. }) => assert_eq!(structure, "flawed:flaw=fickle"),
        Ok(records) => assert!(records[0].is_disqualified(), "{records:?}"),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn a_structure_that_panics_is_refused_and_the_others_go_on() {
    let specs = ["flawed:flaw=panicking", "brute-force", "flawed:flaw=unbuildable"];
    let compared = compared(&specs).unwrap();
    let mut refused: Vec<&str> = compared.refused.iter().map(|refused| &refused.label[..]).collect();
    refused.sort_unstable();
    assert_eq!(refused, [specs[0], specs[2]]);
    assert!(compared.records.len() == 2 && compared.records.iter().all(|r| r.label == "brute-force"));
    let table = scene_table(&compared.records, &Reference::of(&compared.records, None), &compared.refused);
    assert_eq!(table.rows.len(), 3);
    assert!(table.notes.is_empty(), "{table:?}");
    // A reason is said once, whatever it is the reason for.
    let why = |r: &Refused| Refused { reason: "why".into(), ..r.clone() };
    let twice: Vec<Refused> = [&compared.refused[..], &compared.refused[..]].concat().iter().map(why).collect();
    let [one, other] = [&twice[0].label, &twice[1].label];
    assert_eq!(refusals(&twice), [format!("Refused: {one} and {other}: why.")]);
}
