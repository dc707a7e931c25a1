//! Intervals that end at the rounded value of an exact `t`, including the largest float.

use crate::exact::ExactT;
use crate::geometry::Ray;

/// `ray` with two intervals: up to the float to which `t` rounds, and from that float on. If `t` is below that float, a
/// hit at `t` belongs to the first interval and not to the second.
pub fn rounded_ends(ray: &Ray, t: &ExactT) -> [Ray; 2] {
    let end = t.round();
    [ray.until(end), Ray { t_min: end, ..*ray }]
}

/// `ray` with a direction so short that its hit at `t` moves close to the largest float, as precisely as the direction
/// can be rounded.
pub fn near_the_largest_t(ray: &Ray, t: f64) -> Ray {
    Ray { direction: (ray.direction.as_dvec3() * (t / f64::from(f32::MAX))).as_vec3(), ..*ray }
}
