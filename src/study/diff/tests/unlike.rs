//! Tests of runs that cannot be compared.

use super::*;

type Edit = dyn Fn(&mut Side);

fn edited(slow: f64, sah: f64, edit: &dyn Fn(&mut Side)) -> Side {
    let mut side = side(run(slow, sah));
    edit(&mut side);
    side
}

#[test]
fn runs_that_differ_in_more_than_their_code_are_unlike() {
    let old = side(run(1.0, 1.0));
    let with = |edit: &Edit| unlike(&old, &edited(1.0, 1.0, edit), true).map_err(|error| error.to_string());
    assert_eq!(with(&|_| {}), Ok(()));
    assert_eq!(with(&|side| side.provenance.commit = "other".into()), Ok(()));
    assert_eq!(with(&|side| side.provenance.threads = 2), Ok(()), "the heading names it");
    let refusals: [(&str, &Edit); 11] = [
        ("the reference differs (obvhs-bvh2 and obvhs-cwbvh in the old run, missing in the new)", &|side| {
            side.all.iter_mut().filter(|own| has_reference_role(own)).for_each(|own| own.trace_ns = None);
        }),
        ("the key threshold of obvhs-bvh2", &|side| {
            side.all[2].config = serde_json::json!({ "leaf": 8, "threshold": 0.8 });
        }),
        ("the processor", &|side| side.provenance.cpu = "Other".into()),
        ("the SIMD instruction set", &|side| side.provenance.simd = "portable".into()),
        ("the profile", &|side| side.provenance.profile = "other".into()),
        ("target features", &|side| side.provenance.target_features = "sse2".into()),
        ("the version of obvhs", &|side| side.provenance.obvhs = "0.5.0".into()),
        ("the hash of the scene Cube", &|side| side.all[0].scene_hash = "ff".into()),
        ("the hash of the primary rays of Cube", &|side| side.all[0].workload_hash = "ff".into()),
        ("the number of timed rays of sah-kd", &|side| side.all[1].rays = 250),
        ("the first cell differs", &|side| side.all.iter_mut().for_each(|own| own.scene = "Sphere".into())),
    ];
    for (part, edit) in refusals {
        let refused = with(edit).unwrap_err();
        assert!(refused.contains(part), "{part:?} is not in {refused:?}");
    }
    // Two builds of a runner are comparable. Without a gate, runs with different numbers of timed rays are comparable.
    let build = |side: &mut Side| side.all[0].config = serde_json::json!({ "leaf": 8, "threshold": 0.7, "build": "x" });
    assert_eq!(with(&build), Ok(()));
    assert_eq!(unlike(&old, &edited(1.0, 1.0, &|side| side.all[1].rays = 250), false), Ok(()));
}

#[test]
fn a_plan_that_a_gate_could_not_compare_is_refused_before_it_is_measured() {
    use crate::study::case::tests::example;
    use crate::study::dataset::Measured;
    use crate::study::epoch::tests::example as epoch;
    let case = example("Cube", 0, &["sah-kd"]);
    let epoch = epoch("Cube", 12, 0, &[("sah-kd", 1, &[1])]);
    let here = Provenance::capture(1);
    let old = Dataset::new(here.clone(), vec![Measured { case: case.clone(), epoch }]);
    let refused = |edit: &dyn Fn(&mut crate::study::Case, &mut Provenance)| {
        let (mut case, mut here) = (case.clone(), here.clone());
        edit(&mut case, &mut here);
        unlike_plan(&old, &[case], &here).map_err(|error| error.to_string())
    };
    assert_eq!(refused(&|_, _| {}), Ok(()));
    assert_eq!(refused(&|case, _| case.structures.clear()), Ok(()), "structures may differ");
    type Edit = dyn Fn(&mut crate::study::Case, &mut Provenance);
    let edits: [(&str, &Edit); 6] = [
        ("the processor", &|_, here| here.cpu = "Other".into()),
        ("the hash of the scene Cube", &|case, _| case.scene.hash = "0".into()),
        ("the scene Sphere differs (missing in the old run", &|case, _| case.scene.name = "Sphere".into()),
        ("the seed differs (1 in the old run, 2 in the new)", &|case, _| case.settings.seed = 2),
        ("the ray selection of Cube", &|case, _| case.workloads = crate::request::WorkloadRequest::Picture),
        ("the budget differs", &|case, _| case.settings.budget_ns = Some(7)),
    ];
    for (part, edit) in edits {
        let error = refused(edit).unwrap_err();
        assert!(error.contains(part), "{part:?} is not in {error:?}");
    }
}

#[test]
fn on_two_machines_ratios_to_obvhs_are_compared_and_nothing_else() {
    let elsewhere = |edit: &dyn Fn(&mut Side)| {
        edited(3.0, 1.1, &|side| {
            let p = &mut side.provenance;
            (p.cpu, p.simd) = ("Other".into(), "avx2".into());
            (p.target, p.target_features) = ("aarch64".into(), "neon".into());
            edit(side);
        })
    };
    let (old, new) = (side(run(1.0, 1.0)), elsewhere(&|_| {}));
    assert_eq!(unlike(&old, &new, false), Ok(()));
    assert!(unlike(&old, &new, true).is_err(), "a gate wants one machine");
    let comparison = Comparison::new(&old, &new, None, 1);
    assert_time(&comparison, "sah-kd", 1.1);
    let has_note = |comparison: &Comparison, part: &str| cautions(comparison).iter().any(|n| n.contains(part));
    assert!(has_note(&comparison, "Two machines, ") && has_note(&comparison, "Other (avx2)"));
    assert_eq!(compare(&old.all, &run(3.0, 1.1), None, 1).machines, None);
    let lanes = edited(1.0, 1.1, &|side| side.provenance.simd = "others".into());
    assert!(has_note(&Comparison::new(&old, &lanes, None, 1), "Two instruction sets, "));

    let refused = |edit: &Edit| unlike(&old, &elsewhere(edit), false).unwrap_err().to_string();
    assert!(refused(&|side| side.all[0].workload_hash = "ff".into()).contains("the primary rays of Cube"));
    assert!(refused(&|side| side.provenance.obvhs = "0.5.0".into()).contains("the version of obvhs"));
    let untimed = refused(&|side| {
        side.all.iter_mut().filter(|own| has_reference_role(own)).for_each(|own| own.trace_ns = None);
    });
    assert!(untimed.contains("the processor differs") && untimed.contains("ratios to an obvhs structure"), "{untimed}");
}
