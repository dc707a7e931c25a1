//! The orders in which closest-hit queries visit the children of a node.

use super::collapse::Collapse;

impl Collapse<'_> {
    /// For each octant of directions, the visiting order of the parts of `at`. The second result is the length of an
    /// order in bits.
    ///
    /// An order has three bits per lane. The lowest three bits contain the lane that is visited last. `lanes` yields
    /// the lane of each part, in the order of `Collapse::gather`.
    pub(super) fn orders<'b>(
        &self,
        at: u32,
        parts: usize,
        lanes: &mut impl Iterator<Item = &'b u32>,
    ) -> ([u32; 8], u32) {
        let Some([l, r]) = self.divided(at, parts) else {
            return ([*lanes.next().expect("a lane for each part"); 8], 3);
        };
        let ((left, left_bits), (right, right_bits)) = (self.orders(l.0, l.1, lanes), self.orders(r.0, r.1, lanes));
        let (axis, backward) = self.apart(l.0, r.0);
        let order = |octant: usize| {
            let right_first = backward != (octant >> axis & 1 == 1);
            if right_first {
                right[octant] << left_bits | left[octant]
            } else {
                left[octant] << right_bits | right[octant]
            }
        };
        (std::array::from_fn(order), left_bits + right_bits)
    }

    /// The axis on which the boxes of `l` and `r` are furthest apart. The flag is true if `r` has the smaller
    /// coordinates on this axis.
    fn apart(&self, l: u32, r: u32) -> (usize, bool) {
        let [l, r] = [l, r].map(|at| &self.tree.nodes[at as usize].bounds);
        let (up, down) = (r.min - l.max, l.min - r.max);
        let apart = up.max(down);
        let axis = (0..3).reduce(|a, b| if apart[b] > apart[a] { b } else { a }).unwrap_or(0);
        (axis, down[axis] > up[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::super::collapse::Part;
    use super::super::node::WIDTH;
    use super::*;
    use crate::build::Quality;
    use crate::build::check::soup;
    use crate::build::sah_cost::CostModel;
    use crate::build::sbvh::{SbvhConfig, Splits, build};

    fn gathered(collapse: &Collapse, at: u32, parts: usize, octant: usize, into: &mut Vec<Part>) {
        match collapse.divided(at, parts) {
            Some([l, r]) => {
                let (axis, backward) = collapse.apart(l.0, r.0);
                let right_first = backward != (octant >> axis & 1 == 1);
                for (at, parts) in if right_first { [r, l] } else { [l, r] } {
                    gathered(collapse, at, parts, octant, into);
                }
            }
            None => into.push(collapse.part(at)),
        }
    }

    #[test]
    fn orders_of_all_octants_at_once_are_those_of_one_after_the_other() {
        let tree = build(&soup(3000, 43), &SbvhConfig::new(Splits::SpatialAndObject, Quality::Balanced));
        let collapse = Collapse::new(&tree, &CostModel::new(1.0, 1.0, 0.0));
        let (mut stack, mut nodes) = (vec![collapse.root().unwrap()], 0);
        while let Some(part) = stack.pop() {
            let Part::Node(at) = part else { continue };
            let children = collapse.children(at);
            for (octant, order) in children.orders.into_iter().enumerate() {
                let lanes: Vec<usize> = (0..WIDTH).rev().map(|i| (order >> (3 * i) & 7) as usize).collect();
                let (used, empty) = lanes.split_at(children.parts().len());
                assert!(empty.iter().all(|&lane| lane < empty.len()), "empty lanes come after the last");
                let mut expected = vec![];
                gathered(&collapse, at, WIDTH, octant, &mut expected);
                assert_eq!(used.iter().map(|&lane| children.parts()[lane - empty.len()]).collect::<Vec<_>>(), expected);
            }
            stack.extend(children.parts());
            nodes += 1;
        }
        assert!(nodes > 50, "{nodes}");
    }
}
