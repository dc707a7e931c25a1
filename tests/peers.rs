//! Tests the hits of peers, which are structures of other projects.
//!
//! If a peer fixes a defect, remove the peer from the matching entry in `FINDINGS`.
#![cfg(any(feature = "peer-bvh", feature = "peer-embree", feature = "peer-parry", feature = "peer-tinybvh"))]

use std::panic::{self, AssertUnwindSafe};

use sahara::accel::BuildError;
use sahara::geometry::Ray;
use sahara::registry::{Choice, Registry};
use sahara::validate::Stratum;
use sahara::validate::conformance::{Named, counting, findings, shapes};

use crate::conformance::passes;
use crate::findings::{self, CleanStrata, Finding, LOST, assert_clean, compared, mesh};

/// Configurations of the peers. The tests skip peers whose Cargo feature is off or whose library is absent.
const PEERS: [&str; 12] = [
    "bvh",
    "bvh:test=moller-trumbore",
    "parry",
    "parry:test=moller-trumbore",
    "tinybvh",
    "embree",
    "embree:quality=medium",
    "embree:packet=8,rays=coherent",
    "embree:packet=16",
    "embree:packet=16,rays=coherent",
    "embree-robust",
    "embree-robust:packet=16",
];

/// Returns `None` if the peer is skipped.
fn present(spec: &str) -> Option<Choice> {
    let registry = Registry::builtin();
    let is_on = registry.names().contains(&spec.split(':').next().unwrap());
    let choice = is_on.then(|| registry.choose(spec).unwrap());
    let absence = choice.as_ref().map_or(Some("its feature is off".into()), |choice| choice.entry.absence());
    if let Some(absence) = &absence {
        eprintln!("skipped: {spec}: {absence}");
    }
    choice.filter(|_| absence.is_none())
}

fn meshes(choice: &Choice) -> Vec<Named> {
    let mut meshes = findings::meshes();
    meshes.retain(|(_, mesh)| !matches!(choice.build(mesh), Err(BuildError::Mesh(_))));
    assert!(meshes.len() > 50, "{} admits {} meshes", choice.label, meshes.len());
    meshes
}

/// Peers, each with the strata of rays on which the peer has no errors.
///
/// The list contains only peers with the same errors on all instruction sets.
const CLEAN: [CleanStrata; 2] = {
    use Stratum::{Invalid, Lengths, NearSurface, Random, RoundedEnds, Windows};
    [
        ("bvh", &[Random, Lengths, NearSurface, Windows, Invalid, RoundedEnds]),
        ("parry", &[Random, NearSurface, Invalid]),
    ]
};

#[test]
fn rays_without_a_named_cause_are_right() {
    for clean in CLEAN {
        let Some(choice) = present(clean.0) else { continue };
        assert_clean(&choice, &meshes(&choice), clean);
    }
}

#[test]
fn every_configuration_is_right_on_random_rays_counts_and_has_a_possible_shape() {
    for choice in PEERS.into_iter().filter_map(present) {
        let (subject, meshes) = (choice.subject(), meshes(&choice));
        passes(counting(&subject, &meshes, 10));
        passes(shapes(&subject, &meshes));
        for finding in findings(&subject, &meshes, 40).unwrap() {
            // With `rays=coherent`, Embree's choice between triangles with equal `t` may depend on the packet.
            let another = if choice.label.ends_with("coherent") { finding.validation.unrepeatable } else { 0 };
            let wrong = finding.validation.errors() > another;
            assert!(finding.stratum != Stratum::Random || !wrong, "{}", finding.line(&choice.label));
        }
    }
}

const FINDINGS: [Finding; 4] = [
    Finding {
        cause: "in the near face of a box: 0 / 0 is no number, and a box with one is missed",
        structures: &["bvh"],
        ray: "0.375,3.875,-1.0 0.0,-1.0,0.0",
        ..LOST
    },
    Finding {
        cause: "in the far face of a box: the same, and elsewhere 1 / 0 is a large number, which makes boxes half-open",
        // tinybvh also misses rays in far faces, but rounding of its own triangle test may be the cause.
        structures: &["bvh", "parry", "embree", "embree-robust"],
        ray: "0.375,3.875,1.0 0.0,-1.0,0.0",
        ..LOST
    },
    Finding {
        cause: "short direction: direction components below 1.2e-7 (parry) and 1e-18 (Embree) are replaced by those",
        structures: &["parry", "embree", "embree-robust"],
        ray: "0.2,0.3,3.0 1e-20,2e-20,-1e-19",
        ..LOST
    },
    Finding { cause: "nothing wrong: an ordinary ray", ray: "0.3,0.2,1.00005 0.1,0.2,-1.0", ..LOST },
];

#[test]
fn each_finding_is_still_there() {
    for name in ["bvh", "parry", "tinybvh", "embree", "embree-robust"] {
        let Some(choice) = present(name) else { continue };
        FINDINGS.iter().for_each(|finding| finding.assert_on(&choice, name));
        // The ray below has a hit at `t_min`. `embree` and `tinybvh` exclude hits at `t_min`.
        let declined = match name {
            "embree" | "tinybvh" => 1,
            "embree-robust" => 0,
            _ => continue,
        };
        let found = compared(&choice, LOST.mesh, "0.3,0.2,1.0 0.1,0.2,-1.0");
        assert_eq!((found.hits, found.errors(), found.test_errors, found.declined), (1, 0, 0, declined), "{name}");
    }
}

#[test]
fn deep_trees_overflow_the_stack_of_bvh_and_are_refused_for_that_of_tinybvh() {
    if let Some(choice) = present("bvh") {
        let deep = mesh("exponential sequence");
        let accel = choice.build(&deep).unwrap();
        let rays: Vec<Ray> = Stratum::ALL.iter().flat_map(|stratum| stratum.rays(&deep, 200, 1)).collect();
        let traced = panic::catch_unwind(AssertUnwindSafe(|| accel.closest(&rays)));
        assert!(traced.is_err(), "its stack has grown");
    }
    if let Some(choice) = present("tinybvh") {
        let refused = choice.build(&mesh("2000 coincident")).err().expect("refused").to_string();
        assert!(refused.contains("stack of 256 nodes"), "{refused}");
    }
}

#[cfg(feature = "peer-embree")]
#[test]
fn an_absent_or_wrong_library_is_named_and_ends_no_run() {
    use crate::cli::command::{command, ends};

    const ABSENT: &str = "/nowhere/libembree4.so";
    let compare = "-q compare cube -s sah-kd -s embree --rays 100 --budget 1";
    let mut runs = vec![
        (ABSENT, compare, 5, &["embree", "refused", ABSENT, "\n  sah-kd "][..]),
        (ABSENT, "list structures", 0, &["absent"]),
    ];
    if cfg!(all(target_os = "linux", target_env = "gnu")) {
        runs.push(("libm.so.6", "-q validate cube -s embree --rays 50", 5, &["libm.so.6 is not Embree 4"]));
    }
    for (library, line, status, parts) in runs {
        let [text, _] = ends(status, command(line).env("SAHARA_EMBREE", library));
        assert!(parts.iter().all(|part| text.contains(part)), "{line}: {text}");
    }
}
