//! What a structure can be asked.

use std::borrow::Cow;

use crate::geometry::{Hit, Ray};

/// What a structure can be asked. What it declines it is not asked: tables show it as declined, neither right nor
/// wrong.
///
/// That counts are declined is said by [`Accel::OBSERVED`](super::Accel::OBSERVED), that no triangle test is shared by
/// [`Accel::TRIANGLE_TEST`](super::Accel::TRIANGLE_TEST).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// Whether it has an any-hit query of its own. Without one, any hit is answered by the closest hit, so that
    /// pictures are drawn; it is neither checked nor timed.
    pub any_hit: bool,
    /// Whether it leaves out hits before a `t_min` above 0.
    pub t_min: bool,
    /// Whether its intervals hold their start: without that, a ray whose nearest hit lies at its `t_min` exactly is not
    /// counted.
    pub closed_start: bool,
    /// Whether it leaves out hits at or beyond a finite `t_max`.
    pub t_max: bool,
}

impl Capabilities {
    /// All that the contract of [`Accel`](super::Accel) asks for.
    pub const ALL: Self = Self { any_hit: true, t_min: true, closed_start: true, t_max: true };

    /// Whether the answer to `ray`, of which `nearest` is the nearest hit, is a matter of convention.
    pub fn excuses(self, ray: &Ray, nearest: Option<Hit>) -> bool {
        !self.closed_start && nearest.is_some_and(|hit| hit.t == ray.interval().0)
    }

    /// What of `ray` is declined, if anything is.
    pub fn declines(self, ray: &Ray) -> Option<&'static str> {
        // What is not a number is no end that could be left out.
        let (from_start, endless) = (ray.t_min <= 0.0, ray.t_max == f32::INFINITY);
        match () {
            () if !self.t_min && !from_start => Some("t_min"),
            () if !self.t_max && !endless => Some("t_max"),
            () => None,
        }
    }

    /// Those of `rays` that can be asked, in order.
    pub fn admitted(self, rays: &[Ray]) -> Cow<'_, [Ray]> {
        if rays.iter().all(|ray| self.declines(ray).is_none()) {
            return Cow::Borrowed(rays);
        }
        rays.iter().filter(|ray| self.declines(ray).is_none()).copied().collect()
    }

    /// What is declined, as printed.
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
    fn only_what_is_declined_is_not_asked() {
        let whole = Ray::new(Vec3::ZERO, Vec3::X);
        let (late, short) = (Ray { t_min: 0.5, ..whole }, whole.until(2.0));
        let odd = whole.until(f32::NAN);
        let rays = [whole, late, short, odd, Ray { t_min: -1.0, ..whole }];
        let no_start = Capabilities { t_min: false, ..Capabilities::ALL };
        let no_end = Capabilities { t_max: false, ..Capabilities::ALL };
        assert_eq!(Capabilities::ALL.admitted(&rays).len(), rays.len());
        assert_eq!(no_start.admitted(&rays).len(), 4);
        assert_eq!(no_end.admitted(&rays)[..], [whole, late, rays[4]]);
        assert_eq!((no_start.declines(&late), no_end.declines(&odd)), (Some("t_min"), Some("t_max")));
        let open = Capabilities { closed_start: false, ..Capabilities::ALL };
        let at = |t| Some(Hit::new(t, 7));
        assert!(open.excuses(&late, at(0.5)) && open.excuses(&whole, at(0.0)) && !open.excuses(&late, at(0.6)));
        assert!(!open.excuses(&whole, None) && !Capabilities::ALL.excuses(&late, at(0.5)));
        assert!(Capabilities::ALL.declined().is_empty());
        assert_eq!(Capabilities { any_hit: false, ..no_end }.declined(), ["any hit", "t_max"]);
    }
}
