//! The candidate planes of spatial splits on one axis.

use super::sample::Sample;

/// Maximum number of planes, including both ends of the range. A power of two makes `i % PLANES` a mask.
pub(crate) const PLANES: usize = 64;

/// Ascending candidate planes: one at each end of a range, and one in each inner cell of an even grid. The plane of a
/// cell lies at the highest box edge in the cell or, without edges, in the middle of the cell. A plane in a wall does
/// not cut the triangles that end at the wall; a plane beside the wall would cut them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planes {
    pub axis: usize,
    min: f32,
    scale: f32,
    last: usize,
    values: [f32; PLANES],
}

impl Planes {
    /// Planes at `min` and `max`, and `count` planes between. `None` if the range is empty or the grid overflows.
    pub fn new(axis: usize, (min, max): (f32, f32), count: usize, sample: &Sample) -> Option<Self> {
        let last = count + 1;
        assert!(last < PLANES, "{count} planes between both ends are too many");
        let mut planes =
            Self { axis, min, scale: last as f32 / (max - min), last, values: [f32::NEG_INFINITY; PLANES] };
        // The second condition detects an extent so large or small that the grid overflows.
        if min >= max || planes.cell(max) != last {
            return None;
        }

        for r in sample.iter() {
            for x in [r.min(axis), r.max(axis)] {
                let value = &mut planes.values[planes.cell(x) % PLANES];
                *value = value.max(x);
            }
        }
        (planes.values[0], planes.values[last]) = (min, max);
        for cell in 1..last {
            if planes.values[cell] == f32::NEG_INFINITY {
                // If rounding moves the middle to another cell, repeat the previous plane, which is below the cell.
                let middle = min + cell as f32 / planes.scale;
                planes.values[cell] = if planes.cell(middle) == cell { middle } else { planes.values[cell - 1] };
            }
        }
        Some(planes)
    }

    /// The cell of a coordinate: a non-decreasing function of `x`.
    #[inline(always)]
    fn cell(&self, x: f32) -> usize {
        let at = ((x - self.min) * self.scale + 0.5).max(0.0).min(self.last as f32);
        // SAFETY: `max` turns NaN into 0, so `at` is in [0, `last`]; `new` has checked that `last` is below `PLANES`.
        unsafe { at.to_int_unchecked::<i32>() as usize }
    }

    /// The number of bins: one below all planes, one between any two neighbouring planes, one above all planes.
    pub fn bins(&self) -> usize {
        self.last + 2
    }

    /// Plane `i`, between the bins `i` and `i + 1`.
    #[inline(always)]
    pub fn value(&self, i: usize) -> f32 {
        self.values[i % PLANES]
    }

    /// The range from the plane before plane `i` to the plane after it.
    pub fn around(&self, i: usize) -> (f32, f32) {
        (self.values[i.saturating_sub(1)], self.values[(i + 1).min(self.last)])
    }

    /// Whether plane `i` differs from the previous one.
    #[inline(always)]
    pub fn is_new(&self, i: usize) -> bool {
        i == 0 || self.values[i - 1] < self.values[i]
    }

    /// The bin above all planes `<= x`: the first bin of a reference that begins at `x`.
    #[inline(always)]
    pub fn first_bin(&self, x: f32) -> usize {
        let cell = self.cell(x);
        cell + usize::from(self.value(cell) <= x)
    }

    /// The bin below all planes `>= x`: the last bin of a reference that ends at `x`.
    #[inline(always)]
    pub fn last_bin(&self, x: f32) -> usize {
        let cell = self.cell(x);
        cell + usize::from(self.value(cell) < x)
    }
}
