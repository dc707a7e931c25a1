//! The candidate planes of spatial splits on one axis.

use super::sample::Sample;

/// Maximum number of planes, including both ends of the range. For a power of two, `i % PLANES` compiles to a mask.
pub(crate) const PLANES: usize = 64;

/// Candidate planes in ascending order, one for each cell of a uniform grid. The planes of the first and the last cell
/// are the ends of the range. The plane of an inner cell lies at the highest box edge in the cell. A plane at a box
/// edge does not cut the box. If an inner cell has no box edge, the plane lies in the middle of the cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planes {
    pub axis: usize,
    min: f32,
    scale: f32,
    last: usize,
    values: [f32; PLANES],
}

impl Planes {
    /// `count` is the number of planes between `min` and `max`. `None` if the range is empty or `max - min` overflows.
    pub fn new(axis: usize, (min, max): (f32, f32), count: usize, sample: &Sample) -> Option<Self> {
        let last = count + 1;
        assert!(last < PLANES, "{count} planes between both ends are too many");
        let mut planes =
            Self { axis, min, scale: last as f32 / (max - min), last, values: [f32::NEG_INFINITY; PLANES] };
        // The second condition is true if `max - min` overflows.
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
                // If rounding moves the middle to another cell, repeat the previous plane to keep the order.
                let middle = min + cell as f32 / planes.scale;
                planes.values[cell] = if planes.cell(middle) == cell { middle } else { planes.values[cell - 1] };
            }
        }
        Some(planes)
    }

    /// The cell is a non-decreasing function of `x`.
    #[inline(always)]
    fn cell(&self, x: f32) -> usize {
        let at = ((x - self.min) * self.scale + 0.5).max(0.0).min(self.last as f32);
        // SAFETY: `max` turns NaN into 0, so `at` is in [0, `last`]. `new` has checked that `last` is below `PLANES`.
        unsafe { at.to_int_unchecked::<i32>() as usize }
    }

    /// Number of bins, including one bin below all planes and one bin above all planes.
    pub fn bins(&self) -> usize {
        self.last + 2
    }

    /// Plane `i`, between the bins `i` and `i + 1`.
    #[inline(always)]
    pub fn value(&self, i: usize) -> f32 {
        self.values[i % PLANES]
    }

    pub fn around(&self, i: usize) -> (f32, f32) {
        (self.values[i.saturating_sub(1)], self.values[(i + 1).min(self.last)])
    }

    #[inline(always)]
    pub fn is_new(&self, i: usize) -> bool {
        i == 0 || self.values[i - 1] < self.values[i]
    }

    /// The bin directly above the highest plane `<= x`.
    #[inline(always)]
    pub fn first_bin(&self, x: f32) -> usize {
        let cell = self.cell(x);
        cell + usize::from(self.value(cell) <= x)
    }

    /// The bin directly below the lowest plane `>= x`.
    #[inline(always)]
    pub fn last_bin(&self, x: f32) -> usize {
        let cell = self.cell(x);
        cell + usize::from(self.value(cell) < x)
    }
}
