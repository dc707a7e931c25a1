use super::*;
use crate::measure::SystemClock;
use crate::registry::Registry;
use crate::scene::Builtin;
use crate::study::Study;
use crate::study::compare::tests::registry;
use crate::triangle::{Exact, MollerTrumbore, TriangleTest};

fn records(specs: &[&str], kinds: &[RayKind], rays: usize) -> Vec<AccuracyRecord> {
    judged(&Registry::builtin(), specs, kinds, rays).0
}

/// The records of the torus, and what is refused.
fn judged(registry: &Registry, specs: &[&str], kinds: &[RayKind], rays: usize) -> (Vec<AccuracyRecord>, Vec<Refused>) {
    let settings = AccuracySettings {
        choices: specs.iter().map(|spec| registry.choose(spec).unwrap()).collect(),
        kinds: kinds.into(),
        replayed: None,
        rays,
        runs: 2,
        budget_ns: 2_000_000_000,
        seed: 1,
    };
    let scene = Builtin::find("torus").unwrap().scene(None).unwrap();
    accuracy_scene(&scene, &settings, &SystemClock::start(), &mut |_| ()).unwrap()
}

#[test]
fn exact_is_right_and_single_precision_is_not() {
    let records =
        records(&["sah-kd:test=exact", "sah-kd:test=moller-trumbore"], &[RayKind::Edge, RayKind::Grazing], 400);
    assert_eq!(records.len(), 4);
    for record in &records {
        assert!(record.hits > 50 && record.ns_per_ray > 0.0, "{record:?}");
        assert_eq!((record.judged, record.sampled), (400, false));
        match record.triangle_test.as_str() {
            Exact::NAME => {
                assert_eq!((record.errors(), record.wrong_primitive), (0, 0), "{record:?}");
                assert!(record.ulps.unwrap().max <= 0.5);
                assert_eq!(record.error, 0.0);
                // 400 rays without an error: 1 - 0.05^(1 / 400).
                assert!((record.error_bound - 0.007461).abs() < 1e-6, "{}", record.error_bound);
            }
            MollerTrumbore::NAME => {
                assert!(record.errors() > 0, "{record:?}");
                assert!(record.error < record.error_bound, "{record:?}");
            }
            other => panic!("{other}"),
        }
    }
    // Whatever the times are: the exact one cannot be dominated, since nothing else is as right.
    assert!(records.iter().step_by(2).all(|record| record.dominated_by.is_none()));
}

#[test]
fn costs_and_no_clock_decide_how_many_rays_are_judged() {
    let scene = Builtin::find("torus").unwrap().scene(None).unwrap();
    let accel = Registry::builtin().choose("sah-kd").unwrap().build(&scene.mesh).unwrap();
    let batch = Batch::new(RayKind::Uniform.rays(&scene, 400, 1), &Oracle::new(&scene.mesh));
    // A millisecond, of rays that take nothing to speak of, five microseconds each, or for ever.
    let judged = |ps| batch.judge(accel.as_ref(), ps, 1_000_000).rays;
    assert_eq!([1, 5_000_000, u64::MAX].map(judged), [400, 200, 64]);
}

#[test]
fn a_structure_that_changes_its_mind_is_refused_and_the_others_have_their_records() {
    let specs = ["sah-kd", "flawed:flaw=fickle"];
    let (records, refused) = judged(&registry(), &specs, &[RayKind::Uniform, RayKind::Vertex], 400);
    let named: Vec<(&str, &str)> = records.iter().map(|r| (&r.structure[..], &r.rays[..])).collect();
    assert_eq!(named, [("sah-kd", "uniform"), ("sah-kd", "vertex")]);
    let [fickle] = &refused[..] else { panic!("{refused:?}") };
    assert!(fickle.label == specs[1] && fickle.wrong && fickle.reason == Failed::Unsteady.to_string(), "{fickle:?}");
}

#[test]
fn tables_and_pictures_name_every_case() {
    let specs = ["sah-kd:test=exact", "brute-force", "sah-kd:mailbox=true,test=exact"];
    let records = records(&specs, &[RayKind::Uniform], 100);
    let tables = AccuracyStudy::tables(&records);
    assert_eq!((tables.len(), tables[0].rows.len(), tables[0].notes.len()), (1, 3, 0));
    assert!(tables[0].rows.iter().all(|row| row.len() == tables[0].columns.len()));
    let figure = figure(&records);
    assert_eq!(figure.groups(), ["sah-kd", "brute-force", "sah-kd:mailbox=true"]);
    assert_eq!(figure.points.len(), 3);
    assert!(figure.points[0].is_bound);
}

#[test]
fn kinds_of_rays_are_the_same_again() {
    let scene = Builtin::find("cube").unwrap().scene(None).unwrap();
    for kind in RayKind::ALL {
        let rays = kind.rays(&scene, 31, 5);
        assert_eq!(rays.len(), 31);
        assert_eq!(rays, kind.rays(&scene, 31, 5));
    }
}
