use super::collapse::Collapse;
use super::config::{Batch, Bvh8Config};
use super::layout::Layout;
use super::node::{Child, Limits, Node, WIDTH};
use crate::accel::BuildError;
use crate::build::sah::CostModel;
use crate::geometry::{Aabb, Mesh};
use crate::traversal::leaf::LeafBlock;
use crate::triangle::TriangleTest;

/// A tree of nodes of eight tight boxes and leaves of blocks of eight triangles.
///
/// Its configuration says how the triangles are divided: by planes, so that leaves are the tight boxes of disjoint cells; by groups;
/// or by both. All are collapsed, laid out and searched in the same way. Takes O(n log n) time and memory to build, for a bounded
/// duplication of references; the tree is the same for every number of threads. Costs 256 bytes a node and, over
/// Möller-Trumbore, 320 a block. Not for moving geometry: nothing can be updated.
///
/// # What was tried and did not pay
/// Ratios of times inside one run on two cores of an AMD EPYC (AVX2), Möller-Trumbore in `f32`, real kitchen (57,000 triangles) and
/// dragon (100,000); where it says Xeon, of a Sapphire Rapids (AVX-512) and six meshes together.
///
/// | tried | instead of | time |
/// |---|---|---|
/// | reading the next child from the top of the stack | reading it from the node | 1.23 (kitchen, primary) |
/// | any hit from front to back | leaves first, large boxes first | 1.2 to 1.7 (kitchen), 1.0 (dragon) |
/// | sorting 4096 rays at a time by octant and along a Morton curve, then packets | packets of the rays as they come | 1.3 (primary), 1.3 to 1.7 (random) |
/// | all rays of a slice sorted so, outside of the time; eight under way | as they come; eight under way | 0.94 to 1.01 in windows of 4096, 0.87 to 1.01 of 262,144 (diffuse, random and shuffled rays; lucy, Sponza, 1.1 million triangles; Xeon): less than sorting takes |
/// | a cost of 0.6 or 1.6 for a block of eight triangles | 1.0 | 1.0; bytes 0.97, 1.02 |
/// | rays under way at once that lie side by side | one after the other | 1.1 to 1.4 (primary, shadow) |
/// | branches instead of lists for rays under way at once, four at a time | one after the other | 1.06 to 1.15 (primary), 1.0 to 1.3 (diffuse), 0.75 to 1.0 (random) |
/// | lists of rays that wait to go back on their way, too, so that no branch depends on a box or a triangle | lists of rays at nodes and at leaves | 1.0 |
/// | sixteen rays set up at once before they are under way | each by itself | 1.0 to 1.1 |
/// | boxes of eight bits a plane in nodes of 128 bytes | `f32` in 256 bytes | 1.03 to 1.33, 1.0 on random rays of the dragon; with 1.1 million triangles 1.03 to 1.20; bytes 0.94 |
/// | packets also of the larger part where rays are of two octants | single rays | 0.97 (shadow), 1.05 (primary), 1.03 (others) |
/// | pages of 4 KiB | huge pages | 1.05 to 1.15 (kitchen), 1.0 (dragon) |
/// | nodes and blocks in one piece of memory that begins and ends with a huge page | two arrays that ask for huge pages | 1.0 (Xeon) |
/// | the next entry of the stack fetched ahead while its neighbour is visited | not | 1.0; 0.98 on random rays (Xeon) |
/// | planes of a box combined in pairs | one after the other | 1.01 (Xeon) |
/// | a cost for entering a leaf beside that of its blocks; costs that grow slower or faster than the count | blocks alone | 0.99 to 1.02 (Xeon) |
///
/// # References
/// Wald, Benthin, Boulos: Getting rid of packets, 2008 (wide nodes for single rays). Ylitie, Karras, Laine: Efficient incoherent ray
/// traversal on GPUs through compressed wide BVHs, 2017 (the collapse). Stich, Friedrich, Dietrich: Spatial splits in bounding
/// volume hierarchies, 2009.
pub struct Bvh8<T: TriangleTest> {
    pub(super) root: Child,
    pub(super) nodes: Vec<Node>,
    pub(super) blocks: Vec<LeafBlock<T, WIDTH>>,
    pub(super) bounds: Aabb,
    pub(super) batch: Batch,
}

impl<T: TriangleTest> Bvh8<T> {
    pub(super) fn within(mesh: &Mesh, config: &Bvh8Config, limits: &Limits) -> Result<Self, BuildError> {
        config.check()?;
        limits.admit(mesh.solid().count(), config.duplication)?;
        let tree = config.partition(mesh);
        let collapse = Collapse::new(&tree, &CostModel::new(1.0, config.block_cost, 0.0));
        let Layout { root, nodes, blocks } = Layout::new(mesh, &collapse, limits)?;
        Ok(Self { root, nodes, blocks, bounds: mesh.bounds(), batch: config.batch })
    }
}
