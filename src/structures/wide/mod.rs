//! Eight-wide trees of tight boxes.

mod collapse;
mod layout;
mod node;
mod traverse;

use std::sync::Arc;

use super::kd;
use super::leaf::LeafBlock;
use crate::accel::{Accel, BuildError, Footprint, Observer, TreeShape};
use crate::geometry::{Aabb, Hit, Mesh, Ray};
use crate::triangle::TriangleTest;
use collapse::{Collapse, Cost};
use layout::Layout;
use node::{Child, Node, WIDTH};

pub struct WideTree<T: TriangleTest> {
    root: Child,
    nodes: Vec<Node>,
    blocks: Vec<LeafBlock<T, WIDTH>>,
    bounds: Aabb,
}
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct WideConfig { pub block: f64, pub partition: Partition }
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub enum Partition { Cells(kd::KdConfig), Split(super::split::SplitConfig) }
impl Default for WideConfig { fn default() -> Self { Self { block: 0.6, partition: Partition::Cells(kd::KdConfig::SAH) } } }

impl<T: TriangleTest> Accel for WideTree<T> {
    type Config = WideConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, config: &WideConfig) -> Result<Self, BuildError> {
        let tree = match &config.partition { Partition::Cells(kd) => kd::partition(mesh, kd)?, Partition::Split(split) => super::split::build(mesh, split) };
        let collapse = Collapse::new(&tree, &Cost { node: 1.0, block: config.block, largest: 8 });
        let mut layout = Layout::<T>::new(mesh, &collapse);
        let root = if tree.nodes.is_empty() { Child::NOTHING } else { layout.write(collapse.root()) };
        Ok(Self { root, nodes: layout.nodes, blocks: layout.blocks, bounds: mesh.bounds() })
    }

    #[inline]
    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        self.query::<false, O>(ray, observer)
    }

    #[inline]
    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        self.query::<true, O>(ray, observer).is_some()
    }

    fn footprint(&self) -> Footprint {
        let (triangles, references) = LeafBlock::<T, WIDTH>::BYTES;
        let n = self.blocks.len();
        Footprint { nodes: size_of_val(&self.nodes[..]), triangles: n * triangles, references: n * references, other: size_of::<Self>() }
    }

    fn shape(&self) -> TreeShape { TreeShape::default() }
}
