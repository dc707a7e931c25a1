//! [tinybvh](https://github.com/jbikker/tinybvh) 1.6.8 from the crate `tinybvh-rs` 0.1: the layout `BVH8_CPU`, built
//! with spatial splits (SBVH).
//!
//! The queries call the linked C++ library directly (see `query.rs`).
//!
//! # References
//! Fuetterling, Lojewski, Pfreundt, Ebert: Accelerated single ray tracing for wide vector units. HPG 2017.

mod query;

use std::sync::Arc;

use glam::Vec3;
use tinybvh_rs::{Positions, bvh, bvh8_cpu, mbvh};

use crate::accel::{Accel, BuildError, Capabilities, Footprint, Observed, Observer, TreeShape};
use crate::external::prepared::{Prepare, prepared_queries};
use crate::geometry::{Hit, Mesh, Ray};
use query::{RayHead, Tree};

/// The 8-wide BVH of tinybvh.
pub struct TinyBvh {
    tree: Option<Tree>,
    /// Maps the triangle indices of the tree to the triangle indices of the mesh.
    ids: Vec<u32>,
    shape: TreeShape,
}

/// Bytes of a node.
const NODE_BYTES: usize = 256;

/// Bytes of a leaf, which holds up to four triangles.
const LEAF_BYTES: usize = 192;

/// A ray of tinybvh ends at this distance or before it.
const FAR: f32 = tinybvh_rs::INFINITE;

/// The ray mask that selects all instances.
const EVERYTHING: u32 = 0xffff;

/// tinybvh's inverse of a direction component, always finite.
#[inline(always)]
fn inverse(x: f32) -> f32 {
    if x.abs() > 1e-12 { 1.0 / x } else { FAR.copysign(if x >= 0.0 { 1.0 } else { -1.0 }) }
}

pub(crate) struct Ready {
    ray: RayHead,
    length: f32,
    t_min: f32,
}

impl Prepare for TinyBvh {
    type Ready = Ready;

    #[inline]
    fn ready(&self, ray: &Ray) -> Option<Ready> {
        if !ray.is_valid() {
            return None;
        }
        let (t_min, t_max) = ray.interval();
        let length = ray.direction.length();
        // tinybvh has no `t_min`, so the origin is moved to the point at `t_min`.
        let origin = if t_min > 0.0 { ray.at(t_min) } else { ray.origin };
        let unit = ray.direction * (1.0 / length);
        let inverse = Vec3::from_array(unit.to_array().map(inverse));
        let end = ((t_max - t_min) * length).min(FAR);
        // tinybvh computes the sum `checked` in this order. tinybvh exits the process if the sum is NaN.
        //
        // If `unit` or `origin * inverse` overflows, tinybvh may read outside its arrays.
        let checked = unit.x + unit.y + unit.z + end + origin.x + origin.y + origin.z;
        if checked.is_nan() || !unit.is_finite() || !(origin * inverse).is_finite() {
            return None;
        }
        let ray = RayHead {
            origin: origin.to_array(),
            mask: EVERYTHING,
            direction: unit.to_array(),
            instance: 0,
            inverse: inverse.to_array(),
            hit_instance: 0,
            t: end,
            u: 0.0,
            v: 0.0,
            primitive: 0,
        };
        Some(Ready { ray, length, t_min })
    }

    #[inline]
    fn closest<O: Observer>(&self, ready: &Ready, _: &mut O) -> Option<Hit> {
        let (t, primitive) = self.tree.as_ref()?.closest(&ready.ray)?;
        Some(Hit::new(t / ready.length + ready.t_min, self.ids[primitive as usize]))
    }

    #[inline]
    fn any<O: Observer>(&self, ready: &Ready, _: &mut O) -> bool {
        self.tree.as_ref().is_some_and(|tree| tree.any(&ready.ray))
    }
}

/// The capacity of the stacks in `BVH8_CPU`, in entries. tinybvh does not check the capacity.
const STACK: usize = 256;

/// The shape of the tree, and an upper bound on the number of entries in the stacks of `BVH8_CPU`.
///
/// At a node with n children, m of them inner, the traversal pushes at most n entries. The conversion to `BVH8_CPU`
/// pushes 2 m entries. One entry is popped before a child is visited, so at most max(n, 2 m) - 1 entries remain. The
/// bound includes eight more entries, because the traversal writes eight entries at once.
fn shape(nodes: &[mbvh::Node]) -> (TreeShape, usize) {
    let (mut shape, mut most) = (TreeShape::default(), 0);
    let mut stack = vec![(0, 0, 0)];
    while let Some((at, depth, waiting)) = stack.pop() {
        let node = &nodes[at as usize];
        most = most.max(waiting);
        if node.is_leaf() {
            let count = node.tri_count as usize;
            shape.leaves += 1;
            shape.references += count;
            shape.largest_leaf = shape.largest_leaf.max(count);
            shape.depth = shape.depth.max(depth);
        } else {
            shape.inner += 1;
            let children = || node.child.iter().filter(|&&child| child != 0);
            let inner = children().filter(|&&child| !nodes[child as usize].is_leaf()).count();
            let more = children().count().max(2 * inner).saturating_sub(1);
            stack.extend(children().map(|&child| (child, depth + 1, waiting + more)));
        }
    }
    (shape, most + 8)
}

impl Accel for TinyBvh {
    type Config = ();

    const OBSERVED: Observed = Observed::NONE;
    const CAPABILITIES: Capabilities = Capabilities { closed_start: false, ..Capabilities::ALL };
    const CONVENTIONS: &'static [&'static str] = &[
        "a ray with t_min starts at the rounded point at t_min",
        "traces unit directions: t is divided by the direction's length; no hits beyond 1e30",
        "rays that would crash the process (NaN, or an overflow of the unit direction or of origin over direction) \
         are not traced and hit nothing",
        "builds large scenes on its own threads, regardless of --threads",
    ];

    fn build(mesh: &Arc<Mesh>, (): &()) -> Result<Self, BuildError> {
        if !cfg!(target_feature = "avx2") {
            let sentence = "tinybvh's 8-wide layout needs AVX2: build sahara for a processor that has it";
            return Err(BuildError::Unavailable(sentence.into()));
        }
        let ids: Vec<u32> = mesh.solid().collect();
        if ids.is_empty() {
            return Ok(Self { tree: None, ids, shape: TreeShape::one_leaf(0) });
        }
        let corners: Vec<[f32; 4]> =
            ids.iter().flat_map(|&id| mesh.corners(id)).map(|v| v.extend(0.0).to_array()).collect();
        let refusal = |error: tinybvh_rs::Error| BuildError::Mesh(format!("tinybvh reports an error: {error}"));
        let corners: Positions = corners.as_slice().into();
        let mut binary = bvh::BVH::new_hq(corners).map_err(refusal)?;
        binary.split_leaves(4);
        let wide = mbvh::BVH::new(&binary);
        let (shape, waiting) = shape(wide.nodes());
        if waiting > STACK {
            let sentence = format!("tinybvh has a stack of {STACK} nodes, but its tree over this mesh needs {waiting}");
            return Err(BuildError::Mesh(sentence));
        }
        let tree = Tree::new(bvh8_cpu::BVH::new(&wide).map_err(refusal)?);
        Ok(Self { tree: Some(tree), ids, shape })
    }

    prepared_queries!();

    /// `nodes` includes the leaves, which contain the triangles.
    fn footprint(&self) -> Footprint {
        let nodes = self.shape.inner * NODE_BYTES + self.shape.leaves * LEAF_BYTES;
        Footprint { nodes, references: size_of_val(&self.ids[..]), ..Footprint::default() }
    }

    fn shape(&self) -> TreeShape {
        self.shape.clone()
    }
}
