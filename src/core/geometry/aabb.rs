//! Axis-aligned boxes.

use glam::{DVec3, Vec3};

/// The closed box of all points between `min` and `max`. It is empty if `min` exceeds `max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The least coordinates.
    pub min: Vec3,
    /// The greatest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The empty box: the identity of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box that contains these points.
    #[inline]
    pub fn of_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |all, p| Self { min: all.min.min(p), max: all.max.max(p) })
    }

    /// The smallest box that contains both boxes.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The intersection of both boxes. It is empty if they are disjoint.
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// Whether the box contains no point.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The lengths of the edges; at least one is negative if the box is empty.
    #[inline]
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// The centre. It does not overflow for a finite box.
    pub fn centre(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Half of the surface area (Goldsmith, Salmon 1987), in `f64` to avoid overflow. A negative extent counts as 0.
    #[inline]
    pub fn half_area(&self) -> f64 {
        half_area(self.min.as_dvec3(), self.max.as_dvec3())
    }

    /// The axis of the longest edge; the first axis if several edges are equally long.
    #[inline]
    pub fn longest_axis(&self) -> usize {
        self.extent().max_position()
    }

    /// Cuts the box at the plane `axis = split` into (below, above). One part is empty if the plane misses the box.
    #[inline]
    pub fn cut(&self, axis: usize, split: f32) -> (Self, Self) {
        let (mut below, mut above) = (*self, *self);
        below.max[axis] = split.min(self.max[axis]);
        above.min[axis] = split.max(self.min[axis]);
        (below, above)
    }

    /// Whether the box contains all of `other`.
    pub fn contains(&self, other: &Self) -> bool {
        other.is_empty() || (self.min.cmple(other.min).all() && self.max.cmpge(other.max).all())
    }
}

#[inline(always)]
pub(crate) fn half_area(min: DVec3, max: DVec3) -> f64 {
    let e = (max - min).max(DVec3::ZERO);
    e.x * e.y + e.y * e.z + e.z * e.x
}
