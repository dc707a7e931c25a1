//! Where a node would be better off.

use super::links::{Link, Links, NONE};
use crate::build::extent::Extent;

/// Places that the search for a move looks at.
const VISITS: usize = 512;

/// The search for a better place for one node: looks along the path to the root, and below what lies beside it.
pub(super) struct Search<'a> {
    links: &'a Links,
    own: Extent,
    own_area: f64,
    /// The most that any place so far saves, and that place.
    best: f64,
    target: Option<u32>,
    /// Nodes below which there may be better places, and what is saved above them.
    open: &'a mut Vec<(u32, f64)>,
    visits: usize,
}

impl<'a> Search<'a> {
    /// The node beside which `at` saves most area, if any place does. `open` is lent for its memory.
    pub fn best(links: &'a Links, at: u32, open: &'a mut Vec<(u32, f64)>) -> Option<u32> {
        let Link { extent: own, area: own_area, parent, .. } = links[at];
        if parent == NONE || links[parent].parent == NONE {
            return None;
        }
        open.clear();
        Self { links, own, own_area, best: 0.0, target: None, open, visits: 0 }.climb(at, parent)
    }

    /// Goes up from `at`; what lies beside the path is searched, knowing what the removal saves on the path up to
    /// there.
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
            // Beside what is left of a node above; the parent is gone, which is counted from the start.
            if path != parent {
                saved += links[path].area - rest.half_area();
                self.offer(path, saved - rest.union(self.own).half_area());
            }
        }
    }

    /// Looks at `place` and below, where `saved` is what is saved above it.
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
