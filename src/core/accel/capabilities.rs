//! The features that a structure supports.

use crate::geometry::{Hit, Ray};

/// The features that a structure supports.
///
/// Rays that need an unsupported feature count as declined. A declined ray is neither right nor wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// Whether the structure has a separate any-hit query. Without this query, any-hit results are not checked.
    pub any_hit: bool,
    /// Whether the structure ignores hits below a positive `t_min`.
    pub t_min: bool,
    /// Whether the structure finds hits at `t_min`.
    pub closed_start: bool,
    /// Whether the structure ignores hits at or beyond a finite `t_max`.
    pub t_max: bool,
}

impl Capabilities {
    /// All features.
    pub const ALL: Self = Self { any_hit: true, t_min: true, closed_start: true, t_max: true };

    /// Whether `ray` counts as declined because the `nearest` hit lies at the start of the interval.
    pub fn excuses(self, ray: &Ray, nearest: Option<Hit>) -> bool {
        !self.closed_start && nearest.is_some_and(|hit| hit.t == ray.interval().0)
    }

    /// The name of an unsupported bound of `ray`. `None` if `ray` has no unsupported bound.
    pub fn declines(self, ray: &Ray) -> Option<&'static str> {
        // A NaN `t_max` counts as a bound, because a structure that ignores `t_max` may return a hit.
        let (from_start, endless) = (ray.t_min <= 0.0, ray.t_max == f32::INFINITY);
        let t_max = (!self.t_max && !endless).then_some("t_max");
        if self.t_min || from_start { t_max } else { Some("t_min") }
    }

    /// The names of the unsupported features.
    pub fn declined(self) -> Vec<&'static str> {
        let all = [
            (self.any_hit, "any hit"),
            (self.t_min, "t_min"),
            (self.closed_start, "hits at t_min"),
            (self.t_max, "t_max"),
        ];
        all.into_iter().filter(|(can, _)| !can).map(|(_, name)| name).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn rays_are_declined_only_for_unsupported_features() {
        let whole = Ray::new(Vec3::ZERO, Vec3::X);
        let (late, short) = (Ray { t_min: 0.5, ..whole }, whole.until(2.0));
        let odd = whole.until(f32::NAN);
        let rays = [whole, late, short, odd, Ray { t_min: -1.0, ..whole }];
        let declined = |by: Capabilities| rays.map(|ray| by.declines(&ray));
        let no_start = Capabilities { t_min: false, ..Capabilities::ALL };
        let no_end = Capabilities { t_max: false, ..Capabilities::ALL };
        assert_eq!(declined(Capabilities::ALL), [None; 5]);
        assert_eq!(declined(no_start), [None, Some("t_min"), None, None, None]);
        assert_eq!(declined(no_end), [None, None, Some("t_max"), Some("t_max"), None]);
        let open = Capabilities { closed_start: false, ..Capabilities::ALL };
        let at = |t| Some(Hit::new(t, 7));
        assert!(open.excuses(&late, at(0.5)) && open.excuses(&whole, at(0.0)) && !open.excuses(&late, at(0.6)));
        assert!(!open.excuses(&whole, None) && !Capabilities::ALL.excuses(&late, at(0.5)));
        assert!(Capabilities::ALL.declined().is_empty());
        assert_eq!(Capabilities { any_hit: false, ..no_end }.declined(), ["any hit", "t_max"]);
    }
}
