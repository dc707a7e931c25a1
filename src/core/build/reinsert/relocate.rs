//! One move.

use super::links::{Links, NONE};

/// No move makes a path longer than this: nested boxes would be cheapest as a chain.
pub(super) const DEEPEST: u32 = 80;

impl Links {
    /// Moves `at` beside `target`, if that is still possible and still saves area.
    pub fn relocate(&mut self, at: u32, target: u32) {
        let (parent, sibling) = (self[at].parent, self.sibling(at));
        let grand = self[parent].parent;
        let (mut depth, mut up, mut inside) = (0, target, false);
        while up != NONE {
            inside |= up == at;
            (depth, up) = (depth + 1, self[up].parent);
        }
        let deepest = depth + self[at].height.max(self[target].height);
        if grand == NONE || target == parent || target == sibling || inside || deepest > DEEPEST {
            return;
        }

        // The parent moves with the node, to become the parent of the target.
        let old_area = self[parent].area;
        self.replace(grand, parent, sibling);
        let mut growth = self.refit(grand);
        let above = self[target].parent;
        self.replace(above, target, parent);
        self.join(parent, [target, at]);
        growth += self[parent].area - old_area + self.refit(above);
        if growth < 0.0 {
            return;
        }

        // Earlier moves have made it useless: undo it.
        self.replace(above, parent, target);
        self.refit(above);
        self.replace(grand, sibling, parent);
        self.join(parent, [sibling, at]);
        self.refit(grand);
    }
}
