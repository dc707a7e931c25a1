// A deliberately naive uniform grid, as an example of a structure in another crate.
use std::sync::Arc;

use sahara::accel::{Accel, BuildError, Footprint, Observer, TreeShape};
use sahara::geometry::{Aabb, Hit, Mesh, Ray};
use sahara::glam::{DVec3, Vec3};
use sahara::serde::{Deserialize, Serialize};
use sahara::triangle::{Depth, TriangleTest};

/// Cells of equal size. Each cell lists the triangles whose boxes overlap the cell.
pub struct Grid<T: TriangleTest> {
    origin: DVec3,
    cell: DVec3,
    resolution: usize,
    cells: Vec<Vec<u32>>,
    triangles: Vec<T::Block<1>>,
}

/// The options of the grid, as in `--structure grid:resolution=32`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(crate = "sahara::serde", deny_unknown_fields)]
pub struct GridConfig {
    /// The number of cells along each axis, from 1 to 256.
    pub resolution: usize,
}

impl Default for GridConfig {
    fn default() -> Self {
        Self { resolution: 16 }
    }
}

impl<T: TriangleTest> Grid<T> {
    /// The first and the last cell along `axis` that overlap the interval from `low` to `high`.
    ///
    /// The slack is larger than the rounding errors of `f64`.
    fn cells_between(&self, axis: usize, low: f64, high: f64) -> Option<[usize; 2]> {
        let slack = 1e-12 * (low.abs().max(high.abs()) + self.origin[axis].abs() + self.cell[axis]);
        let index = |x: f64| ((x - self.origin[axis]) / self.cell[axis]).floor();
        let (first, last, end) = (index(low - slack), index(high + slack), self.resolution as f64);
        // Coordinates on the far face of the grid belong to the last cell.
        (last >= 0.0 && first <= end).then(|| [first, last].map(|x| x.clamp(0.0, end - 1.0) as usize))
    }

    /// The indices of the cells in the ranges `xs`, `ys` and `zs`.
    fn block(&self, [xs, ys, zs]: [[usize; 2]; 3]) -> impl Iterator<Item = usize> + use<T> {
        let n = self.resolution;
        let rows = (zs[0]..=zs[1]).flat_map(move |z| (ys[0]..=ys[1]).map(move |y| (z * n + y) * n));
        rows.flat_map(move |row| (xs[0]..=xs[1]).map(move |x| row + x))
    }

    /// Visits the layers of cells perpendicular to the main axis of the ray, nearest layer first.
    ///
    /// In each layer, tests the triangles of the cells that the ray may touch.
    fn walk<const ANY: bool, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        if !ray.is_valid() {
            return None;
        }
        let prepared = T::prepare(ray);
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let (t_min, t_max) = ray.interval();
        let main = direction.abs().max_position();
        let plane = |i: usize| {
            let x = self.origin[main] + self.cell[main] * i as f64;
            let slack = 1e-12 * (x.abs() + origin[main].abs() + self.cell[main]) / direction[main].abs();
            let t = (x - origin[main]) / direction[main];
            [t - slack, t + slack]
        };

        let mut nearest: Option<(T::Depth<'_>, u32)> = None;
        for step in 0..self.resolution {
            let layer = if direction[main] > 0.0 { step } else { self.resolution - 1 - step };
            let ([a, b], [c, d]) = (plane(layer), plane(layer + 1));
            let (enter, leave) = (a.min(c).max(t_min.into()), b.max(d).min(t_max.into()));
            // Stop at a layer that begins behind the nearest hit.
            if nearest.is_some_and(|(depth, _)| f64::from(depth.bound()) < enter) {
                break;
            }
            let mut ranges = [[layer; 2]; 3];
            let touched = enter <= leave
                && (0..3).filter(|&axis| axis != main).all(|axis| {
                    let [p, q] = [enter, leave].map(|t| origin[axis] + direction[axis] * t);
                    let slack = 1e-12 * (origin[axis].abs() + p.abs().max(q.abs()));
                    let between = self.cells_between(axis, p.min(q) - slack, p.max(q) + slack);
                    between.inspect(|range| ranges[axis] = *range).is_some()
                });
            for cell in self.block(ranges).filter(|_| touched).map(|at| &self.cells[at]) {
                observer.leaf(cell.len() as u32);
                observer.test(cell.len() as u32);
                for &id in cell {
                    let hit = T::hit(&prepared, &self.triangles[id as usize], t_min, T::last(t_max));
                    let Some(depth) = hit else { continue };
                    // At equal depth, the lowest triangle number wins.
                    if nearest.is_none_or(|(n, i)| T::order(&prepared, &depth, &n).then(id.cmp(&i)).is_lt()) {
                        nearest = Some((depth, id));
                    }
                }
            }
            if ANY && nearest.is_some() {
                break;
            }
        }
        nearest.map(|(depth, id)| Hit::new(depth.t(ray), id))
    }
}

impl<T: TriangleTest> Accel for Grid<T> {
    type Config = GridConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, config: &GridConfig) -> Result<Self, BuildError> {
        let resolution = config.resolution;
        if !(1..=256).contains(&resolution) {
            return Err(BuildError::Config("resolution must be from 1 to 256".into()));
        }
        let bounds = if mesh.is_empty() { Aabb::of_points([Vec3::ZERO]) } else { mesh.bounds() };
        let (origin, size) = (bounds.min.as_dvec3(), bounds.max.as_dvec3() - bounds.min.as_dvec3());
        // `max` gives the cells of a flat box a positive size.
        let cell = (size / resolution as f64).max(DVec3::splat(size.max_element().max(1e-300) * 1e-6));
        let triangles = (0..mesh.len() as u32).map(|id| T::block(&[mesh.corners(id)])).collect();
        let cells = vec![vec![]; resolution.pow(3)];
        let mut grid = Self { origin, cell, resolution, cells, triangles };
        for id in mesh.solid() {
            let bounds = mesh.triangle_bounds(id);
            let range = |axis: usize| grid.cells_between(axis, bounds.min[axis].into(), bounds.max[axis].into());
            let ranges = [0, 1, 2].map(|axis| range(axis).expect("a triangle lies in the grid"));
            for at in grid.block(ranges) {
                grid.cells[at].push(id);
            }
        }
        Ok(grid)
    }

    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        self.walk::<false, O>(ray, observer)
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        self.walk::<true, O>(ray, observer).is_some()
    }

    fn footprint(&self) -> Footprint {
        let references = self.cells.iter().map(Vec::len).sum::<usize>() * size_of::<u32>();
        let (nodes, triangles) = (size_of_val(&self.cells[..]), size_of_val(&self.triangles[..]));
        Footprint { nodes, references, triangles, other: 0 }
    }

    fn shape(&self) -> TreeShape {
        let full = || self.cells.iter().map(Vec::len);
        let (leaves, empty) = (self.cells.len(), full().filter(|&n| n == 0).count());
        let (references, largest_leaf) = (full().sum(), full().max().unwrap_or(0));
        TreeShape { leaves, empty, references, largest_leaf, ..TreeShape::default() }
    }
}
