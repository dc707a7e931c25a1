//! [bvh](https://github.com/svenstaro/bvh) 0.13 (crate `bvh`): a binary BVH, built by binned SAH, with one triangle per
//! leaf.
//!
//! The crate has no closest-hit query. `traverse_iterator` yields the triangles whose boxes the ray meets.
//! `PrunedRay` rejects boxes beyond the nearest hit so far. `traverse_iterator` may panic on trees deeper than 32
//! levels.

use std::cell::Cell;
use std::sync::Arc;

use ::bvh::aabb::{Aabb, Bounded, IntersectsAabb};
use ::bvh::bounding_hierarchy::{BHShape, BoundingHierarchy};
use ::bvh::bvh::{Bvh, BvhNode};
use ::bvh::ray::Ray as PreparedRay;
use glam::Vec3;
use nalgebra::{Point3, Vector3};

use super::leaves::{Leaves, Start};
use crate::accel::{Accel, BuildError, Footprint, Observed, Observer, Part, TreeShape};
use crate::external::lanes;
use crate::external::prepared::{Prepare, prepared_queries};
use crate::geometry::{self, Hit, Mesh, Ray};
use crate::simd::Lanes;
use crate::triangle::TriangleTest;
use crate::triangle::decided_at_once::decided_at_once;

/// The BVH of the crate `bvh` with the triangle test `T`.
pub struct SvenstaroBvh<T: TriangleTest> {
    tree: Bvh<f32, 3>,
    shapes: Vec<TriangleBox>,
    leaves: Leaves<T>,
}

struct TriangleBox {
    bounds: Aabb<f32, 3>,
    index: u32,
    node: usize,
}

impl Bounded<f32, 3> for TriangleBox {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.bounds
    }
}

impl BHShape<f32, 3> for TriangleBox {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

struct PrunedRay<'a> {
    ray: &'a PreparedRay<f32, 3>,
    /// Boxes beyond this distance are rejected. The distance is a `t` times the length of the direction times `SLACK`.
    limit: Cell<f32>,
}

impl IntersectsAabb<f32, 3> for PrunedRay<'_> {
    #[inline(always)]
    fn intersects_aabb(&self, bounds: &Aabb<f32, 3>) -> bool {
        let limit = self.limit.get();
        let is_near = || self.ray.intersection_slice_for_aabb(bounds).is_some_and(|(entry, _)| entry <= limit);
        self.ray.intersects_aabb(bounds) && (limit == f32::INFINITY || is_near())
    }
}

/// The limits of box tests are multiplied by this factor, to allow for the rounding errors of distances.
const SLACK: f32 = 1.0 + 8.0 * f32::EPSILON;

fn point(v: Vec3) -> Point3<f32> {
    Point3::new(v.x, v.y, v.z)
}

fn prepare(ray: &Ray) -> PreparedRay<f32, 3> {
    let d = ray.direction;
    PreparedRay::new(point(ray.origin), Vector3::new(d.x, d.y, d.z))
}

pub(crate) struct Ready<T: TriangleTest> {
    walked: PreparedRay<f32, 3>,
    length: f32,
    start: Start<T>,
}

impl<T: TriangleTest> Prepare for SvenstaroBvh<T> {
    type Ready = Ready<T>;

    #[inline(always)]
    fn ready(&self, ray: &Ray) -> Option<Ready<T>> {
        Start::new(ray).map(|start| Ready { walked: prepare(ray), length: ray.direction.length(), start })
    }

    #[inline]
    fn closest<O: Observer>(&self, ready: &Ready<T>, observer: &mut O) -> Option<Hit> {
        let Ready { walked, length, start } = ready;
        let mut nearest = start.nearest();
        let limit = |t: f32| t * length * SLACK;
        let query = PrunedRay { ray: walked, limit: Cell::new(limit(nearest.t)) };
        for shape in self.tree.traverse_iterator(&query, &self.shapes) {
            observer.test(1);
            self.leaves.test(shape.index as usize, start, &mut nearest);
            query.limit.set(limit(nearest.t));
        }
        nearest.answer::<false>(&start.original)
    }

    #[inline]
    fn any<O: Observer>(&self, ready: &Ready<T>, observer: &mut O) -> bool {
        let Ready { walked, length, start } = ready;
        let mut nearest = start.nearest();
        let query = PrunedRay { ray: walked, limit: Cell::new(nearest.t * length * SLACK) };
        self.tree.traverse_iterator(&query, &self.shapes).any(|shape| {
            observer.test(1);
            self.leaves.test(shape.index as usize, start, &mut nearest);
            nearest.found()
        })
    }
}

impl<T: TriangleTest> Accel for SvenstaroBvh<T> {
    type Config = ();

    const TRIANGLE_TEST: &'static str = T::NAME;
    const OBSERVED: Observed = Observed::TESTS;
    const CONVENTIONS: &'static [&'static str] =
        &["tests boxes with the unit direction, up to a distance of t times the direction's length"];

    fn build(mesh: &Arc<Mesh>, (): &()) -> Result<Self, BuildError> {
        let leaves = Leaves::new(mesh);
        let boxed = |(index, bounds): (usize, geometry::Aabb)| TriangleBox {
            bounds: Aabb::with_bounds(point(bounds.min), point(bounds.max)),
            index: index as u32,
            node: 0,
        };
        let mut shapes: Vec<TriangleBox> = leaves.boxes(mesh).enumerate().map(boxed).collect();
        let tree = Bvh::build_par(&mut shapes);
        Ok(Self { tree, shapes, leaves })
    }

    prepared_queries!();

    fn footprint(&self) -> Footprint {
        let leaves = self.leaves.footprint();
        let references = size_of_val(&self.shapes[..]) + leaves.references;
        Footprint { nodes: size_of_val(&self.tree.nodes[..]), references, ..leaves }
    }

    fn shape(&self) -> TreeShape {
        let bounds = |own: &Aabb<f32, 3>| {
            geometry::Aabb::of_points([own.min, own.max].map(|corner| Vec3::from(<[f32; 3]>::from(corner))))
        };
        // An inner node stores only the boxes of its children.
        let root = match self.tree.nodes.first() {
            None => geometry::Aabb::EMPTY,
            Some(BvhNode::Leaf { shape_index, .. }) => bounds(&self.shapes[*shape_index].bounds),
            Some(BvhNode::Node { child_l_aabb, child_r_aabb, .. }) => bounds(&child_l_aabb.join(child_r_aabb)),
        };
        TreeShape::of(Some((0, root)), |at: usize, _| match self.tree.nodes.get(at) {
            None => Part::Leaf(0),
            Some(BvhNode::Leaf { .. }) => Part::Leaf(1),
            Some(BvhNode::Node { child_l_index, child_l_aabb, child_r_index, child_r_aabb, .. }) => {
                Part::Inner(vec![(*child_l_index, bounds(child_l_aabb)), (*child_r_index, bounds(child_r_aabb))])
            }
        })
    }
}

/// The triangle test of the crate `bvh`: Möller-Trumbore with a unit direction and culling of back faces.
///
/// If the ray misses the front face, the triangle is tested again with two corners swapped. The `t` of a hit is the
/// distance divided by the length of the direction. The test misses if the magnitude of the determinant is below
/// [`f32::EPSILON`]. The test misses at distances up to [`f32::EPSILON`].
#[derive(Clone, Copy, Debug, Default)]
pub struct SvenstaroTest;

impl TriangleTest for SvenstaroTest {
    const NAME: &'static str = "bvh-triangle";

    type Ray = (PreparedRay<f32, 3>, f32);
    type Block<const N: usize> = [[Point3<f32>; 3]; N];

    decided_at_once!();

    #[inline(always)]
    fn prepare(ray: &Ray) -> Self::Ray {
        (prepare(ray), ray.direction.length())
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> Self::Block<N> {
        lanes::block(triangles, |corners| corners.map(point))
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(
        (ray, length): &Self::Ray,
        block: &Self::Block<N>,
        from: f32,
        to: f32,
    ) -> (u32, L) {
        lanes::candidates(from, to, |lane| {
            let [a, b, c] = &block[lane];
            let front = ray.intersects_triangle(a, b, c).distance;
            let nearer = if front < f32::INFINITY { front } else { ray.intersects_triangle(a, c, b).distance };
            nearer / length
        })
    }
}
