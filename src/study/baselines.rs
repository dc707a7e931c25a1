//! The structures that others are compared with, where they take part.

/// Every ray against every triangle.
pub const BRUTE_FORCE: &str = "brute-force";

/// The report's tree.
pub const REPORT_TREE: &str = "median-kd";

/// The tree of which the report claims that it would be faster.
pub const SAH_TREE: &str = "sah-kd";

/// Why a baseline may give wrong answers: a defect of its own that is known and described, so that its time is shown all
/// the same, with its errors. Nothing for all other structures.
pub fn documented_defect(structure: &str) -> Option<&'static str> {
    match structure {
        "obvhs-bvh2" | "obvhs-cwbvh" => Some(
            "obvhs 0.4.0 clamps the inverse of small direction components, loses rays in the plane of a box face, and its \
             CwBvh rays with a component of -0.0",
        ),
        _ => None,
    }
}

/// Whether a structure is one of the BVHs from outside.
pub fn is_obvhs(structure: &str) -> bool {
    structure.starts_with("obvhs-")
}
