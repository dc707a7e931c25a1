//! Measures structures with planted faults.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};

use super::*;
use crate::accel::{Accel, BuildError, Footprint, Observed, Observer, TreeShape};
use crate::brute_force::BruteForce;
use crate::geometry::{Hit, Mesh, Ray};
use crate::measure::SystemClock;
use crate::registry::Registry;
use crate::request::{SceneRequest, ViewArgs, WorkloadRequest, scene, with_twin};
use crate::scene::WorkloadKind;
use crate::study::case::tests::example;
use crate::study::dataset::tests::dataset;
use crate::study::measurement::{Measurement, measurements};
use crate::study::{Dataset, JoinedEpochs, Measured, Status, join};
use crate::triangle::{MollerTrumbore, TriangleTest};

pub struct Flawed {
    inner: BruteForce<MollerTrumbore>,
    flaw: Flaw,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Flaw {
    #[default]
    None,
    /// Loses the hits of about half of the rays, always of the same rays.
    Lossy,
    /// Loses all hits after `HAS_TURNED` is set.
    Turning,
    Panicking,
    /// The builder panics on every mesh that has triangles.
    Unbuildable,
    /// The builder panics on an empty mesh.
    Rootless,
}

static HAS_TURNED: AtomicBool = AtomicBool::new(false);

#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct FlawedConfig {
    pub flaw: Flaw,
}

impl Flawed {
    fn loses(&self, ray: &Ray) -> bool {
        match self.flaw {
            Flaw::None | Flaw::Unbuildable | Flaw::Rootless => false,
            Flaw::Turning => HAS_TURNED.load(Ordering::Relaxed),
            Flaw::Panicking => panic!("a traversal panics"),
            Flaw::Lossy => ray.direction.x.to_bits() & 1 == 0,
        }
    }
}

impl Accel for Flawed {
    type Config = FlawedConfig;

    const TRIANGLE_TEST: &'static str = MollerTrumbore::NAME;
    const OBSERVED: Observed = Observed::TESTS;

    fn build(mesh: &Arc<Mesh>, config: &FlawedConfig) -> Result<Self, BuildError> {
        let panics = match config.flaw {
            Flaw::Unbuildable => !mesh.is_empty(),
            Flaw::Rootless => mesh.is_empty(),
            _ => false,
        };
        assert!(!panics, "a builder panics");
        let inner = Accel::build(mesh, &Default::default())?;
        Ok(Self { inner, flaw: config.flaw })
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

pub fn registry() -> Registry {
    Registry::builtin().with::<Flawed>("flawed", FlawedConfig::default())
}

fn case(word: &str, specs: &[&str], kinds: &[WorkloadKind]) -> Case {
    let registry = registry();
    let case = example("", 0, specs);
    let mut settings = case.settings;
    (settings.runs, settings.budget_ns, settings.slowest) = (2, Some(60_000_000_000), Some(4.0));
    settings.check = Check::BruteForce { tests: 1 << 20, limit_ns: None };
    let scene = scene(&registry, word).unwrap();
    Case {
        scene: SceneRequest::new(word, &ViewArgs::default(), &scene),
        structures: case.structures.iter().map(|own| (&registry.choose(&own.spec).unwrap()).into()).collect(),
        workloads: WorkloadRequest::Scene { kinds: kinds.into(), rays: Some(1024) },
        settings,
        ..case
    }
}

fn measured(case: &Case, progress: &mut dyn FnMut(Stage)) -> Result<Measured, StudyError> {
    let prepared = Prepared::new(case, &registry(), None).unwrap();
    let epoch = measure(case, &prepared, &SystemClock::start(), &BuildWatch::default(), progress)?;
    Ok(Measured { case: case.clone(), epoch })
}

fn run(specs: &[&str]) -> Result<Dataset, StudyError> {
    // The scene has no mirrors, so the results lack the mirror workload.
    let case = case("cube", specs, &[WorkloadKind::Primary, WorkloadKind::Mirror, WorkloadKind::Shadow]);
    let case = Case { structures: with_twin(case.structures.clone()), ..case };
    let epochs = [0, 1].map(|epoch| measured(&Case { epoch, ..case.clone() }, &mut |_| ()));
    let mut joined = join(epochs.into_iter().collect::<Result<_, _>>()?);
    joined.failures.pop().map_or(Ok(()), Err)?;
    Ok(dataset(joined.measured))
}

#[test]
fn a_right_structure_has_a_time_and_the_hits_of_all_others() {
    let all = measurements(&run(&["brute-force", "median-kd", "flawed"]).unwrap());
    let pairs: Vec<(&str, &str)> = all.iter().map(|r| (&r.label[..], &r.workload[..])).collect();
    let structures = ["brute-force", "median-kd", "flawed"];
    assert_eq!(pairs, structures.map(|s| [(s, "primary"), (s, "shadow")]).concat());
    for own in &all {
        assert_eq!((own.wrong_hits, own.samples_ns.len(), own.epochs), (0, 4, 2));
        assert!(own.trace_ns > Some(0.0) && own.mrays_per_s > Some(0.0));
        assert!(own.checked_rays > 0 && own.rays <= own.workload_rays);
    }
    // A single cube casts no shadow on itself.
    for (workload, is_hit) in [("primary", true), ("shadow", false)] {
        let hits: Vec<usize> = all.iter().filter(|r| r.workload == workload).map(|r| r.counts.hits).collect();
        assert!((hits[0] > 0) == is_hit && hits.iter().all(|&n| n == hits[0]), "{workload} {hits:?}");
    }
    assert_eq!(all[0].counts.tests_per_ray(), Some(12.0));
    assert_eq!(
        (all[4].counts.tests_per_ray(), all[4].counts.steps_per_ray()),
        (Some(12.0), None),
        "what is not observed is unknown"
    );
    // `with_twin` treats `brute-force` and `median-kd` as slow, so `flawed` has the twin.
    let twins: Vec<bool> = all.iter().map(|own| own.twin_samples_ns.is_some()).collect();
    assert_eq!(twins, [false, false, false, false, true, true]);
}

#[test]
fn a_wrong_structure_has_errors_and_no_time() {
    let all = measurements(&run(&["brute-force", "flawed:flaw=lossy"]).unwrap());
    let (wrong, right): (Vec<&Measurement>, Vec<&Measurement>) =
        all.iter().partition(|r| r.label == "flawed:flaw=lossy");
    // No shadow ray hits the cube, so all shadow results are correct.
    assert_eq!(wrong.iter().map(|r| r.is_disqualified()).collect::<Vec<_>>(), [true, false]);
    // A structure with wrong hits and no known defect has no time on any workload.
    assert!(wrong.iter().all(|r| r.trace_ns.is_none() && r.mrays_per_s.is_none() && r.samples_ns.is_empty()));
    assert!(right.iter().all(|r| r.label == "brute-force" && r.trace_ns.is_some()));
}

#[test]
fn a_structure_with_other_answers_in_the_next_round_is_refused_and_the_others_go_on() {
    let case = case("cube", &["sah-kd", "flawed:flaw=turning"], &[WorkloadKind::Primary]);
    // The hits of `turning` change after the first of two rounds.
    let Measured { epoch, .. } = measured(&case, &mut |stage| {
        HAS_TURNED.fetch_or(stage == Stage::Trace(2, 4), Ordering::Relaxed);
    })
    .unwrap();
    let [kd, turning] = &epoch.structures[..] else { panic!("{epoch:?}") };
    assert_eq!((kd.rays[0].ns.len(), &kd.refused), (2, &None));
    assert_eq!(turning.refused, Some(SampleFailure::Unsteady.to_string()));
    assert!(turning.rays.is_empty(), "what is refused keeps no rays");
    assert_eq!(Status::of(&epoch.failures()), Status::Wrong);
}

#[test]
fn a_failed_build_does_not_change_other_measurements() {
    // Brute force would get more rays if the skipped structure were ignored.
    let case = case("torus", &["sah-kd", "brute-force", "flawed"], &[WorkloadKind::Primary]);
    let epochs = [0, 1].map(|epoch| {
        let mut case = Case { epoch, ..case.clone() };
        case.structures[2].skipped = (epoch == 1).then(|| "its build takes too long".into());
        measured(&case, &mut |_| ()).unwrap()
    });
    let JoinedEpochs { measured, failures, .. } = join(epochs.into());
    assert!(failures.is_empty() && measured.len() == 2, "{failures:?}");
    for Measured { epoch, .. } in &measured {
        let [kd, brute, skipped] = &epoch.structures[..] else { panic!("{epoch:?}") };
        assert_eq!([kd, brute, skipped].map(|structure| structure.refused.is_some()), [false, false, true]);
        assert!(brute.rays[0].rays < kd.rays[0].rays, "{brute:?} {kd:?}");
    }
}

#[test]
fn what_panics_cannot_be_built_or_is_skipped_is_refused_and_the_others_go_on() {
    let specs = ["flawed:flaw=panicking", "brute-force", "flawed:flaw=unbuildable", "sah-kd"];
    let mut case = case("cube", &specs, &[WorkloadKind::Primary]);
    case.structures[3].skipped = Some("its build takes too long".into());
    let Measured { epoch, .. } = measured(&case, &mut |_| ()).unwrap();
    let refused: Vec<bool> = epoch.structures.iter().map(|own| own.refused.is_some()).collect();
    assert_eq!(refused, [true, false, true, true]);
    assert_eq!(epoch.structures[3].refused.as_deref(), Some("its build takes too long"));
    assert!(!epoch.structures[1].rays[0].ns.is_empty());
}

#[test]
fn the_oracle_gives_error_rates_beside_times_and_whole_counts_are_of_all_rays() {
    let mut case = case("cube", &["flawed:flaw=lossy", "sah-kd"], &[WorkloadKind::Primary]);
    case.settings.check = Check::Oracle;
    case.settings.whole_counts = vec!["sah-kd".into()];
    let Measured { epoch, .. } = measured(&case, &mut |_| ()).unwrap();
    let [lossy, kd] = [0, 1].map(|place| &epoch.structures[place].rays[0]);
    let errors = |rays: &Rays| rays.errors.clone().unwrap().missed;
    assert!(errors(lossy) > 0 && !lossy.ns.is_empty(), "wrong answers are timed beside their rate");
    assert_eq!((errors(kd), kd.slowest_ns.is_some(), kd.checked.clone()), (0, true, None));
    let counts = kd.counts.unwrap();
    assert!(counts.whole_tests > counts.tests && kd.all > counts.rays, "{counts:?}");
    assert_eq!(lossy.counts.unwrap().whole_tests, None);
}

#[test]
fn a_check_is_bounded_by_a_clock_where_it_is_asked_to_be() {
    let case = case("torus", &["sah-kd"], &[WorkloadKind::Primary]);
    let (prepared, clock) = (Prepared::new(&case, &registry(), None).unwrap(), SystemClock::start());
    let Prepared { scene, choices, threads, .. } = &prepared;
    let built = Built::new(&choices[0], scene, threads, &clock).unwrap();
    let workloads = case.workloads.workloads(scene, 1, built.accel.as_ref(), &mut |_| ()).unwrap();
    let checked = |limit_ns| {
        let checks = Checks { scene, workloads: &workloads, tests: 1 << 24, limit_ns, clock: &clock };
        checks.all([&built], &mut |_| ()).unwrap()[0].as_ref().unwrap()[0].rays
    };
    let (whole, bounded) = (checked(None), checked(Some(1)));
    assert!(bounded > 0 && bounded < whole / 8, "{bounded} {whole}");
}
