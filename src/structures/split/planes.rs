//! The planes of one axis that a spatial split may take.

use super::reference::Reference;
use crate::geometry::Aabb;

/// At most this many planes, the two faces of the window included.
pub(super) const PLANES: usize = 66;

/// Ascending planes: the faces of a window and, in every cell of an even grid between them, the edge of a reference nearest to the
/// middle of the cell, or that middle where no edge is.
///
/// That a plane is an edge is what keeps walls whole: a plane beside a wall would cut all triangles that end there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes {
    pub axis: usize,
    min: f64,
    scale: f64,
    last: usize,
    values: [f32; PLANES],
}

/// The best edge of each cell of a part of the references.
#[derive(Clone, Copy)]
struct Nearest {
    distance: [f32; PLANES],
    edge: [f32; PLANES],
}

impl Planes {
    /// `count` planes between the faces of `window`, and the faces; nothing where it is flat.
    pub fn new(axis: usize, window: &Aabb, count: usize, references: &[Reference]) -> Option<Self> {
        let (low, high) = (window.min[axis], window.max[axis]);
        let last = count + 1;
        let min = f64::from(low);
        let scale = last as f64 / (f64::from(high) - min);
        let mut planes = Self { axis, min, scale, last, values: [f32::NAN; PLANES] };
        if low >= high || planes.cell(high) != last {
            return None;
        }
        planes.snap(references);
        (planes.values[0], planes.values[last]) = (low, high);
        Some(planes)
    }

    /// The cell of a coordinate: does not decrease where the coordinate increases. Outside the window it is the outermost.
    #[inline(always)]
    fn cell(&self, x: f32) -> usize {
        (((f64::from(x) - self.min) * self.scale + 0.5) as usize).min(self.last)
    }

    fn snap(&mut self, references: &[Reference]) {
        let mut nearest = Nearest { distance: [f32::INFINITY; PLANES], edge: [f32::NAN; PLANES] };
        for r in references {
            for x in [r.bounds.min[self.axis], r.bounds.max[self.axis]] {
                let at = (f64::from(x) - self.min) * self.scale;
                let cell = ((at + 0.5) as usize).min(self.last);
                let distance = (at - cell as f64).abs() as f32;
                if distance < nearest.distance[cell] {
                    (nearest.distance[cell], nearest.edge[cell]) = (distance, x);
                }
            }
        }
        for cell in 1..self.last {
            // The middle is rounded; should that move it to another cell, the cell has no plane, which NaN says.
            let middle = (self.min + cell as f64 / self.scale) as f32;
            let edge = nearest.edge[cell];
            let plane = if edge.is_nan() { middle } else { edge };
            self.values[cell] = if self.cell(plane) == cell { plane } else { f32::NAN };
        }
    }

    /// The number of bins: one below, between and above the planes.
    pub fn bins(&self) -> usize {
        self.last + 2
    }

    /// Plane `i`, between the bins `i` and `i + 1`; NaN where there is none.
    #[inline(always)]
    pub fn value(&self, i: usize) -> f32 {
        self.values[i]
    }

    /// The bin above all planes `<= x`: where something begins that begins at `x`.
    #[inline(always)]
    pub fn first_bin(&self, x: f32) -> usize {
        let cell = self.cell(x);
        cell + usize::from(self.values[cell] <= x)
    }

    /// The bin below all planes `>= x`: where something ends that ends at `x`.
    #[inline(always)]
    pub fn last_bin(&self, x: f32) -> usize {
        let cell = self.cell(x);
        cell + usize::from(self.values[cell] < x)
    }

    /// The plane in which a flat thing at `x` lies, or its bin.
    #[inline(always)]
    pub fn flat(&self, x: f32) -> Result<usize, usize> {
        let cell = self.cell(x);
        if self.values[cell] == x { Ok(cell) } else { Err(cell + usize::from(self.values[cell] < x)) }
    }

    /// A window around plane `i` that reaches to the next planes.
    pub fn around(&self, i: usize) -> (f32, f32) {
        let below = (0..i).rev().map(|k| self.values[k]).find(|v| !v.is_nan());
        let above = (i + 1..=self.last).map(|k| self.values[k]).find(|v| !v.is_nan());
        (below.unwrap_or(self.values[i]), above.unwrap_or(self.values[i]))
    }
}
