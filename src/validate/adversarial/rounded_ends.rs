//! Intervals that end where an exact `t` is rounded to, at the largest float too.

use crate::exact::ExactT;
use crate::geometry::Ray;

/// `ray` up to the float to which `t` is rounded, and from there on. Where `t` lies before that float, a hit at `t` belongs
/// to the first interval and not to the second.
pub fn rounded_ends(ray: &Ray, t: &ExactT) -> [Ray; 2] {
    let end = t.round();
    [ray.until(end), Ray { t_min: end, ..*ray }]
}

/// `ray` with so short a direction that it meets near the largest float what it meets at `t`, as nearly as the direction
/// can be rounded.
pub fn near_the_largest_t(ray: &Ray, t: f64) -> Ray {
    Ray { direction: (ray.direction.as_dvec3() * (t / f64::from(f32::MAX))).as_vec3(), ..*ray }
}
