//! Tests that the baseline obvhs 0.4.0 has exactly the known defects.
//!
//! If a defect in `FINDINGS` disappears, remove the defect from `FINDINGS`.

use std::sync::Arc;

use sahara::geometry::{Mesh, Ray};
use sahara::oracle;
use sahara::registry::{Choice, Registry};
use sahara::validate::conformance::{Named, findings};
use sahara::validate::{Kind, Reference, Stratum, Validation, degenerate_meshes, validate};

use crate::conformance::TREES;

const BVH2: [&str; 2] = ["obvhs-bvh2", "obvhs-bvh2:test=moller-trumbore"];
const CWBVH: [&str; 2] = ["obvhs-cwbvh", "obvhs-cwbvh:test=moller-trumbore"];
const BOTH: [&str; 4] = [BVH2[0], BVH2[1], CWBVH[0], CWBVH[1]];

/// One ray for which some structures return a wrong result.
pub struct Finding {
    /// The reason for the wrong result.
    pub cause: &'static str,
    pub structures: &'static [&'static str],
    pub mesh: &'static str,
    pub ray: &'static str,
    pub kind: Kind,
}

/// A template for findings.
pub const LOST: Finding = Finding { cause: "", structures: &[], mesh: "box of a grid", ray: "", kind: Kind::Lost };

const FINDINGS: [Finding; 6] = [
    Finding {
        cause: "negative zero: the octant is found by d < 0, the inverse by 1 / d: with -0.0 the two disagree",
        structures: &CWBVH,
        ray: "0.25,0.125,-3.0 -0.0,-0.0,1.0",
        ..LOST
    },
    Finding {
        cause: "small t: a box must be left after t = 1e-4, an absolute bound",
        structures: &CWBVH,
        ray: "0.3,0.2,1.00005 0.1,0.2,-1.0",
        kind: Kind::NearerLost,
        ..LOST
    },
    Finding {
        cause: "in a box face: 1 / 0 is replaced by a large number, which makes boxes half-open: a ray in the far face leaves at t = 0",
        structures: &BOTH,
        ray: "0.375,3.875,1.0 0.0,-1.0,0.0",
        ..LOST
    },
    Finding {
        cause: "short direction: direction components below 1.2e-7 are replaced by 1.2e-7",
        structures: &BOTH,
        ray: "0.2,0.3,3.0 1e-10,2e-10,-1e-9",
        ..LOST
    },
    Finding {
        cause: "box without a margin: box entry and exit are rounded without slack, so that a hit at a corner of the box falls out",
        structures: &BOTH,
        ray: "3.6959038,2.4580703,-0.22391748 -4.645062,-1.4580703,-0.7760825",
        ..LOST
    },
    Finding {
        cause: "far origin: the same rounding, which grows with the distance: rays from far away miss boxes",
        structures: &BOTH,
        mesh: "one triangle",
        ray: "0.055807248,2499999.5,0.341033 0.0,-1.0,0.0",
        ..LOST
    },
];

pub fn mesh(name: &str) -> Arc<Mesh> {
    degenerate_meshes().into_iter().find(|(known, _)| known == name).expect("a mesh of the suite").1
}

pub fn compared(choice: &Choice, mesh_name: &str, ray: &str) -> Validation {
    let mesh = mesh(mesh_name);
    let reference = Reference::of_test(choice.triangle_test(), &mesh).unwrap();
    validate(&*choice.build(&mesh).unwrap(), &reference, &mesh, &[ray.parse().unwrap()])
}

impl Finding {
    /// Checks that `choice` has the error `kind` exactly if `structures` contains `spec`.
    #[track_caller]
    pub fn assert_on(&self, choice: &Choice, spec: &str) {
        let found = compared(choice, self.mesh, self.ray);
        let expected = self.structures.contains(&spec).then_some(self.kind);
        assert!(found.hits == 1 || expected.is_none(), "{}: the ray hits by {}", self.cause, choice.triangle_test());
        assert_eq!(found.worst_error().map(|worst| worst.kind), expected, "{}: {spec}", self.cause);
    }
}

#[test]
fn each_finding_is_still_there_and_ours_find_the_hit() {
    let registry = Registry::builtin();
    for finding in FINDINGS {
        for spec in BOTH.iter().chain(&TREES) {
            finding.assert_on(&registry.choose(spec).unwrap(), spec);
        }
    }
}

/// Excludes two meshes on which the structures of obvhs lose many hits. In `soup times 2^-30`, the directions of rays
/// are very short. The mesh `exponential sequence` has boxes of all sizes.
pub fn meshes() -> Vec<Named> {
    let mut meshes = degenerate_meshes();
    meshes.retain(|(name, _)| name != "soup times 2^-30" && name != "exponential sequence");
    meshes
}

/// The name of a structure, and all strata without an error.
pub type CleanStrata = (&'static str, &'static [Stratum]);

pub fn assert_clean(choice: &Choice, meshes: &[Named], (name, clean): CleanStrata) {
    let all = findings(&choice.subject(), meshes, 200).unwrap();
    for stratum in Stratum::ALL {
        let wrong = all.iter().filter(|f| f.stratum == stratum && f.validation.errors() > 0);
        let wrong: Vec<String> = wrong.map(|f| f.line(&choice.label)).collect();
        assert_eq!(wrong.is_empty(), clean.contains(&stratum), "{name}, {}: {wrong:#?}", stratum.name());
    }
}

#[test]
fn rays_without_a_named_cause_are_answered_rightly() {
    use Stratum::{Invalid, NearSurface, Random};
    let registry = Registry::builtin();
    for clean in [(BVH2[0], &[Random, Invalid, NearSurface][..]), (CWBVH[0], &[Random, Invalid])] {
        assert_clean(&registry.choose(clean.0).unwrap(), &meshes(), clean);
    }
}

/// Brute force also misses these hits. On an edge, the sum of two rounded quotients can exceed 1. The triangle test
/// reads only the sign bit of a quotient, so a point at -0.0 is outside.
#[test]
fn rt_triangle_misses_hits_on_edges() {
    let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(glam::Vec3::from_array);
    for ray in ["3.0,0.0,1.0 1.0,2.0,-3.0", "3.0,3.0,2.0 -1.0,-2.0,-3.0", "2.0,2.0,-2.0 1.0,-1.0,3.0"] {
        let ray: Ray = ray.parse().unwrap();
        for order in [[0, 1, 2], [0, 2, 1]] {
            let mesh = Arc::new(Mesh::new(corners.to_vec(), vec![order]).unwrap());
            assert!(oracle::nearest(&ray, &mesh).is_some(), "edges belong to the triangle");
            let hits = ["moller-trumbore", "rt-triangle"]
                .map(|test| Reference::of_test(test, &mesh).unwrap().accel.closest(&[ray])[0].is_some());
            assert_eq!(hits, [true, false], "{ray} {order:?}");
        }
    }
}
