/// The KD-tree and the BVH of a pair. In the second and third the node, the leaf and the walk are the same and only the way to divide
/// the triangles differs; the first are the textbook tree and the BVH from outside. All over one triangle test.
pub const PAIRS: [[&str; 2]; 3] = [
    ["sah-kd:test=moller-trumbore", "obvhs-bvh2"],
    ["sah-kd-wide:test=moller-trumbore", "sah-bvh:test=moller-trumbore"],
    ["sah-kd-tight:test=moller-trumbore", "sah-bvh:test=moller-trumbore"],
];
