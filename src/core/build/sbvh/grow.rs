//! Builds an SBVH from the root down.

use super::config::{ALPHA, LEAF, OVERLAP_COST, SbvhConfig, Splits};
use super::object::cheapest_group;
use super::offer::{Context, Offer};
use super::spatial::{Slots, cheapest_cut};
use crate::build::binary_tree::{BinaryNode, BinaryTree, Content};
use crate::build::cut::Cut;
use crate::build::extent::Extent;
use crate::build::grouping::{Group, median};
use crate::build::part::{Part, at_plane, by_group};
use crate::build::reference::{PARALLEL, Reference};
use crate::geometry::Mesh;
use crate::triangle::BLOCK;

#[derive(Clone, Copy, Debug)]
struct Limits {
    depth: u32,
    /// The maximum total number of references in the leaves below the node.
    budget: f64,
}

#[derive(Clone, Copy)]
enum Split {
    Space(Cut),
    Set(Group),
}

/// The tree does not depend on the number of threads.
pub(crate) fn build(mesh: &Mesh, config: &SbvhConfig) -> BinaryTree {
    let context = Context::new(mesh, config);
    let root = Part::whole(mesh);
    let mut tree = BinaryTree::default();
    if !root.references.is_empty() {
        let budget = f64::from(config.duplication) * root.references.len() as f64;
        grow(&context, root, Limits { depth: 0, budget }, &mut tree, &mut Slots::new());
    }
    tree
}

/// Appends the subtree over `part`. Returns the subtree's cost, multiplied by the half area of the subtree's box.
fn grow(context: &Context, part: Part, limits: Limits, tree: &mut BinaryTree, slots: &mut Slots) -> f64 {
    let Part { references, extent } = part;
    let (area, count) = (extent.half_area(), references.len());
    let (own, first) = (tree.nodes.len(), tree.references.len());
    let Some((split, counts)) = choose(context, &references, extent, limits, slots) else {
        tree.references.extend(references.iter().map(|r| r.id()));
        let content = Content::Leaf { first: first as u32, count: count as u32 };
        tree.nodes.push(BinaryNode { bounds: extent.into(), content });
        return context.costs.box_leaf(area, count);
    };
    let [below, above] = match split {
        Split::Space(cut) => at_plane(context.mesh, references, cut, counts),
        Split::Set(group) => by_group(references, group, counts),
    };

    let share = limits.budget / (below.references.len() + above.references.len()) as f64;
    let child = |part: &Part| Limits { depth: limits.depth + 1, budget: share * part.references.len() as f64 };
    let (below_place, above_place) = (child(&below), child(&above));

    tree.nodes.push(BinaryNode { bounds: extent.into(), content: Content::Inner([0; 2]) });
    let (second, children) = if count < PARALLEL {
        let left = grow(context, below, below_place, tree, slots);
        let second = tree.nodes.len();
        (second, left + grow(context, above, above_place, tree, slots))
    } else {
        let mut other = BinaryTree::default();
        let (left, right) = rayon::join(
            || grow(context, below, below_place, tree, slots),
            || grow(context, above, above_place, &mut other, &mut Slots::new()),
        );
        let second = tree.nodes.len();
        tree.append(other);
        (second, left + right)
    };
    tree.nodes[own].content = Content::Inner([own as u32 + 1, second as u32]);
    let cost = context.costs.box_node(area, children);
    merge(context, tree, own, first, area, cost).unwrap_or(cost)
}

/// The split and the numbers of references on both sides. `None` if the node becomes a leaf.
fn choose(
    context: &Context,
    references: &[Reference],
    extent: Extent,
    limits: Limits,
    slots: &mut Slots,
) -> Option<(Split, [usize; 2])> {
    let (area, count) = (extent.half_area(), references.len());
    if count <= BLOCK && !context.is_large(area) {
        return None;
    }
    // In a large box, accept any split of a single block. `merge` undoes a split that is not cheaper than a leaf.
    let leaf_cost = if count <= BLOCK { f64::INFINITY } else { context.unsplit_cost(area, count) };
    let full = count > LEAF;
    if limits.depth < context.depth
        && let Some(offer) = cheapest(context, references, extent, limits.budget, slots)
        && (offer.cost < leaf_cost || full)
    {
        return Some((offer.split, offer.counts));
    }
    full.then(|| {
        let (group, counts) = median(references, BLOCK);
        (Split::Set(group), counts)
    })
}

fn cheapest(
    context: &Context,
    references: &[Reference],
    extent: Extent,
    budget: f64,
    slots: &mut Slots,
) -> Option<Offer<Split>> {
    let mut space = || cheapest_cut(context, references, extent, budget, slots).map(|o| o.map(Split::Space));
    let set = || cheapest_group(context, references, extent.half_area()).map(|o| o.map(Split::Set));
    match context.config.splits {
        Splits::Spatial => space(),
        Splits::Object => set(),
        Splits::SpatialAndObject => {
            let set = set();
            let overlap = set.as_ref().map(|o| o.sides[0].overlap(o.sides[1]));
            if overlap.is_some_and(|area| area <= f64::from(ALPHA) * context.root_area) {
                return set;
            }
            match (set, space()) {
                (Some(set), Some(space)) => {
                    let overlap = overlap_cost(context, references.len(), &set, &space);
                    Some(if space.cost < set.cost + overlap { space } else { set })
                }
                (set, space) => set.or(space),
            }
        }
    }
}

/// The extra cost of an object split whose boxes overlap. A ray through the overlap usually visits both boxes.
///
/// The extra cost is 0 if the spatial split adds more than `count / 16` references. This rule keeps more of the
/// budget for the nodes below. The extra cost is also 0 in small nodes, because references that a spatial split adds
/// there need additional blocks.
fn overlap_cost(context: &Context, count: usize, object: &Offer<Split>, spatial: &Offer<Split>) -> f64 {
    if count < 4 * BLOCK || spatial.counts.iter().sum::<usize>() > count + count / 16 {
        return 0.0;
    }
    let fewer = object.counts[0].min(object.counts[1]);
    f64::from(OVERLAP_COST) * context.costs.box_leaf(object.sides[0].overlap(object.sides[1]), fewer)
}

/// Merges the subtree at `own` into a leaf. Returns the cost of the leaf, multiplied by `area`. `None` if the
/// leaf would cost more than `cost` or be too large.
fn merge(context: &Context, tree: &mut BinaryTree, own: usize, first: usize, area: f64, cost: f64) -> Option<f64> {
    if tree.references.len() - first > 2 * LEAF {
        return None;
    }
    let mut ids = tree.references[first..].to_vec();
    ids.sort_unstable();
    ids.dedup();
    if ids.len() > LEAF || context.unsplit_cost(area, ids.len()) > cost {
        return None;
    }
    tree.references.truncate(first);
    tree.references.extend(&ids);
    tree.nodes.truncate(own + 1);
    tree.nodes[own].content = Content::Leaf { first: first as u32, count: ids.len() as u32 };
    Some(context.costs.box_leaf(area, ids.len()))
}
