//! Chooses split planes. A large node tries only a few planes. A small node tries a plane at each face
//! of the references' boxes.

use super::config::CellConfig;
use super::grow::{Content, Context, NodeState};
use super::sweep::{Events, PARALLEL};
use crate::build::axes::on_axes;
use crate::build::cut::Cut;
use crate::build::part::{Part, at_plane};
use crate::build::planes::{PLANES, Planes};
use crate::build::reference::Reference;
use crate::build::sah_cost::SideAreas;
use crate::build::sample::Sample;
use crate::geometry::Aabb;

/// The references of a node, in ascending order of triangle numbers.
pub(crate) enum Binned {
    Coarse(Part),
    Fine(Events),
}

/// `begin[i]` counts the references that begin in bin `i`. `end[i]` counts the references that end in bin `i`.
/// `flat[i]` counts the references that lie in plane `i`.
struct Counts {
    begin: [u32; PLANES + 1],
    end: [u32; PLANES + 1],
    flat: [u32; PLANES + 1],
}

impl Counts {
    fn of(sample: &Sample, planes: &Planes) -> Self {
        let mut counts = Self { begin: [0; PLANES + 1], end: [0; PLANES + 1], flat: [0; PLANES + 1] };
        for r in sample.iter() {
            let first = planes.first_bin(r.min(planes.axis));
            let last = planes.last_bin(r.max(planes.axis));
            if first > last {
                // The reference lies in the plane with the index `last`.
                counts.flat[last] += 1;
            } else {
                counts.begin[first] += 1;
                counts.end[last] += 1;
            }
        }
        counts
    }
}

impl Binned {
    pub fn all(context: &Context<CellConfig>) -> Self {
        Self::new(context, Part::whole(context.mesh))
    }

    pub fn into_part(self) -> Part {
        match self {
            Self::Coarse(part) => part,
            Self::Fine(events) => Part::new(events.references),
        }
    }

    fn references(&self) -> &[Reference] {
        match self {
            Self::Coarse(part) => &part.references,
            Self::Fine(events) => &events.references,
        }
    }

    fn new(context: &Context<CellConfig>, part: Part) -> Self {
        if part.references.len() <= context.config.exact as usize {
            Self::Fine(Events::new(part.references))
        } else {
            Self::Coarse(part)
        }
    }
}

fn cheapest(context: &Context<CellConfig>, part: &Part, sample: &Sample, state: &NodeState) -> Option<(f64, Cut)> {
    let found = on_axes(sample.len() >= PARALLEL, |axis| along(context, part, sample, state, axis));
    found.into_iter().flatten().reduce(|a, b| if b.0 < a.0 { b } else { a })
}

fn along(
    context: &Context<CellConfig>,
    part: &Part,
    sample: &Sample,
    state: &NodeState,
    axis: usize,
) -> Option<(f64, Cut)> {
    let (model, cell) = (&context.config.costs, &state.cell);
    let bounds = Aabb::from(part.extent);
    let range = (bounds.min[axis], bounds.max[axis]);
    let (areas, min, max) = (SideAreas::new(cell, axis), cell.min[axis], cell.max[axis]);
    let mut best: Option<(f64, Cut)> = None;
    let mut offer = |plane: f32, below: usize, above: usize, flat_below: bool| {
        // A plane on a face of the cell does not divide the cell.
        if min < plane && plane < max {
            // A plane strictly inside `range` has references on each side, even if the sample has none there.
            let least = usize::from(range.0 < plane && plane < range.1);
            let [below, above] = [below, above].map(|count| sample.scaled(count).max(least));
            let cost = model.cell_split(&areas, plane, [below, above]);
            if best.is_none_or(|(least, _)| cost < least) && state.affords(below, above) {
                best = Some((cost, Cut { axis, plane, flat_below }));
            }
        }
    };
    let count = sample.len();
    let candidates = (context.config.candidates as usize).min(count);
    let Some(planes) = Planes::new(axis, range, candidates, sample) else {
        // No grid: all references lie in one plane, or the range overflows. Only a common plane is tried.
        if range.0 == range.1 {
            offer(range.0, count, 0, true);
            offer(range.0, 0, count, false);
        }
        return best;
    };

    let counts = Counts::of(sample, &planes);
    let (mut below, mut above) = (0, count);
    for plane in 0..planes.bins() - 1 {
        let flat = counts.flat[plane] as usize;
        below += counts.begin[plane] as usize;
        above -= counts.end[plane] as usize + flat;
        if planes.is_new(plane) {
            offer(planes.value(plane), below + flat, above, true);
            if flat > 0 {
                offer(planes.value(plane), below, above + flat, false);
            }
        }
        below += flat;
    }
    best
}

impl Content for Binned {
    type Config = CellConfig;

    fn len(&self) -> usize {
        self.references().len()
    }

    fn ids(&self) -> impl Iterator<Item = u32> {
        self.references().iter().map(|r| r.id())
    }

    fn choose(&self, context: &Context<CellConfig>, state: &NodeState) -> Option<Cut> {
        let part = match self {
            Self::Coarse(part) => part,
            Self::Fine(events) => return events.choose(context, state),
        };
        let sample = Sample::new(&part.references, context.config.sample);
        let mut found = cheapest(context, part, &sample, state);
        if sample.len() < part.references.len() {
            // The counts from a sample are estimates. If `found` is `None`, or the exact counts exceed the budget,
            // search again with all references.
            let affords = |cut: Cut| {
                let [below, above] = cut.counts(&part.references);
                state.affords(below, above)
            };
            if !found.is_some_and(|(_, cut)| affords(cut)) {
                found = cheapest(context, part, &Sample::all(&part.references), state);
            }
        }
        let (cost, cut) = found?;
        let leaf = context.config.costs.leaf(part.references.len());
        (!context.rules.pays || cost < leaf).then_some(cut)
    }

    fn divide(self, context: &Context<CellConfig>, state: &NodeState, cut: Cut) -> Result<(Self, Self), Self> {
        let part = match self {
            Self::Coarse(part) => part,
            Self::Fine(events) => {
                let (below, above) = events.divide(context, state, cut).map_err(Self::Fine)?;
                return Ok((Self::Fine(below), Self::Fine(above)));
            }
        };
        let counts = cut.counts(&part.references);
        if !state.accepts(context, part.references.len(), counts) {
            return Err(Self::Coarse(part));
        }
        let [below, above] = at_plane(context.mesh, part.references, cut, counts);
        Ok((Self::new(context, below), Self::new(context, above)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    use crate::build::Quality;
    use crate::build::cells::Rules;
    use crate::build::check::{mesh, room, soup};
    use crate::build::sah_cost::CostModel;

    #[test]
    fn no_plane_is_cheaper_than_the_one_that_is_chosen() {
        for mesh in [soup(40, 1), soup(700, 2), room(5)] {
            let costs = CostModel::new(1.0, 0.7, 0.2);
            let config = CellConfig { costs, exact: 0, candidates: 32, sample: 16384 };
            let context = Context::new(&mesh, Rules::sah(8.0), &config);
            let Binned::Coarse(part) = Binned::all(&context) else { panic!("no node is exact") };
            let (model, cell) = (&config.costs, mesh.bounds());
            let (all, root) = (Sample::all(&part.references), NodeState::root(&context, mesh.len()));
            for axis in 0..3 {
                let (cost, _) = along(&context, &part, &all, &root, axis).unwrap();
                let bounds = Aabb::from(part.extent);
                let candidates = (config.candidates as usize).min(part.references.len());
                let range = (bounds.min[axis], bounds.max[axis]);
                let planes = Planes::new(axis, range, candidates, &all).unwrap();
                let areas = SideAreas::new(&cell, axis);
                let mut least = f64::INFINITY;
                for (i, flat_below) in (0..planes.bins() - 1).flat_map(|i| [(i, false), (i, true)]) {
                    let plane = planes.value(i);
                    if plane <= cell.min[axis] || plane >= cell.max[axis] {
                        continue;
                    }
                    let counts = Cut { axis, plane, flat_below }.counts(&part.references);
                    least = least.min(model.cell_split(&areas, plane, counts));
                }
                assert_eq!(cost, least);
            }
        }
    }

    /// The sample contains only the short triangles. A plane at any x between 0 and 1000 cuts all long
    /// triangles.
    #[test]
    fn a_cut_over_budget_is_searched_again_without_a_sample() {
        let stride = 20;
        let needles = mesh(512 * stride, |i| {
            let y = i as f32 * 1e-3;
            if i % stride == 0 {
                let x = if i / stride % 2 == 0 { 0.0 } else { 1000.0 };
                [Vec3::new(x, y, 0.0), Vec3::new(x + 1.0, y, 1.0), Vec3::new(x, y + 5e-4, 1.0)]
            } else {
                [Vec3::new(0.0, y, 0.0), Vec3::new(1000.0, y, 0.0), Vec3::new(0.0, y + 5e-4, 0.0)]
            }
        });
        let config = CellConfig { sample: 512, ..CellConfig::new(Quality::Fast) };
        let context = Context::new(&needles, Rules::sah(1.5), &config);
        let (all, root) = (Binned::all(&context), NodeState::root(&context, needles.len()));
        let cut = all.choose(&context, &root).expect("there are planes between the needles");
        assert_eq!(cut.axis, 1);
        assert!(all.divide(&context, &root, cut).is_ok());
    }
}
