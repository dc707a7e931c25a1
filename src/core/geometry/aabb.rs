//! Axis-aligned boxes.

use glam::{DVec3, Vec3};

/// The closed box of all points between `min` and `max`. The box is empty if `min` exceeds `max` on at least one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The least coordinates.
    pub min: Vec3,
    /// The greatest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The empty box, which is the identity element of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box that contains `points`.
    #[inline]
    pub fn of_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |all, p| Self { min: all.min.min(p), max: all.max.max(p) })
    }

    /// The smallest box that contains two nonempty boxes.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The intersection of two boxes. The intersection of disjoint boxes is empty.
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// Whether the box contains no point.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The lengths of the edges. An empty box has at least one negative length.
    #[inline]
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// The centre, which is finite for every finite box.
    pub fn centre(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Half of the surface area (Goldsmith, Salmon 1987), in `f64` to avoid overflow. Negative lengths count as 0.
    #[inline]
    pub fn half_area(&self) -> f64 {
        half_area(self.min.as_dvec3(), self.max.as_dvec3())
    }

    /// The axis of the longest edge. In a tie, the lowest axis index is returned.
    #[inline]
    pub fn longest_axis(&self) -> usize {
        self.extent().max_position()
    }

    /// Cuts the box at the plane `axis = split` into (below, above). If the plane misses the box, one part is empty.
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
