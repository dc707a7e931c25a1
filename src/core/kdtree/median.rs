//! Splits nodes at a median or at the middle of the cell. Triangles are not clipped to the cell.

use super::config::{AxisRule, CountOf, Equal, KdConfig, Median, Plane};
use crate::build::cells::{Content, Context, NodeState};
use crate::build::cut::Cut;
use crate::build::sah_cost::SideAreas;

pub(super) struct Triangles {
    ids: Vec<u32>,
    /// The number of triangles that are also in the sibling.
    matches: usize,
}

impl Triangles {
    pub fn all(context: &Context<KdConfig>) -> Self {
        Self { ids: context.mesh.solid().collect(), matches: 0 }
    }

    fn plane(&self, context: &Context<KdConfig>, state: &NodeState, axis: usize) -> f32 {
        match context.config.plane {
            Plane::SpatialMedian => state.cell.min[axis] * 0.5 + state.cell.max[axis] * 0.5,
            Plane::CentroidMedian => middle(self.centroids(context, axis), context.config.median),
            _ => middle(self.coordinates(context, axis), context.config.median),
        }
    }

    fn centroids(&self, context: &Context<KdConfig>, axis: usize) -> Vec<f32> {
        let centroid = |&id| context.mesh.corners(id).map(|p| f64::from(p[axis])).iter().sum::<f64>() / 3.0;
        self.ids.iter().map(|id| centroid(id) as f32).collect()
    }

    fn coordinates(&self, context: &Context<KdConfig>, axis: usize) -> Vec<f32> {
        let corners = self.ids.iter().flat_map(|&id| context.mesh.triangles()[id as usize]);
        let coordinate = |i: u32| context.mesh.positions()[i as usize][axis];
        if context.config.median == Median::Welded {
            // Adding 0.0 makes the bits of -0.0 and 0.0 equal.
            let bits = |i: u32| context.mesh.positions()[i as usize].to_array().map(|x| (x + 0.0).to_bits());
            let mut points: Vec<([u32; 3], u32)> = corners.map(|i| (bits(i), i)).collect();
            points.sort_unstable();
            points.dedup_by_key(|point| point.0);
            points.into_iter().map(|(_, i)| coordinate(i)).collect()
        } else {
            corners.map(coordinate).collect()
        }
    }

    fn pays(&self, context: &Context<KdConfig>, state: &NodeState, cut: Cut, below: usize, above: usize) -> bool {
        // The median may lie outside the cell, because triangles are not clipped to the cell.
        let inside = state.cell.min[cut.axis] < cut.plane && cut.plane < state.cell.max[cut.axis];
        let (model, areas) = (context.config.costs(), SideAreas::new(&state.cell, cut.axis));
        inside && model.cell_split(&areas, cut.plane, [below, above]) < model.leaf(self.ids.len())
    }
}

/// The median of `values`, which must not be empty.
fn middle(mut values: Vec<f32>, rule: Median) -> f32 {
    let (middle, even) = ((values.len() - 1) / 2, values.len().is_multiple_of(2));
    let (_, &mut lower, rest) = values.select_nth_unstable_by(middle, f32::total_cmp);
    match rest.iter().copied().min_by(f32::total_cmp) {
        Some(upper) if even && rule == Median::Mean => lower * 0.5 + upper * 0.5,
        _ => lower,
    }
}

impl Content for Triangles {
    type Config = KdConfig;

    fn len(&self) -> usize {
        self.ids.len()
    }

    fn ids(&self) -> impl Iterator<Item = u32> {
        self.ids.iter().copied()
    }

    fn choose(&self, context: &Context<KdConfig>, state: &NodeState) -> Option<Cut> {
        let axis = match context.config.axis {
            AxisRule::Cyclic => (state.depth % 3) as usize,
            AxisRule::Longest => state.cell.longest_axis(),
        };
        Some(Cut { axis, plane: self.plane(context, state, axis), flat_below: true })
    }

    fn divide(self, context: &Context<KdConfig>, state: &NodeState, cut: Cut) -> Result<(Self, Self), Self> {
        let (mut below, mut above, mut matches) = (vec![], vec![], 0);
        for &id in &self.ids {
            let corners = context.mesh.corners(id).map(|p| p[cut.axis]);
            let all_below = match context.config.equal {
                Equal::Both => corners.iter().all(|&x| x < cut.plane),
                Equal::Below => corners.iter().all(|&x| x <= cut.plane),
            };
            let all_above = corners.iter().all(|&x| x > cut.plane);
            if !all_above {
                below.push(id);
            }
            if !all_below {
                above.push(id);
            }
            matches += usize::from(!all_above && !all_below);
        }

        let discarded = context.config.count == CountOf::Parent && context.rules.discards(matches, self.ids.len());
        let (b, a) = (below.len(), above.len());
        let too_expensive = context.rules.pays && !self.pays(context, state, cut, b, a);
        if discarded || too_expensive || !state.affords(b, a) || !state.progresses(context, self.ids.len(), b, a) {
            return Err(self);
        }
        Ok((Self { ids: below, matches }, Self { ids: above, matches }))
    }

    fn may_divide(&self, context: &Context<KdConfig>) -> bool {
        context.config.count == CountOf::Parent || !context.rules.discards(self.matches, self.ids.len())
    }
}
