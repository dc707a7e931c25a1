//! Computes in `f64` the side on which a line passes an edge. The result is `None` if an operation rounds.

use std::cmp::Ordering;

use glam::Vec3;

use super::expansion::exact_sum;
use crate::geometry::Ray;

#[derive(Clone, Copy)]
struct Tracked {
    value: f64,
    is_exact: bool,
}

impl Tracked {
    #[inline(always)]
    fn of(value: f32) -> Self {
        Self { value: value.into(), is_exact: true }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        let (value, error) = exact_sum(self.value, other.value);
        Self { value, is_exact: self.is_exact & other.is_exact & (error == 0.0) }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        self.plus(Self { value: -other.value, ..other })
    }

    /// `error` is exact, because the products in [`side`] neither overflow nor underflow.
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.mul_add(other.value, -value);
        Self { value, is_exact: self.is_exact & other.is_exact & (error == 0.0) }
    }
}

#[inline(always)]
pub(super) fn side(ray: &Ray, edge: [Vec3; 2]) -> Option<Ordering> {
    let difference = |corner: Vec3, axis: usize| Tracked::of(corner[axis]).minus(Tracked::of(ray.origin[axis]));
    let term = |axis: usize| {
        let direction = Tracked::of(ray.direction[axis]);
        // The term is exactly zero, even if the other factor of the term is not exact.
        if direction.value == 0.0 {
            return direction;
        }
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let [one, other] = [[i, j], [j, i]].map(|[i, j]| difference(edge[0], i).times(difference(edge[1], j)));
        direction.times(one.minus(other))
    };
    let volume = term(0).plus(term(1)).plus(term(2));
    if volume.is_exact { volume.value.partial_cmp(&0.0) } else { None }
}
