//! The structures that others are compared with, where they take part.

use crate::registry::Choice;
use crate::report::Record;
use crate::scene::Scene;

/// Every ray against every triangle.
pub const BRUTE_FORCE: &str = "brute-force";

/// Among more triangles brute force takes ten milliseconds and more for a ray: it takes part only where it is named.
const MANY: usize = 1 << 22;

/// Said of a scene with so many.
pub fn left_out(scene: &Scene) -> String {
    format!(
        "{}: {BRUTE_FORCE} is left out, which would take minutes among so many triangles: --structure {BRUTE_FORCE} asks for it",
        scene.name
    )
}

/// Whether so many triangles are so many that what grows with each of them is sampled or left out.
pub fn is_large(triangles: usize) -> bool {
    triangles > MANY
}

/// Whether `choice` would take minutes among so many triangles.
pub fn takes_minutes(choice: &Choice, triangles: usize) -> bool {
    choice.entry.name == BRUTE_FORCE && is_large(triangles)
}

/// The report's tree.
pub const REPORT_TREE: &str = "median-kd";

/// The tree of which the report claims that it would be faster.
pub const SAH_TREE: &str = "sah-kd";

/// Why a baseline may give wrong answers: a defect of its own that is known and described, so that wrong answers are shown and do not end
/// a run with the status of ours. Nothing for all other structures.
pub fn documented_defect(structure: &str) -> Option<&'static str> {
    match structure {
        "obvhs-bvh2" | "obvhs-cwbvh" => Some(
            "obvhs 0.4.0 has a triangle test in single precision, clamps the inverse of small direction components, loses rays in the plane of a box face, and its \
             CwBvh rays with a component of -0.0",
        ),
        "bvh" => Some(
            "bvh 0.13 lets a ray in the plane of a box face meet no box, its triangle test has absolute epsilons, and its \
             stack holds 32 nodes",
        ),
        "parry" => Some(
            "parry3d 0.31 clamps the inverse of small direction components, and loses rays in the plane of a box face",
        ),
        "tinybvh" => Some(
            "tinybvh 1.6 widens no box, cancels far from the origin, refuses small determinants and divides approximately",
        ),
        "embree" => Some(
            "Embree without ROBUST widens no box, loses hits far from the origin, rays in the plane of a box face and hits at \
             the origin",
        ),
        "embree-robust" => Some("Embree loses rays in the plane of a box face and with very short directions"),
        _ => None,
    }
}

/// Whether a case is of one of the BVHs from outside over their own triangle test, with nothing of ours in it: what all others are related to.
pub fn is_reference(record: &Record) -> bool {
    is_obvhs(&record.structure) && !record.label.contains("test=")
}

/// Whether a structure is one of the BVHs from outside.
pub fn is_obvhs(structure: &str) -> bool {
    structure.starts_with("obvhs-")
}
