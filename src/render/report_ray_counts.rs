//! The ray counts of the source report: the proof that scenes, meshes and the course's rules are right.

use super::render;
use crate::accel::Accel;
use crate::kdtree::{KdConfig, KdTree};
use crate::scene::Builtin;
use crate::triangle::Exact;

/// What the report's scenes took when recounted with the course's own renderer, and the report's own total.
struct Known {
    scene: &'static str,
    mirror: u64,
    shadow: u64,
    report: u64,
    /// How far the total may be from the report's, as README tells it.
    within: u64,
    /// How far mirror and shadow rays may be from the recount.
    recount: u64,
}

/// Two scenes are not reproduced to the ray. A ray that meets an edge, or passes it narrowly, goes on as the rounding of a triangle
/// test has it, and its mirror and shadow rays with it; which test the report used is not known, and here none rounds. In
/// Infinitycandy mirrors make many of few such rays. In the Cornell box walls end at each other's edges, and one thing more is
/// inferred: the report does not tell that the back wall is a mirror. With a mirror there our total is 8 off its own, and the recount's 29;
/// without one 38,495 mirror rays and their shadow rays would be missing. So these are bounds of what is seen, not of what is
/// explained ray by ray.
#[rustfmt::skip]
const KNOWN: &[Known] = &[
    Known { scene: "Cube", mirror: 0, shadow: 20_648, report: 282_793, within: 1, recount: 0 },
    Known { scene: "Sphere", mirror: 0, shadow: 25_612, report: 287_756, within: 0, recount: 0 },
    Known { scene: "Torus", mirror: 0, shadow: 47_144, report: 309_289, within: 1, recount: 0 },
    Known { scene: "Teapot", mirror: 0, shadow: 52_671, report: 314_816, within: 1, recount: 0 },
    Known { scene: "Billards", mirror: 62_227, shadow: 1_070_836, report: 1_395_208, within: 1, recount: 0 },
    Known { scene: "Cornellbox", mirror: 38_488, shadow: 720_831, report: 1_021_492, within: 8, recount: 30 },
    Known { scene: "Infinitycandy", mirror: 1_868_987, shadow: 2_130_720, report: 4_261_851, within: 4, recount: 2 },
    Known { scene: "Metallic", mirror: 60_264, shadow: 495_048, report: 817_456, within: 0, recount: 0 },
];

/// By exact answers, so that no test's rounding is part of the proof.
#[test]
fn rays_are_as_many_as_in_the_report() {
    let mut wrong = vec![];
    for known in KNOWN {
        let scene = Builtin::find(known.scene).unwrap().scene(None).unwrap();
        let tree = KdTree::<Exact>::build(&scene.mesh, &KdConfig::SAH).unwrap();
        let counts = render(&scene, &tree, scene.size).1;
        assert_eq!(counts.primary, 512 * 512);
        let of_recount = [(counts.mirror, known.mirror), (counts.shadow, known.shadow)];
        let is_recounted = of_recount.into_iter().all(|(ours, theirs)| ours.abs_diff(theirs) <= known.recount);
        if !is_recounted || counts.total().abs_diff(known.report) > known.within {
            wrong.push(format!("{}: {counts:?}, in all {}", known.scene, counts.total()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
