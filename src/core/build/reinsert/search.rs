//! Searches for the best new sibling of a node.

use super::links::{Link, Links, NONE};
use crate::build::extent::Extent;

/// Maximum number of nodes that a search visits, without the path to the root.
const VISITS: usize = 512;

/// The search for a new sibling of one node: on its path to the root, and in the subtrees of the siblings of this path.
pub(super) struct Search<'a> {
    links: &'a Links,
    own: Extent,
    own_area: f64,
    /// The largest saving of area so far, with `target` as the sibling.
    best: f64,
    target: Option<u32>,
    /// Nodes whose subtrees may contain a better sibling, each with the area that the move saves above it.
    open: &'a mut Vec<(u32, f64)>,
    visits: usize,
}

impl<'a> Search<'a> {
    /// The best new sibling of `at` among the visited nodes, or `None` if no move saves area. `open` is a buffer.
    pub fn best(links: &'a Links, at: u32, open: &'a mut Vec<(u32, f64)>) -> Option<u32> {
        let Link { extent: own, area: own_area, parent, .. } = links[at];
        if parent == NONE || links[parent].parent == NONE {
            return None;
        }
        open.clear();
        Self { links, own, own_area, best: 0.0, target: None, open, visits: 0 }.climb(at, parent)
    }

    /// Climbs from `at` to the root and searches the subtrees beside the path.
    fn climb(mut self, at: u32, parent: u32) -> Option<u32> {
        let links = self.links;
        let mut saved = links[parent].area;
        let mut rest = Extent::EMPTY;
        let mut path = at;
        loop {
            let beside = links.sibling(path);
            self.descend(beside, saved);

            rest.grow(links[beside].extent);
            path = links[path].parent;
            if links[path].parent == NONE {
                return self.target;
            }
            // Offer `path` as the sibling. Its box without `at` is `rest`. `saved` includes the removed parent.
            if path != parent {
                saved += links[path].area - rest.half_area();
                self.offer(path, saved - rest.union(self.own).half_area());
            }
        }
    }

    /// Searches the subtree at `place`. `saved` is the area that the move saves above `place`.
    fn descend(&mut self, place: u32, saved: f64) {
        self.open.push((place, saved));
        while let Some((place, saved)) = self.open.pop() {
            if saved - self.own_area <= self.best || self.visits == VISITS {
                continue;
            }
            self.visits += 1;
            let link = &self.links[place];
            let gain = saved - link.extent.union(self.own).half_area();
            self.offer(place, gain);
            let below = gain + link.area;
            if !link.is_leaf() && below - self.own_area > self.best {
                self.open.extend(link.children.map(|child| (child, below)));
            }
        }
    }

    fn offer(&mut self, place: u32, gain: f64) {
        if gain > self.best {
            (self.best, self.target) = (gain, Some(place));
        }
    }
}
