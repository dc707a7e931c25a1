//! A simple binary BVH with one of several typical faults.

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
    /// Some deep leaves lose their triangles.
    LeafDropped,
    /// The far child is skipped after a hit in the near child.
    ChildOrder,
    /// A hit does not shorten the ray interval. A farther hit can replace a nearer hit.
    StaleTMax,
    /// A box is missed if a slab distance is 0 times infinity.
    ZeroTimesInfinity,
    LastTriangle,
    /// Two hits at the same depth cancel each other.
    Ties,
    /// The any-hit query ignores `t_max`.
    AnyHit,
    /// Hits with `t` below 0.001 are ignored.
    Epsilon,
    /// The primitive number of a hit is derived from the number of the leaf.
    WrongId,
    DegenerateBox,
    /// Nodes that do not fit on the stack are dropped.
    OverflowedStack,
    /// Rays parallel to a triangle hit the triangle at a NaN depth.
    NotANumber,
    /// Depths are 0.1 % too large.
    TOff,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(crate = "sahara::serde")]
pub struct FaultyConfig {
    pub fault: Fault,
}

/// Least and greatest corner of a box.
type Bounds = [Vec3; 2];

enum Node {
    Inner(Box<[(Bounds, Node); 2]>),
    /// The number of the leaf among all nodes in depth-first order, and the triangles of the leaf.
    Leaf(u32, Vec<u32>),
}

pub struct Faulty {
    mesh: Arc<Mesh>,
    root: Node,
    fault: Fault,
}

const LEAF: usize = 4;
const DEEP: usize = 6;
const STACK: usize = 10;

fn bounds(mesh: &Mesh, triangles: &[u32]) -> Bounds {
    let corners = || triangles.iter().flat_map(|&index| mesh.corners(index));
    [corners().fold(Vec3::INFINITY, Vec3::min), corners().fold(Vec3::NEG_INFINITY, Vec3::max)]
}

impl Node {
    /// `count` is the number of nodes built so far.
    fn new(mesh: &Mesh, fault: Fault, mut triangles: Vec<u32>, depth: usize, count: &mut u32) -> Self {
        let place = *count;
        *count += 1;
        if triangles.len() <= LEAF || depth > 40 {
            let is_dropped = fault == Fault::LeafDropped && depth > DEEP && place.is_multiple_of(50);
            return Self::Leaf(place, if is_dropped { vec![] } else { triangles });
        }
        let [low, high] = bounds(mesh, &triangles);
        let axis = (high - low).max_position();
        let centre = |index: &u32| mesh.corners(*index).iter().map(|corner| corner[axis]).sum::<f32>();
        triangles.sort_by(|one, other| centre(one).total_cmp(&centre(other)));
        let above = triangles.split_off(triangles.len() / 2);
        let child = |own: Vec<u32>| (bounds(mesh, &own), Self::new(mesh, fault, own, depth + 1, count));
        Self::Inner(Box::new([triangles, above].map(child)))
    }
}

impl Faulty {
    /// The `t` at the entry into a box. `None` if the ray misses the box.
    fn enters(&self, ray: &Ray, t_max: f32, [low, high]: Bounds) -> Option<f32> {
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
            // Round outward to keep hits at the border of the box.
            near = near.max(a.min(b) * (1.0 - 1e-6 * a.min(b).signum()));
            far = far.min(a.max(b) * (1.0 + 1e-6 * a.max(b).signum()));
        }
        let is_flat = self.fault == Fault::DegenerateBox && (high - low).min_element() <= 0.0;
        (near <= far && !is_flat).then_some(near)
    }

    /// The triangle test of Möller and Trumbore.
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

    fn traverse<'a>(&self, ray: &Ray, node: &'a Node, stack: usize, best: &mut Option<Hit>) {
        let children = match node {
            Node::Inner(children) => children,
            Node::Leaf(place, triangles) => {
                let last = usize::from(self.fault == Fault::LastTriangle && triangles.len() > 1);
                for &index in &triangles[..triangles.len() - last] {
                    let Some(t) = self.hit(ray, index) else { continue };
                    let id = if self.fault == Fault::WrongId { place % self.mesh.len() as u32 } else { index };
                    match best {
                        Some(old) if old.t == t && self.fault == Fault::Ties => *best = None,
                        Some(old) if old.t <= t && self.fault != Fault::StaleTMax => {}
                        _ => *best = Some(Hit::new(t, id)),
                    }
                }
                return;
            }
        };
        let end = |best: &Option<Hit>| match best {
            Some(hit) if self.fault != Fault::StaleTMax => hit.t,
            _ => ray.t_max,
        };
        let entered = |(own, child): &'a (Bounds, Node)| Some((self.enters(ray, end(best), *own)?, child));
        let mut entered: Vec<(f32, &Node)> = children.iter().filter_map(entered).collect();
        entered.sort_by(|one, other| one.0.total_cmp(&other.0));
        if stack == 0 && self.fault == Fault::OverflowedStack {
            entered.truncate(1);
        }
        let pushes = entered.len().saturating_sub(1);
        for (t, child) in entered {
            if t <= end(best) && !(best.is_some() && self.fault == Fault::ChildOrder) {
                self.traverse(ray, child, stack.saturating_sub(pushes), best);
            }
        }
    }
}

impl Accel for Faulty {
    type Config = FaultyConfig;

    const OBSERVED: Observed = Observed::NONE;

    fn build(mesh: &Arc<Mesh>, config: &FaultyConfig) -> Result<Self, BuildError> {
        let solid = (0..mesh.len() as u32).filter(|&index| !mesh.is_degenerate(index)).collect();
        let root = Node::new(mesh, config.fault, solid, 0, &mut 0);
        Ok(Self { mesh: Arc::clone(mesh), root, fault: config.fault })
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, _: &mut O) -> Option<Hit> {
        let mut best = None;
        if ray.is_valid() {
            self.traverse(ray, &self.root, STACK, &mut best);
        }
        best
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        let end = if self.fault == Fault::AnyHit { f32::INFINITY } else { ray.t_max };
        self.closest_hit(&Ray { t_max: end, ..*ray }, observer).is_some()
    }

    fn footprint(&self) -> Footprint {
        Footprint { other: size_of::<Self>(), ..Footprint::default() }
    }

    fn shape(&self) -> TreeShape {
        TreeShape { leaves: 1, references: self.mesh.len(), largest_leaf: self.mesh.len(), ..TreeShape::default() }
    }
}
