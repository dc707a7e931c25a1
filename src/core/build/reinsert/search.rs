//! Searches for the best new sibling of a node.

use super::links::{Link, Links, NONE};
use crate::build::extent::Extent;

/// Maximum number of nodes that a search visits, not counting the path to the root.
const VISITS: usize = 512;

pub(super) struct Search<'a> {
    links: &'a Links,
    own: Extent,
    own_area: f64,
    /// The largest saving of area so far.
    best: f64,
    /// The new sibling that gives the saving `best`.
    target: Option<u32>,
    /// Roots of subtrees that may contain a better sibling. The `f64` is the area that a move into the subtree saves
    /// outside the subtree.
    open: &'a mut Vec<(u32, f64)>,
    visits: usize,
}

impl<'a> Search<'a> {
    /// `None` if the search finds no move that saves area. `open` is a buffer that callers reuse.
    pub fn best(links: &'a Links, at: u32, open: &'a mut Vec<(u32, f64)>) -> Option<u32> {
        let Link { extent: own, area: own_area, parent, .. } = links[at];
        if parent == NONE || links[parent].parent == NONE {
            return None;
        }
        open.clear();
        Self { links, own, own_area, best: 0.0, target: None, open, visits: 0 }.climb(at, parent)
    }

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
            // Without `at`, the box of `path` is `rest`. `saved` already includes the area of `parent`.
            if path != parent {
                saved += links[path].area - rest.half_area();
                self.offer(path, saved - rest.union(self.own).half_area());
            }
        }
    }

    /// `saved` is the area that a move into the subtree of `place` saves outside this subtree.
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
