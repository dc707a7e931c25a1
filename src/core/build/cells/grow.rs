//! Grows a KD-tree. The [`Content`] of a node chooses the cut.

use rayon::join;

use crate::build::cut::Cut;
use crate::geometry::{Aabb, Mesh};

pub(crate) struct Context<'a, C> {
    pub mesh: &'a Mesh,
    pub rules: Rules,
    pub config: &'a C,
    depth_cap: u32,
}

/// Rules that decide whether a node becomes a leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rules {
    /// Nodes with at most this many references are leaves.
    pub leaf: usize,
    /// A cut through at least this share of the node's references is discarded. `None` discards no cut.
    pub threshold: Option<f32>,
    /// Whether a cut must cost less than a leaf.
    pub pays: bool,
    /// Maximum total number of references in the leaves, divided by the number of references of the root.
    pub duplication: f32,
    /// Whether a cut counts as progress if only one side has fewer triangles than the node. A plane inside the cell
    /// still makes the cell smaller.
    pub one_side_is_progress: bool,
}

impl Rules {
    pub const fn sah(duplication: f32) -> Self {
        Self { leaf: 1, threshold: None, pays: true, duplication, one_side_is_progress: false }
    }
}

/// The triangles of a node, with a rule that chooses the cut.
pub(crate) trait Content: Sized + Send {
    type Config: Sync;

    fn len(&self) -> usize;

    /// The triangle numbers in ascending order.
    fn ids(&self) -> impl Iterator<Item = u32>;

    /// `None` makes the node a leaf.
    fn choose(&self, context: &Context<Self::Config>, state: &NodeState) -> Option<Cut>;

    /// The contents below and above the cut. If the cut is discarded, the error contains the undivided content.
    fn divide(self, context: &Context<Self::Config>, state: &NodeState, cut: Cut) -> Result<(Self, Self), Self>;

    fn may_divide(&self, _context: &Context<Self::Config>) -> bool {
        true
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeState {
    pub cell: Aabb,
    pub depth: u32,
    /// Number of consecutive splits without progress, up to and including the parent's split.
    stalled: u32,
    /// Maximum total number of references in the leaves of this subtree.
    budget: f64,
}

/// A tree that grows in depth-first order.
pub(crate) trait Tree<C>: Default + Send {
    /// Whether empty leaves are omitted. The sibling of an empty leaf then replaces the parent.
    const SKIPS_EMPTY: bool;

    fn len(&self) -> usize;

    fn leaf(&mut self, content: C);

    /// Appends an inner node without its children.
    fn open(&mut self);

    /// The children of `inner` are the nodes `inner + 1` and `second`.
    fn close(&mut self, inner: usize, cut: Cut, second: usize);

    fn append(&mut self, other: Self);
}

const PARALLEL: usize = 2048;

impl<'a, C> Context<'a, C> {
    pub fn new(mesh: &'a Mesh, rules: Rules, config: &'a C) -> Self {
        Self { mesh, rules, config, depth_cap: depth_cap(mesh.len()) }
    }
}

/// Maximum depth of a leaf, similar to 8 + 1.3 log2 n in pbrt (Pharr, Jakob, Humphreys).
const fn depth_cap(triangles: usize) -> u32 {
    // The number of binary digits replaces log2 n, so no library function affects the shape of a tree.
    let log2 = usize::BITS - if triangles > 1 { triangles } else { 1 }.leading_zeros();
    8 + log2 * 13 / 10
}

/// An upper bound on `depth_cap` for all meshes.
pub(crate) const DEEPEST: u32 = depth_cap(u32::MAX as usize);
const _: () = assert!(DEEPEST == 49);

/// The tree does not depend on the number of threads.
pub(crate) fn grow<C: Content, T: Tree<C>>(context: &Context<C::Config>, content: C) -> T {
    let mut tree = T::default();
    let state = NodeState::root(context, content.len());
    if !T::SKIPS_EMPTY || content.len() > 0 {
        subdivide(context, content, state, true, &mut tree);
    }
    tree
}

fn subdivide<C: Content, T: Tree<C>>(
    context: &Context<C::Config>,
    content: C,
    state: NodeState,
    may_divide: bool,
    tree: &mut T,
) {
    let count = content.len();
    let (cut, below, above) = match try_divide(context, content, &state, may_divide) {
        Ok(parts) => parts,
        Err(content) => return tree.leaf(content),
    };

    let (below_cell, above_cell) = state.cell.cut(cut.axis, cut.plane);
    let stalled = if context.rules.is_progress(count, below.len(), above.len()) { 0 } else { state.stalled + 1 };
    let share = state.budget / (below.len() + above.len()).max(1) as f64;
    let child = |cell, len: usize| NodeState { cell, depth: state.depth + 1, stalled, budget: share * len as f64 };
    let (below_place, above_place) = (child(below_cell, below.len()), child(above_cell, above.len()));
    let (below_may, above_may) = (below.may_divide(context), above.may_divide(context));
    if T::SKIPS_EMPTY && above.len() == 0 {
        return subdivide(context, below, below_place, below_may, tree);
    }
    if T::SKIPS_EMPTY && below.len() == 0 {
        return subdivide(context, above, above_place, above_may, tree);
    }

    let inner = tree.len();
    tree.open();
    let second = if count < PARALLEL {
        subdivide(context, below, below_place, below_may, tree);
        let second = tree.len();
        subdivide(context, above, above_place, above_may, tree);
        second
    } else {
        let mut other = T::default();
        join(
            || subdivide(context, below, below_place, below_may, tree),
            || subdivide(context, above, above_place, above_may, &mut other),
        );
        let second = tree.len();
        tree.append(other);
        second
    };
    tree.close(inner, cut, second);
}

/// The error contains the undivided content for a leaf.
fn try_divide<C: Content>(
    context: &Context<C::Config>,
    content: C,
    state: &NodeState,
    may_divide: bool,
) -> Result<(Cut, C, C), C> {
    let count = content.len();
    if count == 0 || count <= context.rules.leaf || !may_divide || state.depth >= context.depth_cap {
        return Err(content);
    }
    let Some(cut) = content.choose(context, state) else { return Err(content) };
    let (below, above) = content.divide(context, state, cut)?;
    Ok((cut, below, above))
}

impl NodeState {
    pub fn root<C>(context: &Context<C>, count: usize) -> Self {
        let budget = f64::from(context.rules.duplication) * count as f64;
        Self { cell: context.mesh.bounds(), depth: 0, stalled: 0, budget }
    }

    pub fn affords(&self, below: usize, above: usize) -> bool {
        (below + above) as f64 <= self.budget
    }

    pub fn accepts<C>(&self, context: &Context<C>, count: usize, [below, above]: [usize; 2]) -> bool {
        !context.rules.discards(below + above - count, count) && self.affords(below, above)
    }

    /// Allows at most two consecutive splits without progress.
    pub fn progresses<C>(&self, context: &Context<C>, count: usize, below: usize, above: usize) -> bool {
        context.rules.is_progress(count, below, above) || self.stalled < 2
    }
}

impl Rules {
    fn is_progress(&self, count: usize, below: usize, above: usize) -> bool {
        let most = if self.one_side_is_progress { below.min(above) } else { below.max(above) };
        most < count
    }

    /// `both` is the number of triangles that lie on both sides.
    pub fn discards(&self, both: usize, count: usize) -> bool {
        self.threshold.is_some_and(|share| both as f64 >= f64::from(share) * count as f64)
    }
}
