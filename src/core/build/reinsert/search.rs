//! Searches for a better place for a node.

use super::links::{Link, Links, NONE};
use crate::build::extent::Extent;

/// Maximum number of places that a search visits.
const VISITS: usize = 512;

/// The search for a better place for one node: on the path to the root, and in the subtrees of the path's siblings.
pub(super) struct Search<'a> {
    links: &'a Links,
    own: Extent,
    own_area: f64,
    /// The largest saving of area so far; `target` is its place.
    best: f64,
    target: Option<u32>,
    /// Nodes whose subtrees may contain better places, and the area that is saved above each node.
    open: &'a mut Vec<(u32, f64)>,
    visits: usize,
}

impl<'a> Search<'a> {
    /// The best new sibling of `at` among the visited nodes; `None` if none saves area. `open` is only a buffer.
    pub fn best(links: &'a Links, at: u32, open: &'a mut Vec<(u32, f64)>) -> Option<u32> {
        let Link { extent: own, area: own_area, parent, .. } = links[at];
        if parent == NONE || links[parent].parent == NONE {
            return None;
        }
        open.clear();
        Self { links, own, own_area, best: 0.0, target: None, open, visits: 0 }.climb(at, parent)
    }

    /// Climbs from `at` and searches the siblings of the path; `saved` is the area saved so far by removing `at`.
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
            // Offer a place beside `path`, whose box without `at` is `rest`. `saved` includes the removed parent.
            if path != parent {
                saved += links[path].area - rest.half_area();
                self.offer(path, saved - rest.union(self.own).half_area());
            }
        }
    }

    /// Visits `place` and its subtree; `saved` is the area that is saved above `place`.
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
