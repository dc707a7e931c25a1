//! Exact intersection of rays and triangles with `f32` coordinates.

mod expansion;
mod integers;
#[cfg(any(test, feature = "rationals"))]
pub mod rational;
mod tracked;

use std::cmp::Ordering;

use glam::Vec3;

use crate::geometry::Ray;
use crate::simd::indexed;
use expansion::{Expansion, exact_sum};

/// An exact ray parameter, as a fraction. Comparisons of parameters are exact.
#[derive(Clone, Debug)]
pub struct ExactT {
    numerator: Expansion,
    /// Positive.
    denominator: Expansion,
}

/// The parameter at which the line of `ray` meets the closed triangle. The result is `None` if the line misses the
/// triangle or lies in the plane of the triangle.
///
/// The function ignores the interval of the ray (see [`ExactT::is_within`]). The result is `None` if the origin, the
/// direction or a corner is not finite.
///
/// Let the corners be a, b and c. The line misses the triangle if two of the edges ab, bc and ca have opposite results
/// of [`side`]. Otherwise, the line meets the triangle or is parallel to the triangle.
///
/// # References
/// Segura, Feito: Algorithms to test ray-triangle intersection. Comparative study. WSCG 2001.
pub fn hit(ray: &Ray, corners: [Vec3; 3]) -> Option<ExactT> {
    if !ray.origin.is_finite() || !ray.direction.is_finite() || !corners.iter().all(|p| p.is_finite()) {
        return None;
    }
    integers::hit(ray, corners).unwrap_or_else(|| hit_by_sums(ray, corners))
}

/// The triple product (a - origin) . ((b - a) x (c - a)) for the corners a, b and c.
///
/// The relative error is below 2^-49. The result is zero if and only if `origin` and the corners lie in one plane. All
/// coordinates must be finite.
pub fn height(origin: Vec3, corners: [Vec3; 3]) -> f64 {
    let of_sums = || {
        let [a, ..] = corners;
        Expansion::dot(&difference(a, origin), &normal(corners)).approximate()
    };
    integers::height(origin, corners).unwrap_or_else(of_sums)
}

/// The side on which the line of `ray` passes the edge from p to q.
///
/// The result is the sign of direction . ((p - origin) x (q - origin)). The result is `Equal` if and only if the line
/// and the line through p and q lie in one plane. All coordinates must be finite.
#[inline(always)]
pub fn side(ray: &Ray, edge: [Vec3; 2]) -> Ordering {
    tracked::side(ray, edge).unwrap_or_else(|| side_of_any_size(ray, edge))
}

#[cold]
fn side_of_any_size(ray: &Ray, edge: [Vec3; 2]) -> Ordering {
    let of_sums = || {
        let [p, q] = edge.map(|corner| difference(corner, ray.origin));
        side_by_sums(&direction(ray), &p, &q)
    };
    integers::side(ray, edge).unwrap_or_else(of_sums)
}

/// Whether the line of `ray` passes exactly through `point`. All coordinates must be finite.
#[inline(always)]
pub fn passes_through(ray: &Ray, point: Vec3) -> bool {
    let (direction, offset) = (ray.direction.as_dvec3(), point.as_dvec3() - ray.origin.as_dvec3());
    // Each product has a relative error below 1.5 epsilons. So if two exact products are equal, the computed products
    // have a relative difference below 4 epsilons.
    let may_be_equal = |x: f64, y: f64| (x - y).abs() <= 4.0 * f64::EPSILON * x.abs();
    may_be_equal(direction.x * offset.y, direction.y * offset.x)
        && may_be_equal(direction.y * offset.z, direction.z * offset.y)
        && may_be_equal(direction.z * offset.x, direction.x * offset.z)
        && surely_passes_through(ray, point)
}

/// Whether direction x (point - origin) is exactly zero.
fn surely_passes_through(ray: &Ray, point: Vec3) -> bool {
    let offset: [_; 3] = indexed(|axis| exact_sum(point[axis].into(), -f64::from(ray.origin[axis])));
    if offset.iter().any(|&(_, error)| error != 0.0) {
        return cross(&direction(ray), &difference(point, ray.origin)).iter().all(|minor| minor.sign().is_eq());
    }
    // Two exact products are equal if and only if the rounded products and the rounding errors are equal.
    let product = |i: usize, j: usize| {
        let (x, y) = (f64::from(ray.direction[i]), offset[j].0);
        (x * y, if x * y == 0.0 { 0.0 } else { x.mul_add(y, -(x * y)) })
    };
    [(0, 1), (1, 2), (2, 0)].iter().all(|&(i, j)| product(i, j) == product(j, i))
}

/// `p` and `q` are relative to the origin of the ray.
fn side_by_sums(direction: &[Expansion; 3], p: &[Expansion; 3], q: &[Expansion; 3]) -> Ordering {
    Expansion::dot(direction, &cross(p, q)).sign()
}

fn direction(ray: &Ray) -> [Expansion; 3] {
    ray.direction.to_array().map(|x| Expansion::from(f64::from(x)))
}

fn difference(p: Vec3, q: Vec3) -> [Expansion; 3] {
    std::array::from_fn(|axis| Expansion::difference(p[axis].into(), q[axis].into()))
}

fn cross(p: &[Expansion; 3], q: &[Expansion; 3]) -> [Expansion; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| Expansion::minor(&p[i], &q[j], &p[j], &q[i]))
}

fn normal([a, b, c]: [Vec3; 3]) -> [Expansion; 3] {
    cross(&difference(b, a), &difference(c, a))
}

fn hit_by_sums(ray: &Ray, corners: [Vec3; 3]) -> Option<ExactT> {
    let direction = direction(ray);
    let [a, b, c] = corners.map(|corner| difference(corner, ray.origin));
    let (mut left, mut right) = (false, false);
    for (p, q) in [(&c, &b), (&a, &c), (&b, &a)] {
        match side_by_sums(&direction, p, q) {
            Ordering::Less => left = true,
            Ordering::Greater => right = true,
            Ordering::Equal => {}
        }
        if left && right {
            return None;
        }
    }

    let normal = normal(corners);
    let (mut numerator, mut denominator) = (Expansion::dot(&a, &normal), Expansion::dot(&direction, &normal));
    match denominator.sign() {
        Ordering::Equal => return None,
        Ordering::Less => {
            numerator.negate();
            denominator.negate();
        }
        Ordering::Greater => {}
    }
    Some(ExactT { numerator, denominator })
}

impl ExactT {
    /// Whether this `t` lies in the half-open interval of `ray`. A `t` that rounds to infinity lies outside the
    /// interval (see [`Ray::end`]).
    pub fn is_within(&self, ray: &Ray) -> bool {
        let begun = self.order(ray.interval().0.into()).is_ge();
        begun && !ray.t_max.is_nan() && self.order(ray.end()).is_lt()
    }

    /// Compares this `t` with a finite or infinite float. The result is `None` for NaN.
    pub fn compare(&self, t: f32) -> Option<Ordering> {
        (!t.is_nan()).then(|| self.order(t.into()))
    }

    /// `t` must be an `f32` number, the middle of two neighbouring `f32` numbers, or infinite.
    fn order(&self, t: f64) -> Ordering {
        if t.is_infinite() {
            return 0.0_f64.total_cmp(&t);
        }
        if t == 0.0 {
            return self.numerator.sign();
        }
        let one = Expansion::from(1.0);
        Expansion::minor(&self.numerator, &one, &Expansion::from(t), &self.denominator).sign()
    }

    /// This `t`, with a relative error below 6 * 2^-53.
    pub fn approximate(&self) -> f64 {
        // The quotient neither overflows nor underflows. The magnitude of a nonzero numerator or denominator is between
        // 2^-447 and 2^391.
        self.numerator.approximate() / self.denominator.approximate()
    }

    /// The nearest `f32`, with ties to even. The result is infinite if the magnitude of this `t` is at least
    /// 2^128 - 2^103.
    pub fn round(&self) -> f32 {
        if self.numerator.sign().is_eq() {
            return 0.0;
        }
        let near = self.approximate() as f32;
        // `near` was rounded twice, so the nearest `f32` may be a neighbour of `near`.
        let wide = |x: f32| if x.is_infinite() { f64::from(x.signum()) * 2.0_f64.powi(128) } else { f64::from(x) };
        let middle = |x: f32, y: f32| (wide(x) + wide(y)) / 2.0;
        let is_even = near.to_bits() & 1 == 0;
        let (below, above) = (near.next_down(), near.next_up());
        let beyond = |order: Ordering, side: Ordering| order == side || order.is_eq() && !is_even;
        if near != f32::NEG_INFINITY && beyond(self.order(middle(below, near)), Ordering::Less) {
            below
        } else if near != f32::INFINITY && beyond(self.order(middle(near, above)), Ordering::Greater) {
            above
        } else {
            near
        }
    }
}

impl Ord for ExactT {
    fn cmp(&self, other: &Self) -> Ordering {
        Expansion::minor(&self.numerator, &other.denominator, &other.numerator, &self.denominator).sign()
    }
}

impl PartialOrd for ExactT {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for ExactT {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for ExactT {}

#[cfg(test)]
mod tests;
