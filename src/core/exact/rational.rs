//! A second implementation of [`hit`](super::hit()), for tests: another formula, in rational numbers.
//!
//! It shares only `Ray` and `Vec3` with the first implementation, and takes a hundred times as long. Its functions
//! panic if an origin, a direction or a corner is not finite; only [`nearest`] accepts such rays, and returns `None`.

use dashu_ratio::RBig;
use glam::Vec3;

use crate::geometry::Ray;

/// The intersection of the line of a ray and the plane of a triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The divisor of Cramer's rule for the other three numbers; not zero.
    pub determinant: RBig,
    /// Barycentric coordinate of the second corner.
    pub u: RBig,
    /// Barycentric coordinate of the third corner.
    pub v: RBig,
    /// Ray parameter.
    pub t: RBig,
}

/// Cramer's rule for `o + t d = a + u e1 + v e2`; `None` if the line is parallel to the plane.
pub fn solve(ray: &Ray, corners: [Vec3; 3]) -> Option<Solution> {
    type V = [RBig; 3];
    let rational = |p: Vec3| -> V { p.to_array().map(|x| RBig::try_from(x).expect("finite")) };
    let sub = |a: &V, b: &V| -> V { std::array::from_fn(|i| &a[i] - &b[i]) };
    // The determinant of three columns, by the rule of Sarrus.
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

/// The parameter at which the whole line of `ray` meets the closed triangle.
pub fn hit(ray: &Ray, corners: [Vec3; 3]) -> Option<RBig> {
    let Solution { u, v, t, .. } = solve(ray, corners)?;
    (u >= RBig::ZERO && v >= RBig::ZERO && u + v <= RBig::ONE).then_some(t)
}

/// The `t` of the hit of `ray` in its half-open interval. A `t` that rounds to infinity is beyond the end.
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

/// The nearest `f32` to the `t` of the hit of `ray` in its half-open interval. `None` if this float is infinite.
pub fn hit_within(ray: &Ray, corners: [Vec3; 3]) -> Option<f32> {
    Some(nearest_float(&within(ray, corners)?))
}

/// Like [`hit_within`], for the nearest hit among `triangles`. At equal exact `t`, the lowest number wins.
pub fn nearest(ray: &Ray, triangles: impl IntoIterator<Item = (u32, [Vec3; 3])>) -> Option<(f32, u32)> {
    if !ray.is_valid() {
        return None;
    }
    let hits = triangles.into_iter().filter_map(|(id, corners)| Some((within(ray, corners)?, id)));
    hits.min().map(|(t, id)| (nearest_float(&t), id))
}
