//! The structures of other projects, as far as their features are on: what each answers rightly, and the known defects by
//! name and cause. When a defect is gone, this fails and the list must shrink; when one is new, this fails too.
#![cfg(any(feature = "peer-bvh", feature = "peer-embree", feature = "peer-parry", feature = "peer-tinybvh"))]

use std::panic::{self, AssertUnwindSafe};
use std::slice;

use sahara::accel::BuildError;
use sahara::geometry::Ray;
use sahara::registry::{Choice, Registry};
use sahara::validate::conformance::{Named, counting, findings, shapes};
use sahara::validate::{Kind, Reference, Stratum, Validation, degenerate_meshes, validate};

use crate::conformance::passes;
use crate::findings::mesh;

/// Every way in which peers are asked; those whose feature is off or whose library is absent are left out.
const PEERS: [&str; 15] = [
    "bvh",
    "bvh:test=moller-trumbore",
    "bvh:traversal=nearest",
    "parry",
    "parry:test=moller-trumbore",
    "parry:builder=ploc",
    "tinybvh",
    "tinybvh:quality=medium",
    "embree",
    "embree:quality=medium",
    "embree:packet=8,rays=coherent",
    "embree:packet=16",
    "embree:packet=16,rays=coherent",
    "embree-robust",
    "embree-robust:packet=16",
];

/// The peers that can take part here. Says which are skipped, and why.
fn present(specs: &[&str]) -> Vec<Choice> {
    let registry = Registry::builtin();
    let mut present = vec![];
    for spec in specs {
        let name = spec.split(':').next().unwrap();
        if !registry.names().contains(&name) {
            eprintln!("skipped: {spec}: its feature is off");
            continue;
        }
        let choice = registry.choose(spec).unwrap();
        match choice.entry.absence() {
            Some(absence) => eprintln!("skipped: {spec}: {absence}"),
            None => present.push(choice),
        }
    }
    present
}

/// The meshes that the peer admits, but for those whose sizes spoil every kind of ray.
fn meshes(choice: &Choice) -> Vec<Named> {
    let mut meshes = degenerate_meshes();
    meshes.retain(|(name, mesh)| {
        let spoilt = name == "soup times 2^-30" || name == "exponential sequence";
        !spoilt && !matches!(choice.build(mesh), Err(BuildError::Mesh(_)))
    });
    assert!(meshes.len() > 50, "{} admits {} meshes", choice.label, meshes.len());
    meshes
}

/// Kinds of rays that a peer answers rightly on every mesh, and whether it is known to err on all others: Embree and tinybvh
/// compute with what instructions they find, so that their errors differ from machine to machine.
const CLEAN: [(&str, &[Stratum], bool); 5] = {
    use Stratum::{Edges, Invalid, Lengths, NearSurface, Random, Vertices, Windows};
    [
        ("bvh", &[Random, Lengths, NearSurface, Windows, Invalid], true),
        ("parry", &[Random, NearSurface, Invalid], true),
        ("tinybvh", &[Random, Invalid], false),
        ("embree", &[Random, NearSurface, Windows, Invalid], false),
        ("embree-robust", &[Random, Vertices, Edges, NearSurface, Windows, Invalid], false),
    ]
};

#[test]
fn rays_without_a_named_cause_are_answered_rightly() {
    for (name, clean, all_others_err) in CLEAN {
        for choice in present(&[name]) {
            let all = findings(&choice.subject(), &meshes(&choice), 200).unwrap();
            for stratum in Stratum::ALL {
                let of_stratum = all.iter().filter(|f| f.stratum == stratum && f.validation.errors() > 0);
                let wrong: Vec<String> = of_stratum.map(|f| f.line(name)).collect();
                let is_clean = clean.contains(&stratum);
                assert!(!is_clean || wrong.is_empty(), "{name}, {}: {wrong:#?}", stratum.name());
                assert!(is_clean || !all_others_err || !wrong.is_empty(), "{name} errs no more: {}", stratum.name());
            }
        }
    }
}

#[test]
fn every_way_to_ask_is_right_on_random_rays_counts_and_has_a_possible_shape() {
    for choice in present(&PEERS) {
        let (subject, meshes) = (choice.subject(), meshes(&choice));
        passes(counting(&subject, &meshes, 10));
        passes(shapes(&subject, &meshes));
        for finding in findings(&subject, &meshes, 40).unwrap() {
            let wrong = finding.validation.errors() > 0;
            assert!(finding.stratum != Stratum::Random || !wrong, "{}", finding.line(&choice.label));
        }
    }
}

/// One ray over the box of a grid that some peers answer wrongly.
struct Finding {
    name: &'static str,
    /// Why, as their sources show.
    cause: &'static str,
    peers: &'static [&'static str],
    ray: &'static str,
    kind: Kind,
}

const FINDINGS: [Finding; 4] = [
    Finding {
        name: "in the near face of a box",
        cause: "0 / 0 is no number, and a box with one is missed",
        peers: &["bvh"],
        ray: "0.375,3.875,-1.0 0.0,-1.0,0.0",
        kind: Kind::Lost,
    },
    Finding {
        name: "in the far face of a box",
        cause: "the same, and elsewhere 1 / 0 is a large number, which makes boxes half-open",
        peers: &["bvh", "parry", "tinybvh", "embree", "embree-robust"],
        ray: "0.375,3.875,1.0 0.0,-1.0,0.0",
        kind: Kind::Lost,
    },
    Finding {
        name: "short direction",
        cause: "direction components below 1.2e-7 (parry) and 1e-18 (Embree) are replaced by those",
        peers: &["parry", "embree", "embree-robust"],
        ray: "0.2,0.3,3.0 1e-20,2e-20,-1e-19",
        kind: Kind::Lost,
    },
    Finding {
        name: "nothing wrong",
        cause: "an ordinary ray",
        peers: &[],
        ray: "0.3,0.2,1.00005 0.1,0.2,-1.0",
        kind: Kind::Lost,
    },
];

/// One ray over the box of a grid.
fn asked(choice: &Choice, ray: &str) -> Validation {
    let mesh = mesh("box of a grid");
    let reference = Reference::of_test(choice.triangle_test(), &mesh).unwrap();
    let ray: Ray = ray.parse().unwrap();
    validate(&*choice.build(&mesh).unwrap(), &reference, &mesh, slice::from_ref(&ray))
}

#[test]
fn each_finding_is_still_there() {
    for finding in FINDINGS {
        for (name, ..) in CLEAN {
            for choice in present(&[name]) {
                let found = asked(&choice, finding.ray);
                let expected = finding.peers.contains(&name).then_some(finding.kind);
                assert!(found.hits == 1 || expected.is_none(), "{}: the reference hits", finding.name);
                let kind = found.worst_error().map(|worst| worst.kind);
                assert_eq!(kind, expected, "{}, {}: {name}", finding.name, finding.cause);
            }
        }
    }
}

/// Embree's default and tinybvh are open at the beginning, and declare it: what lies at the origin is not counted.
#[test]
fn what_lies_at_the_start_of_an_open_interval_is_not_counted() {
    let at_origin = "0.3,0.2,1.0 0.1,0.2,-1.0";
    for choice in present(&["embree", "tinybvh"]) {
        let found = asked(&choice, at_origin);
        assert_eq!((found.hits, found.errors(), found.test_errors, found.declined), (1, 0, 0, 1));
    }
    for choice in present(&["embree-robust"]) {
        let found = asked(&choice, at_origin);
        assert_eq!((found.hits, found.errors(), found.test_errors), (1, 0, 0));
    }
}

#[test]
fn the_stack_of_bvh_panics_on_a_deep_tree() {
    for choice in present(&["bvh"]) {
        let deep = mesh("exponential sequence");
        let accel = choice.build(&deep).unwrap();
        let rays: Vec<Ray> = Stratum::ALL.iter().flat_map(|stratum| stratum.rays(&deep, 200, 1)).collect();
        let mut hits = vec![None; rays.len()];
        let asked = panic::catch_unwind(AssertUnwindSafe(|| accel.closest_hits(&rays, &mut hits)));
        assert!(asked.is_err(), "its stack has grown");
    }
}

#[test]
fn tinybvh_is_kept_from_trees_that_overflow_its_stack() {
    for choice in present(&["tinybvh"]) {
        let refused = choice.build(&mesh("2000 coincident")).err().expect("refused").to_string();
        assert!(refused.contains("stack of 256 nodes"), "{refused}");
    }
}

#[cfg(feature = "peer-embree")]
mod absent {
    use std::process::{Command, Output};

    fn without_library(path: &str, args: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sahara"));
        command.env("SAHARA_EMBREE", path).args(args).output().expect("the command runs")
    }

    #[test]
    fn an_absent_library_is_named_and_ends_no_run() {
        let compare = ["-q", "compare", "cube", "-s", "sah-kd", "-s", "embree", "--rays", "100", "--budget", "1"];
        let output = without_library("/nowhere/libembree4.so", &compare);
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(5), "{text}");
        assert!(
            text.contains("embree") && text.contains("refused") && text.contains("/nowhere/libembree4.so"),
            "{text}"
        );
        assert!(text.lines().any(|line| line.trim_start().starts_with("sah-kd")), "{text}");

        let list = without_library("/nowhere/libembree4.so", &["list", "structures"]);
        let text = String::from_utf8_lossy(&list.stdout);
        assert!(list.status.success() && text.contains("absent"), "{text}");
    }

    #[test]
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    fn another_library_is_refused() {
        let output = without_library("libm.so.6", &["-q", "validate", "cube", "-s", "embree", "--rays", "50"]);
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(5), "{text}");
        assert!(text.contains("libm.so.6 is not Embree 4"), "{text}");
    }
}
