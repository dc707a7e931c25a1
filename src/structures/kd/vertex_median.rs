//! The report's plane rule: the median of the vertex coordinates, sides decided by whole triangles.

use super::build::{Content, Context, Cut, Place};
use super::config::{AxisRule, CountOf, Equal, Median, Stop};

/// The triangles of a node, ascending.
pub(super) struct Triangles {
    ids: Vec<u32>,
    /// How many of them went to the sibling as well.
    matches: usize,
}

impl Triangles {
    pub fn all(context: &Context) -> Self {
        Self { ids: context.mesh.solid().collect(), matches: 0 }
    }

    fn median(&self, context: &Context, axis: usize) -> f32 {
        let corners = self.ids.iter().flat_map(|&id| context.mesh.triangles()[id as usize]);
        let coordinate = |i: u32| context.mesh.positions()[i as usize][axis];
        let mut values: Vec<f32> = if context.config.median == Median::Welded {
            // A point counts once, however many corners lie in it; adding 0.0 makes -0.0 and 0.0 one.
            let bits = |i: u32| context.mesh.positions()[i as usize].to_array().map(|x| (x + 0.0).to_bits());
            let mut points: Vec<([u32; 3], u32)> = corners.map(|i| (bits(i), i)).collect();
            points.sort_unstable();
            points.dedup_by_key(|point| point.0);
            points.into_iter().map(|(_, i)| coordinate(i)).collect()
        } else {
            corners.map(coordinate).collect()
        };

        let (middle, even) = ((values.len() - 1) / 2, values.len().is_multiple_of(2));
        let (_, &mut lower, rest) = values.select_nth_unstable_by(middle, f32::total_cmp);
        match rest.iter().copied().min_by(f32::total_cmp) {
            Some(upper) if even && context.config.median == Median::Mean => lower * 0.5 + upper * 0.5,
            _ => lower,
        }
    }
}

impl Content for Triangles {
    fn len(&self) -> usize {
        self.ids.len()
    }

    fn ids(&self) -> impl Iterator<Item = u32> {
        self.ids.iter().copied()
    }

    fn choose(&self, context: &Context, place: &Place) -> Option<Cut> {
        let axis = match context.config.axis {
            AxisRule::Cyclic => (place.depth % 3) as usize,
            AxisRule::Longest => place.cell.longest_axis(),
        };
        Some(Cut { axis, split: self.median(context, axis), planar_below: true })
    }

    fn divide(self, context: &Context, place: &Place, cut: Cut) -> Result<(Self, Self), Self> {
        let (mut below, mut above, mut matches) = (vec![], vec![], 0);
        for &id in &self.ids {
            let corners = context.mesh.corners(id).map(|p| p[cut.axis]);
            let all_below = match context.config.equal {
                Equal::Both => corners.iter().all(|&x| x < cut.split),
                Equal::Below => corners.iter().all(|&x| x <= cut.split),
            };
            let all_above = corners.iter().all(|&x| x > cut.split);
            if !all_above {
                below.push(id);
            }
            if !all_below {
                above.push(id);
            }
            matches += usize::from(!all_above && !all_below);
        }

        let config = context.config;
        let discarded = config.stop == Stop::Report
            && config.count == CountOf::Parent
            && matches as f64 >= f64::from(config.threshold) * self.ids.len() as f64;
        let (b, a) = (below.len(), above.len());
        if discarded || !place.affords(b, a) || !place.progresses(self.ids.len(), b, a) {
            return Err(self);
        }
        Ok((Self { ids: below, matches }, Self { ids: above, matches }))
    }

    fn may_divide(&self, context: &Context) -> bool {
        let config = context.config;
        config.stop != Stop::Report
            || config.count == CountOf::Parent
            || (self.matches as f64) < f64::from(config.threshold) * self.ids.len() as f64
    }
}
