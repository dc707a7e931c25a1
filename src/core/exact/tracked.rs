//! The side on which a line passes an edge, in `f64`. It has a result only if no operation rounds.

use std::cmp::Ordering;

use glam::Vec3;

use super::expansion::exact_sum;
use crate::geometry::Ray;

/// A number, and whether it is the exact result of all operations that led to it.
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

    /// The product of two differences of `f32` numbers and a third `f32` number neither overflows nor underflows in
    /// `f64`, so `error` is exact.
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.mul_add(other.value, -value);
        Self { value, is_exact: self.is_exact & other.is_exact & (error == 0.0) }
    }
}

/// Like [`side`](super::side), but `None` if an operation rounds.
#[inline(always)]
pub(super) fn side(ray: &Ray, edge: [Vec3; 2]) -> Option<Ordering> {
    let difference = |corner: Vec3, axis: usize| Tracked::of(corner[axis]).minus(Tracked::of(ray.origin[axis]));
    let term = |axis: usize| {
        let direction = Tracked::of(ray.direction[axis]);
        // A zero component of the direction makes its term zero: the rest of the term need not be exact.
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

#[cfg(test)]
mod tests {
    use super::super::{difference, direction, side_by_sums};
    use super::*;

    #[test]
    fn an_unrounded_side_equals_the_side_by_sums() {
        let number = |i: u32, steps: u32, unit: f32| {
            let bits = i.wrapping_mul(2_654_435_761).rotate_left(13).wrapping_mul(0x9e37_79b1);
            ((bits % steps) as f32 - (steps / 2) as f32) * unit
        };
        let (mut found, mut zeros, mut rounded) = (0, 0, 0);
        for i in 0..40_000 {
            let (steps, unit) = [(3, 1.0), (5, 0.1), (40, 0.37), (1 << 24, 1e-3)][i as usize % 4];
            let vector = |k: u32| Vec3::from_array([0, 1, 2].map(|axis| number(15 * i + 3 * k + axis, steps, unit)));
            let axes = [Vec3::X, -Vec3::Y, Vec3::Z, vector(1), vector(1)];
            let ray = Ray::new(vector(0), axes[i as usize % 5]);
            let edge = [vector(2), vector(3)];
            let [p, q] = edge.map(|corner| difference(corner, ray.origin));
            match side(&ray, edge) {
                Some(side) => {
                    assert_eq!(side, side_by_sums(&direction(&ray), &p, &q), "{ray} {edge:?}");
                    found += 1;
                    zeros += usize::from(side.is_eq());
                }
                None => rounded += 1,
            }
        }
        assert!(found > 20_000 && zeros > 2_000 && rounded > 1_000, "{found} {zeros} {rounded}");
    }
}
