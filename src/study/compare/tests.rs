use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use serde::{Deserialize, Serialize};

use super::*;
use crate::accel::{Accel, BuildError, Footprint, Observed, Observer, TreeShape};
use crate::brute_force::BruteForce;
use crate::geometry::{Hit, Mesh, Ray};
use crate::measure::{Provenance, SystemClock};
use crate::registry::Registry;
use crate::scene::{Builtin, WorkloadKind};
use crate::study::args::with_twin;
use crate::study::bench::failed::Failed;
use crate::study::epoch::tests::settings;
use crate::study::epoch::{Asked, Epoch, Joined, Settings, join, measure, troubles};
use crate::study::{Stage, Status, Study, StudyError};
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
    /// Loses all hits once [`HAS_TURNED`] is set.
    Turning,
    /// Panics on every ray.
    Panicking,
    /// Panics over every mesh with triangles.
    Unbuildable,
    /// The same, while [`IS_AWAY`] is set.
    Away,
}

static HAS_TURNED: AtomicBool = AtomicBool::new(false);
static IS_AWAY: AtomicBool = AtomicBool::new(false);

#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct FlawedConfig {
    flaw: Flaw,
}

impl Flawed {
    fn loses(&self, ray: &Ray) -> bool {
        match self.flaw {
            Flaw::None | Flaw::Unbuildable | Flaw::Away => false,
            Flaw::Turning => HAS_TURNED.load(Ordering::Relaxed),
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
        let panics = match config.flaw {
            Flaw::Unbuildable => true,
            Flaw::Away => IS_AWAY.load(Ordering::Relaxed),
            _ => false,
        };
        assert!(!panics || mesh.is_empty(), "a builder panics");
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

/// The structures of this crate, and `flawed`.
pub fn registry() -> Registry {
    Registry::builtin().with::<Flawed>("flawed", FlawedConfig::default())
}

fn compared(specs: &[&str]) -> Result<Compared, StudyError> {
    let registry = registry();
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
        assert_eq!(record.structure_errors, 0);
        assert!(
            record.trace_ns > Some(0.0) && record.mrays_per_s > Some(0.0) && record.runs == 4 && record.epochs == 2
        );
        assert!(record.checked_rays > 0 && record.rays <= record.workload_rays);
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
    let wrong: Vec<&Record> = records.iter().filter(|r| r.structure_errors > 0).collect();
    assert!(!wrong.is_empty() && wrong.iter().all(|r| r.label == "flawed:flaw=lossy"));
    for record in wrong {
        assert!(record.is_disqualified());
        assert_eq!((record.trace_ns, record.mrays_per_s, record.runs), (None, None, 0));
    }
    assert!(records[0].trace_ns.is_some() && !records[0].is_disqualified());
}

#[test]
fn a_structure_that_changes_its_mind_is_no_measurement() {
    match compared(&["flawed:flaw=fickle"]) {
        // Answers of two epochs may differ, or those of two rounds, or the check finds it first.
        Err(error) => assert!(error.is_wrong_answer(), "{error}"),
        Ok(Compared { records, refused, .. }) => {
            assert!(records.first().is_none_or(Record::is_disqualified), "{records:?}");
            assert!(!records.is_empty() || refused.iter().any(|refused| refused.wrong), "{refused:?}");
        }
    }
}

/// Settings for some primary rays, which are not checked for long.
fn of_primary(registry: &Registry, specs: &[&str]) -> Settings {
    Settings {
        asked: Asked::Kinds(vec![WorkloadKind::Primary], 1024),
        budget_ns: 60_000_000_000,
        check_tests: 1 << 20,
        ..settings(registry, specs)
    }
}

#[test]
fn a_structure_with_other_answers_in_the_next_round_is_refused_and_the_others_go_on() {
    let settings = of_primary(&registry(), &["sah-kd", "flawed:flaw=turning"]);
    let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
    // It turns after the first of two rounds.
    let epoch = measure(&scene, &settings, 0, &SystemClock::start(), &mut |stage| {
        HAS_TURNED.fetch_or(stage == Stage::Trace(2, 4), Ordering::Relaxed);
    });
    let epoch = epoch.unwrap();
    let [kd, turning] = &epoch.structures[..] else { panic!("{epoch:?}") };
    assert_eq!((kd.rays[0].ns.len(), &kd.refused), (2, &None));
    assert_eq!(turning.refused, Some(Failed::Unsteady.to_string()));
    assert!(turning.rays.is_empty(), "what takes no part keeps no rays");
    assert_eq!(Status::of(&troubles([&epoch])), Status::Wrong);
}

#[test]
fn what_cannot_be_built_in_one_epoch_costs_nobody_else_a_measurement() {
    // Brute force is slow beside two others, and hardly slow beside one.
    let settings = of_primary(&registry(), &["sah-kd", "brute-force", "flawed:flaw=away"]);
    let settings = Settings { slowest: 4.0, ..settings };
    let scene = Builtin::find("torus").unwrap().scene(None).unwrap();
    let epochs = [0, 1].map(|epoch| {
        IS_AWAY.store(epoch == 1, Ordering::Relaxed);
        measure(&scene, &settings, epoch, &SystemClock::start(), &mut |_| ()).unwrap()
    });
    let Joined { cases, failures, .. } = join(epochs.into(), CompareStudy::epoch, CompareStudy::WHOLE);
    assert!(failures.is_empty(), "{failures:?}");
    assert_eq!(cases.len(), 2);
    for epoch in &cases {
        let [kd, brute, away] = &epoch.structures[..] else { panic!("{epoch:?}") };
        assert_eq!([kd, brute, away].map(|structure| structure.refused.is_some()), [false, false, true]);
        assert!(brute.rays[0].rays < kd.rays[0].rays, "{brute:?} {kd:?}");
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
