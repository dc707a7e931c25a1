//! Growing the tree.

use super::config::{SplitConfig, Splits};
use super::cost::{CostModel, Offer, WIDTH};
use super::divide::{Part, at_plane, by_group};
use super::object::{Group, cheapest_group, median};
use super::reference::Reference;
use super::spatial::{Cut, cheapest_cut};
use crate::geometry::Mesh;
use crate::structures::binary::{BinaryNode, BinaryTree, Content};

/// Nodes of at least this many references are worked on by several threads.
pub(super) const PARALLEL: usize = 4096;

/// References that one thread works on at a time.
pub(super) const CHUNK: usize = 2048;

/// Levels of splits that the heuristic chooses; below them nodes are halved, so that any input ends.
const DEPTH: u32 = 64;

/// What every step of a build knows.
pub(super) struct Context<'a> {
    pub mesh: &'a Mesh,
    pub config: &'a SplitConfig,
    pub costs: CostModel,
    root_area: f64,
}

/// Where in the tree a node is.
#[derive(Clone, Copy, Debug)]
struct Place {
    depth: u32,
    /// References that the leaves below this node may hold together.
    budget: f64,
}

#[derive(Clone, Copy)]
enum Split {
    Space(Cut),
    Set(Group),
}

/// The tree over the triangles of `mesh` that have an area. It does not depend on the number of threads.
///
/// Takes O(n log n) time and memory: no path is longer than 64 levels and those of halving a rest, and all leaves together
/// hold at most `config.duplication` times the triangles.
pub(crate) fn build(mesh: &Mesh, config: &SplitConfig) -> BinaryTree {
    let references = mesh.solid().map(|id| Reference { id, bounds: mesh.triangle_bounds(id) }).collect();
    let root = Part::new(references);
    let mut tree = BinaryTree::default();
    if root.references.is_empty() {
        return tree;
    }
    let context = Context { mesh, config, costs: CostModel::new(config), root_area: root.extent.half_area() };
    let budget = f64::from(config.duplication) * root.references.len() as f64;
    grow(&context, root, Place { depth: 0, budget }, &mut tree);
    tree
}

/// Appends the tree over `part`, its root first; what it costs.
fn grow(context: &Context, part: Part, place: Place, tree: &mut BinaryTree) -> f64 {
    let Part { references, extent } = part;
    let area = extent.half_area();
    let count = references.len();
    let leaf_cost = context.costs.leaf(area, count);
    let own = tree.nodes.len();
    let Some(split) = choose(context, &references, &Part { references: vec![], extent }, place) else {
        let first = tree.references.len() as u32;
        tree.references.extend(references.iter().map(|r| r.id));
        tree.nodes.push(BinaryNode { bounds: extent.into(), content: Content::Leaf { first, count: count as u32 } });
        return leaf_cost;
    };
    let [below, above] = match split {
        Split::Space(cut) => at_plane(context, references, cut),
        Split::Set(group) => by_group(references, group),
    };

    // Give each side its share of the references that are still allowed.
    let share = place.budget / (below.references.len() + above.references.len()) as f64;
    let child = |part: &Part| Place { depth: place.depth + 1, budget: share * part.references.len() as f64 };
    let (below_place, above_place) = (child(&below), child(&above));

    tree.nodes.push(BinaryNode { bounds: extent.into(), content: Content::Inner([own as u32 + 1, 0]) });
    let first = tree.references.len();
    let (second, children) = if count < PARALLEL {
        let left = grow(context, below, below_place, tree);
        let second = tree.nodes.len();
        (second, left + grow(context, above, above_place, tree))
    } else {
        let mut other = BinaryTree::default();
        let (left, right) =
            rayon::join(|| grow(context, below, below_place, tree), || grow(context, above, above_place, &mut other));
        let second = tree.nodes.len();
        append(tree, other);
        (second, left + right)
    };
    tree.nodes[own].content = Content::Inner([own as u32 + 1, second as u32]);
    let cost = context.costs.node(area, children);
    merge(context, tree, own, first, area, cost).unwrap_or(cost)
}

/// How to split; nothing when a leaf is better.
fn choose(context: &Context, references: &[Reference], whole: &Part, place: Place) -> Option<Split> {
    let (count, config) = (references.len(), context.config);
    if count <= WIDTH {
        return None;
    }
    let area = whole.extent.half_area();
    let offer = if place.depth < DEPTH { cheapest(context, references, whole, place) } else { None };
    match offer {
        Some(offer) if offer.cost < context.costs.leaf(area, count) || count > config.leaf as usize => {
            Some(offer.split)
        }
        _ => (count > config.leaf as usize).then(|| Split::Set(median(references, WIDTH))),
    }
}

/// The cheapest of the allowed splits.
fn cheapest(context: &Context, references: &[Reference], whole: &Part, place: Place) -> Option<Offer<Split>> {
    let bounds = whole.extent.into();
    let space = || {
        let Offer { cost, split, sides } = cheapest_cut(context, references, &bounds, place.budget)?;
        Some(Offer { cost, split: Split::Space(split), sides })
    };
    let set = || {
        let Offer { cost, split, sides } = cheapest_group(context, references, whole.extent.half_area())?;
        Some(Offer { cost, split: Split::Set(split), sides })
    };
    match context.config.splits {
        Splits::Spatial => space(),
        Splits::Object => set(),
        Splits::SpatialAndObject => {
            let set = set();
            let overlap = set.as_ref().map(|o| o.sides[0].overlap(o.sides[1]));
            if overlap.is_some_and(|area| area <= f64::from(context.config.alpha) * context.root_area) {
                return set;
            }
            super::cost::cheaper(set, space())
        }
    }
}

/// Makes the subtree at `own` one leaf where that is cheaper; what it costs then.
fn merge(context: &Context, tree: &mut BinaryTree, own: usize, first: usize, area: f64, cost: f64) -> Option<f64> {
    let most = context.config.leaf as usize;
    if tree.references.len() - first > 2 * most {
        return None;
    }
    let mut ids = tree.references[first..].to_vec();
    ids.sort_unstable();
    ids.dedup();
    let leaf_cost = context.costs.leaf(area, ids.len());
    if ids.len() > most || leaf_cost > cost {
        return None;
    }
    tree.references.truncate(first);
    tree.references.extend(&ids);
    tree.nodes.truncate(own + 1);
    tree.nodes[own].content = Content::Leaf { first: first as u32, count: ids.len() as u32 };
    Some(leaf_cost)
}

/// Adds the nodes of `other` behind these.
fn append(tree: &mut BinaryTree, other: BinaryTree) {
    let (nodes, references) = (tree.nodes.len() as u32, tree.references.len() as u32);
    tree.nodes.extend(other.nodes.into_iter().map(|node| {
        let content = match node.content {
            Content::Inner(children) => Content::Inner(children.map(|child| child + nodes)),
            Content::Leaf { first, count } => Content::Leaf { first: first + references, count },
        };
        BinaryNode { content, ..node }
    }));
    tree.references.extend(other.references);
}
