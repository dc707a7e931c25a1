//! Growing a KD-tree: one recursion for all plane rules.

use rayon::join;

use crate::build::cut::Cut;
use crate::geometry::{Aabb, Mesh};

/// What every step of a build knows.
pub(crate) struct Context<'a, C> {
    pub mesh: &'a Mesh,
    pub rules: Rules,
    /// Of the plane rule.
    pub config: &'a C,
    depth_cap: u32,
}

/// When a node stays a leaf. The depth cap 8 + 1.3 log2 n holds besides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rules {
    /// Nodes of at most so many references are leaves.
    pub leaf: usize,
    /// The share of clipped references on both sides at which a cut is discarded, if one is.
    pub threshold: Option<f32>,
    /// Whether a cut must cost less than testing all triangles.
    pub pays: bool,
    /// References of all leaves together, as a multiple of those of the root.
    pub duplication: f32,
    /// Whether a cut is progress that leaves all triangles on one side and fewer on the other.
    pub one_side_is_progress: bool,
}

impl Rules {
    /// Leaves where no cut pays.
    pub const fn sah(duplication: f32) -> Self {
        Self { leaf: 1, threshold: None, pays: true, duplication, one_side_is_progress: false }
    }
}

/// The triangles of a node, in whatever form a plane rule works on.
pub(crate) trait Content: Sized + Send {
    /// What the rule is told.
    type Config: Sync;

    fn len(&self) -> usize;

    /// The triangles, in ascending order.
    fn ids(&self) -> impl Iterator<Item = u32>;

    /// Where to cut, or nothing when a leaf is better.
    fn choose(&self, context: &Context<Self::Config>, place: &Place) -> Option<Cut>;

    /// The contents below and above. Nothing when the rule discards the cut after all.
    fn divide(self, context: &Context<Self::Config>, place: &Place, cut: Cut) -> Result<(Self, Self), Self>;

    /// Whether this content, new from a division, may be divided further.
    fn may_divide(&self, _context: &Context<Self::Config>) -> bool {
        true
    }
}

/// Where in the tree a node is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub cell: Aabb,
    pub depth: u32,
    /// How many splits in a row have left a child with all triangles of its parent.
    stalled: u32,
    /// References that the leaves below this node may hold together.
    budget: f64,
}

/// A tree that grows depth first.
pub(crate) trait Tree<C>: Default + Send {
    /// Whether leaves without triangles are left out, and the nodes that had one.
    const SKIPS_EMPTY: bool;

    fn len(&self) -> usize;

    fn leaf(&mut self, content: C);

    /// Appends an inner node, whose children are not known yet.
    fn open(&mut self);

    /// The node `inner` is cut; everything below the second child begins with the node `second`, and its last is the
    /// last there is.
    fn close(&mut self, inner: usize, cut: Cut, second: usize);

    /// Adds the nodes of `other` behind these.
    fn append(&mut self, other: Self);
}

/// Both sides of a node with fewer references than this are grown by the same thread.
const PARALLEL: usize = 2048;

impl<'a, C> Context<'a, C> {
    pub fn new(mesh: &'a Mesh, rules: Rules, config: &'a C) -> Self {
        Self { mesh, rules, config, depth_cap: depth_cap(mesh.len()) }
    }
}

/// The greatest depth of a leaf: 8 + 1.3 log2 n (Pharr, Jakob, Humphreys).
const fn depth_cap(triangles: usize) -> u32 {
    // The logarithm is rounded up to a whole number: no library function decides about the shape of a tree.
    let log2 = usize::BITS - if triangles > 1 { triangles } else { 1 }.leading_zeros();
    8 + log2 * 13 / 10
}

/// That of the largest mesh.
pub(crate) const DEEPEST: u32 = depth_cap(u32::MAX as usize);
const _: () = assert!(DEEPEST == 49);

/// Grows the tree over `content` in the cell of the mesh. The result does not depend on the number of threads.
pub(crate) fn grow<C: Content, T: Tree<C>>(context: &Context<C::Config>, content: C) -> T {
    let mut tree = T::default();
    let place = Place::root(context, content.len());
    if !T::SKIPS_EMPTY || content.len() > 0 {
        subdivide(context, content, place, true, &mut tree);
    }
    tree
}

fn subdivide<C: Content, T: Tree<C>>(
    context: &Context<C::Config>,
    content: C,
    place: Place,
    may_divide: bool,
    tree: &mut T,
) {
    let count = content.len();
    let (cut, below, above) = match try_divide(context, content, &place, may_divide) {
        Ok(parts) => parts,
        Err(content) => return tree.leaf(content),
    };

    // Give each side its share of the references that are still allowed.
    let (below_cell, above_cell) = place.cell.cut(cut.axis, cut.plane);
    let stalled = if context.rules.is_progress(count, below.len(), above.len()) { 0 } else { place.stalled + 1 };
    let share = place.budget / (below.len() + above.len()).max(1) as f64;
    let child = |cell, len: usize| Place { cell, depth: place.depth + 1, stalled, budget: share * len as f64 };
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

/// The cut and both sides, or the content back when the node stays a leaf.
fn try_divide<C: Content>(
    context: &Context<C::Config>,
    content: C,
    place: &Place,
    may_divide: bool,
) -> Result<(Cut, C, C), C> {
    let count = content.len();
    if count == 0 || count <= context.rules.leaf || !may_divide || place.depth >= context.depth_cap {
        return Err(content);
    }
    let Some(cut) = content.choose(context, place) else { return Err(content) };
    let (below, above) = content.divide(context, place, cut)?;
    Ok((cut, below, above))
}

impl Place {
    /// Of `count` references to all triangles.
    pub fn root<C>(context: &Context<C>, count: usize) -> Self {
        let budget = f64::from(context.rules.duplication) * count as f64;
        Self { cell: context.mesh.bounds(), depth: 0, stalled: 0, budget }
    }

    /// Whether sides of these sizes stay within the budget.
    pub fn affords(&self, below: usize, above: usize) -> bool {
        (below + above) as f64 <= self.budget
    }

    /// Whether the rules take a cut that makes sides of these sizes of `count` clipped triangles.
    pub fn accepts<C>(&self, context: &Context<C>, count: usize, [below, above]: [usize; 2]) -> bool {
        let both = (below + above - count) as f64;
        let discarded = context.rules.threshold.is_some_and(|share| both >= f64::from(share) * count as f64);
        !discarded && self.affords(below, above)
    }

    /// Whether sides of these sizes are progress, or the lack of it may be had once more: not for the third time in a
    /// row.
    pub fn progresses<C>(&self, context: &Context<C>, count: usize, below: usize, above: usize) -> bool {
        context.rules.is_progress(count, below, above) || self.stalled < 2
    }
}

impl Rules {
    /// Whether neither side has all triangles of the node. The middle of a cell may also leave all of them in one half,
    /// but for those that reach into the other: the cell is smaller, and that is what such a rule is after.
    fn is_progress(&self, count: usize, below: usize, above: usize) -> bool {
        let most = if self.one_side_is_progress { below.min(above) } else { below.max(above) };
        most < count
    }
}
