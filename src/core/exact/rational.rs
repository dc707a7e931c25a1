//! A second implementation of [`hit`](super::hit()) for tests, in rational numbers. To stay independent, it shares only
//! `Ray` and `Vec3` with the first implementation.
//!
//! The functions panic if the origin, the direction or a corner is not finite. As an exception, [`nearest`] returns
//! `None` if the origin or the direction is not finite.

use dashu_ratio::RBig;
use glam::Vec3;

use crate::geometry::Ray;

/// The intersection of the line of a ray and the plane of a triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The nonzero divisor in Cramer's rule.
    pub determinant: RBig,
    /// Barycentric coordinate of the second corner.
    pub u: RBig,
    /// Barycentric coordinate of the third corner.
    pub v: RBig,
    /// Ray parameter.
    pub t: RBig,
}

/// Intersects the line of `ray` and the plane of the triangle by Cramer's rule. The result is `None` if the determinant
/// is zero.
pub fn solve(ray: &Ray, corners: [Vec3; 3]) -> Option<Solution> {
    type V = [RBig; 3];
    let rational = |p: Vec3| -> V { p.to_array().map(|x| RBig::try_from(x).expect("finite")) };
    let sub = |a: &V, b: &V| -> V { std::array::from_fn(|i| &a[i] - &b[i]) };
    let det = |[a, b, c]: [&V; 3]| {
        &a[0] * &b[1] * &c[2] + &b[0] * &c[1] * &a[2] + &c[0] * &a[1] * &b[2]
            - &c[0] * &b[1] * &a[2]
            - &b[0] * &a[1] * &c[2]
            - &a[0] * &c[1] * &b[2]
    };
    let [a, b, c] = corners.map(rational);
    let (o, d) = (rational(ray.origin), rational(ray.direction));
    let (e1, e2, s, back) = (sub(&b, &a), sub(&c, &a), sub(&o, &a), d.map(|x| -x));
    let determinant = det([&e1, &e2, &back]);
    if determinant == RBig::ZERO {
        return None;
    }
    let u = det([&s, &e2, &back]) / &determinant;
    let v = det([&e1, &s, &back]) / &determinant;
    let t = det([&e1, &e2, &s]) / &determinant;
    Some(Solution { determinant, u, v, t })
}

/// The parameter at which the line of `ray` meets the closed triangle.
pub fn hit(ray: &Ray, corners: [Vec3; 3]) -> Option<RBig> {
    let Solution { u, v, t, .. } = solve(ray, corners)?;
    (u >= RBig::ZERO && v >= RBig::ZERO && u + v <= RBig::ONE).then_some(t)
}

/// A `t` that rounds to infinity is beyond the end of the interval.
fn within(ray: &Ray, corners: [Vec3; 3]) -> Option<RBig> {
    let t = hit(ray, corners)?;
    let (t_min, t_max) = ray.interval();
    let from_start = RBig::try_from(t_min).is_ok_and(|start| t >= start);
    let before_end = t_max == f32::INFINITY || RBig::try_from(t_max).is_ok_and(|end| t < end);
    (from_start && before_end && nearest_float(&t).is_finite()).then_some(t)
}

fn nearest_float(t: &RBig) -> f32 {
    t.to_f32().value()
}

/// The parameter of the hit in the half-open interval of `ray`, rounded to the nearest `f32`. A parameter that rounds
/// to infinity is not a hit.
pub fn hit_within(ray: &Ray, corners: [Vec3; 3]) -> Option<f32> {
    Some(nearest_float(&within(ray, corners)?))
}

/// The nearest hit in the half-open interval of `ray`: the rounded parameter and the triangle number. Among hits with
/// equal exact parameters, the lowest triangle number wins.
pub fn nearest(ray: &Ray, triangles: impl IntoIterator<Item = (u32, [Vec3; 3])>) -> Option<(f32, u32)> {
    if !ray.is_valid() {
        return None;
    }
    let hits = triangles.into_iter().filter_map(|(id, corners)| Some((within(ray, corners)?, id)));
    hits.min().map(|(t, id)| (nearest_float(&t), id))
}
