//! A binary BVH with its own triangle test, as written in an afternoon, with one of the usual faults.

use std::sync::Arc;

use sahara::accel::{Accel, BuildError, Footprint, Observed, Observer, TreeShape};
use sahara::geometry::{Hit, Mesh, Ray};
use sahara::glam::Vec3;
use sahara::serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(crate = "sahara::serde", rename_all = "kebab-case")]
pub enum Fault {
    #[default]
    None,
    /// Leaves below a depth are missing.
    LeafDropped,
    /// The far child is skipped after a hit in the near one.
    ChildOrder,
    /// The interval does not end at the nearest hit so far, and the last hit counts.
    StaleTMax,
    /// A slab of 0 x infinity is NaN, and the box is missed.
    ZeroTimesInfinity,
    /// A leaf is traversed up to its last triangle, exclusively.
    LastTriangle,
    /// Two hits at one depth cancel each other.
    Ties,
    /// Any hit ignores the end of the interval.
    AnyHit,
    /// Hits nearer than a thousandth do not count.
    Epsilon,
    /// The place in the tree's order is returned instead of the number of the triangle.
    WrongId,
    /// Boxes without thickness are missed.
    DegenerateBox,
    /// The stack is too small, and nodes beyond it are dropped.
    OverflowedStack,
    /// A ray in the plane of a triangle hits it at a NaN depth.
    NotANumber,
    /// Depths are a thousandth too large.
    TOff,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(crate = "sahara::serde")]
pub struct FaultyConfig {
    pub fault: Fault,
}

enum Node {
    Inner([(Vec3, Vec3, usize); 2]),
    Leaf(Vec<u32>),
}

pub struct Faulty {
    mesh: Arc<Mesh>,
    nodes: Vec<Node>,
    fault: Fault,
}

const LEAF: usize = 4;
const DEEP: usize = 6;
const STACK: usize = 10;

impl Faulty {
    fn node(&mut self, mut triangles: Vec<u32>, depth: usize) -> usize {
        let place = self.nodes.len();
        if triangles.len() <= LEAF || depth > 40 {
            let is_dropped = self.fault == Fault::LeafDropped && depth > DEEP && place.is_multiple_of(50);
            self.nodes.push(Node::Leaf(if is_dropped { vec![] } else { triangles }));
            return place;
        }
        let (low, high) = self.bounds(&triangles);
        let axis = (high - low).max_position();
        let centre = |index: &u32| self.mesh.corners(*index).iter().map(|corner| corner[axis]).sum::<f32>();
        triangles.sort_by(|one, other| centre(one).total_cmp(&centre(other)));
        self.nodes.push(Node::Leaf(vec![]));
        let above = triangles.split_off(triangles.len() / 2);
        let children = [triangles, above].map(|own| {
            let (low, high) = self.bounds(&own);
            (low, high, self.node(own, depth + 1))
        });
        self.nodes[place] = Node::Inner(children);
        place
    }

    fn bounds(&self, triangles: &[u32]) -> (Vec3, Vec3) {
        let corners = || triangles.iter().flat_map(|&index| self.mesh.corners(index));
        (corners().fold(Vec3::INFINITY, Vec3::min), corners().fold(Vec3::NEG_INFINITY, Vec3::max))
    }

    /// The parameter at which the ray enters a box, if it does.
    fn enters(&self, ray: &Ray, t_max: f32, low: Vec3, high: Vec3) -> Option<f32> {
        let (mut near, mut far) = (ray.t_min.max(0.0), t_max);
        for axis in 0..3 {
            let inverse = 1.0 / ray.direction[axis];
            let [a, b] = [low, high].map(|side| (side[axis] - ray.origin[axis]) * inverse);
            if a.is_nan() || b.is_nan() {
                if self.fault == Fault::ZeroTimesInfinity {
                    return None;
                }
                continue;
            }
            // Rounded outwards: no triangle may be lost at the border of its box.
            near = near.max(a.min(b) * (1.0 - 1e-6 * a.min(b).signum()));
            far = far.min(a.max(b) * (1.0 + 1e-6 * a.max(b).signum()));
        }
        let is_flat = self.fault == Fault::DegenerateBox && (high - low).min_element() <= 0.0;
        (near <= far && !is_flat).then_some(near)
    }

    /// Möller and Trumbore's test.
    fn hit(&self, ray: &Ray, index: u32) -> Option<f32> {
        let [a, b, c] = self.mesh.corners(index);
        let (e, f) = (b - a, c - a);
        let p = ray.direction.cross(f);
        let determinant = e.dot(p);
        if determinant == 0.0 {
            return (self.fault == Fault::NotANumber && !self.mesh.is_degenerate(index)).then_some(f32::NAN);
        }
        let s = ray.origin - a;
        let q = s.cross(e);
        let [u, v, t] = [s.dot(p), ray.direction.dot(q), f.dot(q)].map(|x| x / determinant);
        let least = if self.fault == Fault::Epsilon { ray.t_min.max(1e-3) } else { ray.t_min.max(0.0) };
        let t = if self.fault == Fault::TOff { t * 1.001 } else { t };
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= least && t < ray.t_max).then_some(t)
    }

    fn traverse(&self, ray: &Ray, place: usize, stack: usize, best: &mut Option<Hit>) {
        match &self.nodes[place] {
            Node::Leaf(triangles) => {
                let count = triangles.len() - usize::from(self.fault == Fault::LastTriangle && triangles.len() > 1);
                for &index in &triangles[..count] {
                    let Some(t) = self.hit(ray, index) else { continue };
                    let id = if self.fault == Fault::WrongId { place as u32 % self.mesh.len() as u32 } else { index };
                    match best {
                        Some(old) if old.t == t && self.fault == Fault::Ties => *best = None,
                        Some(old) if old.t <= t && self.fault != Fault::StaleTMax => {}
                        _ => *best = Some(Hit::new(t, id)),
                    }
                }
            }
            Node::Inner(children) => {
                let end = |best: &Option<Hit>| match best {
                    Some(hit) if self.fault != Fault::StaleTMax => hit.t,
                    _ => ray.t_max,
                };
                let mut entered: Vec<(f32, usize)> = children
                    .iter()
                    .filter_map(|&(low, high, child)| Some((self.enters(ray, end(best), low, high)?, child)))
                    .collect();
                entered.sort_by(|one, other| one.0.total_cmp(&other.0));
                if entered.len() == 2 && stack == 0 && self.fault == Fault::OverflowedStack {
                    entered.pop();
                }
                let pushes = entered.len() - 1.min(entered.len());
                for (t, child) in entered {
                    let had = best.is_some();
                    if t <= end(best) && !(had && self.fault == Fault::ChildOrder) {
                        self.traverse(ray, child, stack.saturating_sub(pushes), best);
                    }
                }
            }
        }
    }

    fn closest(&self, ray: &Ray) -> Option<Hit> {
        let mut best = None;
        if ray.is_valid() && !self.mesh.is_empty() {
            self.traverse(ray, 0, STACK, &mut best);
        }
        best
    }
}

impl Accel for Faulty {
    type Config = FaultyConfig;

    const OBSERVED: Observed = Observed::NONE;

    fn build(mesh: &Arc<Mesh>, config: &FaultyConfig) -> Result<Self, BuildError> {
        let mut tree = Self { mesh: Arc::clone(mesh), nodes: vec![], fault: config.fault };
        let solid = (0..mesh.len() as u32).filter(|&index| !mesh.is_degenerate(index)).collect();
        tree.node(solid, 0);
        Ok(tree)
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, _: &mut O) -> Option<Hit> {
        self.closest(ray)
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, _: &mut O) -> bool {
        let end = if self.fault == Fault::AnyHit { f32::INFINITY } else { ray.t_max };
        self.closest(&Ray { t_max: end, ..*ray }).is_some()
    }

    fn footprint(&self) -> Footprint {
        Footprint { other: self.nodes.len() * size_of::<Node>(), ..Footprint::default() }
    }

    fn shape(&self) -> TreeShape {
        TreeShape { leaves: 1, references: self.mesh.len(), largest_leaf: self.mesh.len(), ..TreeShape::default() }
    }
}
