use glam::{Vec3, Vec3A};

use crate::geometry::{Aabb, half_area};

/// An [`Aabb`] in SIMD registers, for the inner loops of a builder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    pub min: Vec3A,
    pub max: Vec3A,
}

impl Extent {
    pub const EMPTY: Self = Self { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY };

    #[inline(always)]
    pub fn grow(&mut self, other: Self) {
        self.min = other.min.min(self.min);
        self.max = other.max.max(self.max);
    }

    #[inline(always)]
    pub fn with_point(self, point: Vec3A) -> Self {
        Self { min: point.min(self.min), max: point.max(self.max) }
    }

    /// Half of the surface area of the intersection.
    pub fn overlap(self, other: Self) -> f64 {
        let common = self.intersection(other);
        if common.min.cmple(common.max).all() { common.half_area() } else { 0.0 }
    }

    #[inline(always)]
    pub fn intersection(self, other: Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    #[inline(always)]
    pub fn up_to(mut self, axis: usize, plane: f32) -> Self {
        self.max[axis] = self.max[axis].min(plane);
        self
    }

    #[inline(always)]
    pub fn down_to(mut self, axis: usize, plane: f32) -> Self {
        self.min[axis] = self.min[axis].max(plane);
        self
    }

    #[inline(always)]
    pub fn union(mut self, other: Self) -> Self {
        self.grow(other);
        self
    }

    /// Half of the surface area, in `f64` to avoid overflow. A negative edge length counts as 0.
    #[inline(always)]
    pub fn half_area(&self) -> f64 {
        half_area(self.min.as_dvec3(), self.max.as_dvec3())
    }
}

impl From<Aabb> for Extent {
    #[inline(always)]
    fn from(bounds: Aabb) -> Self {
        Self { min: bounds.min.into(), max: bounds.max.into() }
    }
}

impl From<Extent> for Aabb {
    #[inline(always)]
    fn from(extent: Extent) -> Self {
        Self { min: Vec3::from(extent.min), max: Vec3::from(extent.max) }
    }
}
