//! [kdtree-ray](https://github.com/flomonster/kdtree-ray) 1.2 (crate `kdtree-ray`): a SAH KD-tree after Wald and Havran (2006).
//!
//! The crate has no triangle test and no nearest hit: it returns the numbers of all triangles in all leaves whose boxes the
//! line meets, sorted, and leaves the rest to its caller. So there is no early termination to honour in the walk; any hit
//! stops at the first triangle that is hit. It computes its inverse direction itself, inside of the timed region. Its builder
//! starts a pool of all processors, whatever the caller wants, and panics on an empty scene.

use std::borrow::Cow;
use std::fmt::{self, Write};
use std::sync::{Arc, OnceLock};

use ::kdtree_ray::{AABB, Bounded, BuilderConfig, KDTree};
use cgmath::Vector3;
use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::leaves::{Leaves, Start};
use super::prepared::{Prepare, Prepared};
use crate::accel::{Accel, BuildError, Footprint, Loaded, Observed, Observer, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};
use crate::triangle::TriangleTest;

/// The KD-tree of the crate `kdtree-ray` over the triangle test `T`.
pub struct KdTreeRay<T: TriangleTest> {
    /// Nothing when there is no triangle.
    tree: Option<KDTree>,
    leaves: Leaves<T>,
    /// Read when it is asked for.
    shape: OnceLock<TreeShape>,
}

/// The parameters of its surface area heuristic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KdTreeRayConfig {
    /// Cost of an inner node; above 0. Default 15, the crate's.
    pub cost_traversal: f32,
    /// Cost of a triangle; above 0. Default 20, the crate's.
    pub cost_intersection: f32,
    /// Share of the cost that a plane saves which cuts off empty space; 0 to 1. Default 0.2, the crate's.
    pub empty_cut_bonus: f32,
}

impl Default for KdTreeRayConfig {
    fn default() -> Self {
        let crates = BuilderConfig::default();
        Self {
            cost_traversal: crates.cost_traversal(),
            cost_intersection: crates.cost_intersection(),
            empty_cut_bonus: crates.empty_cut_bonus(),
        }
    }
}

impl KdTreeRayConfig {
    fn checked(&self) -> Result<BuilderConfig, BuildError> {
        let positive = |x: f32| x > 0.0 && x.is_finite();
        if !positive(self.cost_traversal) || !positive(self.cost_intersection) {
            return Err(BuildError::Config("cost_traversal and cost_intersection must be above 0".into()));
        }
        if !(0.0..=1.0).contains(&self.empty_cut_bonus) {
            return Err(BuildError::Config("empty_cut_bonus must lie between 0 and 1".into()));
        }
        Ok(BuilderConfig::new(self.cost_traversal, self.cost_intersection, self.empty_cut_bonus))
    }
}

/// What its builder wants of a shape.
struct Boxed([Vec3; 2]);

impl Bounded for Boxed {
    fn bound(&self) -> AABB {
        let [min, max] = self.0.map(vector);
        AABB::new(min, max)
    }
}

fn vector(v: Vec3) -> Vector3<f32> {
    Vector3::new(v.x, v.y, v.z)
}

/// A ray as the crate and the triangle test want it.
pub(crate) struct Ready<T: TriangleTest> {
    origin: Vector3<f32>,
    direction: Vector3<f32>,
    start: Start<T>,
}

impl<T: TriangleTest> KdTreeRay<T> {
    #[inline]
    fn query<const ANY: bool, O: Observer>(&self, ready: &Ready<T>, observer: &mut O) -> Option<Hit> {
        let Ready { origin, direction, start } = ready;
        let mut nearest = start.nearest();
        for index in self.tree.as_ref()?.intersect(origin, direction) {
            observer.test(1);
            self.leaves.test(index, start, &mut nearest);
            if ANY && nearest.found() {
                break;
            }
        }
        nearest.hit()
    }
}

impl<T: TriangleTest> Prepare for KdTreeRay<T> {
    type Ready = Ready<T>;

    #[inline(always)]
    fn ready(&self, ray: &Ray) -> Option<Ready<T>> {
        let start = Start::new(ray)?;
        Some(Ready { origin: vector(ray.origin), direction: vector(ray.direction), start })
    }

    #[inline]
    fn closest<O: Observer>(&self, ready: &Ready<T>, observer: &mut O) -> Option<Hit> {
        self.query::<false, O>(ready, observer)
    }

    #[inline]
    fn any<O: Observer>(&self, ready: &Ready<T>, observer: &mut O) -> bool {
        self.query::<true, O>(ready, observer).is_some()
    }
}

impl<T: TriangleTest> Accel for KdTreeRay<T> {
    type Config = KdTreeRayConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;
    const OBSERVED: Observed = Observed::TESTS;
    const CONVENTIONS: &'static [&'static str] = &[
        "walks the whole line: every candidate is collected before the first is tested",
        "builds on all processors, whatever --threads says",
    ];

    fn build(mesh: &Arc<Mesh>, config: &KdTreeRayConfig) -> Result<Self, BuildError> {
        let config = config.checked()?;
        let leaves = Leaves::new(mesh);
        let boxes: Vec<Boxed> = leaves.boxes(mesh).map(Boxed).collect();
        let tree = (!boxes.is_empty()).then(|| KDTree::build_config(&boxes, &config));
        Ok(Self { tree, leaves, shape: OnceLock::new() })
    }

    #[inline]
    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        self.closest(&self.ready(ray)?, observer)
    }

    #[inline]
    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        self.ready(ray).is_some_and(|ready| self.any(&ready, observer))
    }

    fn load<'a>(&'a self, rays: Cow<'a, [Ray]>) -> Box<dyn Loaded + 'a> {
        Box::new(Prepared::new(self, &rays))
    }

    /// Nodes by the layout of the crate's enum, which it does not export.
    fn footprint(&self) -> Footprint {
        let shape = Accel::shape(self);
        let (triangles, ids) = self.leaves.bytes();
        let nodes = (shape.inner + shape.leaves) * NODE_BYTES;
        Footprint { nodes, references: shape.references * size_of::<usize>() + ids, triangles, other: 0 }
    }

    /// Read from the crate's debug text, the only form in which it shows its tree.
    fn shape(&self) -> TreeShape {
        *self.shape.get_or_init(|| match &self.tree {
            None => TreeShape { leaves: 1, empty: 1, ..TreeShape::default() },
            Some(tree) => {
                let mut reader = Reader::default();
                write!(reader, "{tree:?}").expect("a reader takes all");
                reader.shape()
            }
        })
    }
}

/// Two child numbers and two boxes.
const NODE_BYTES: usize = 2 * size_of::<usize>() + 2 * size_of::<AABB>();

/// Counts what a tree writes about its nodes, without keeping the text.
#[derive(Default)]
struct Reader {
    shape: TreeShape,
    /// Triangles of the leaf that is being written; nothing between leaves.
    leaf: Option<usize>,
    /// The field whose value comes next.
    field: Field,
    /// Depth of the whole tree, as the crate counts it: in nodes.
    depth: usize,
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Field {
    #[default]
    Other,
    Depth,
}

impl Write for Reader {
    fn write_str(&mut self, piece: &str) -> fmt::Result {
        match (piece, &mut self.leaf) {
            ("Node", _) => self.shape.inner += 1,
            ("Leaf", leaf) => *leaf = Some(0),
            ("]", leaf) => {
                if let Some(count) = leaf.take() {
                    self.shape.leaves += 1;
                    self.shape.empty += usize::from(count == 0);
                    self.shape.references += count;
                    self.shape.largest_leaf = self.shape.largest_leaf.max(count);
                }
            }
            ("depth", _) => self.field = Field::Depth,
            (number, leaf) if number.bytes().all(|b| b.is_ascii_digit()) && !number.is_empty() => match leaf {
                Some(count) => *count += 1,
                None if self.field == Field::Depth => self.depth = number.parse().unwrap_or(0),
                None => {}
            },
            _ => {}
        }
        Ok(())
    }
}

impl Reader {
    fn shape(self) -> TreeShape {
        TreeShape { depth: self.depth.saturating_sub(1), ..self.shape }
    }
}
