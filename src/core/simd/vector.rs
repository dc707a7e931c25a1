use std::marker::PhantomData;
use std::ops::Sub;

use glam::Vec3;

use super::{Arithmetic, Lanes};

/// A 3-vector in every lane. Scalar products add their terms in the order x, y, z.
#[derive(Clone, Copy, Debug)]
pub struct LaneVec3<const N: usize, L> {
    /// The x of each lane.
    pub x: L,
    /// The y of each lane.
    pub y: L,
    /// The z of each lane.
    pub z: L,
    width: PhantomData<[f32; N]>,
}

impl<const N: usize, L: Lanes<N>> LaneVec3<N, L> {
    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(v: Vec3) -> Self {
        Self::new(L::splat(v.x), L::splat(v.y), L::splat(v.z))
    }

    /// Loads one vector per lane from a structure of arrays.
    #[inline(always)]
    pub fn load([x, y, z]: &[[f32; N]; 3]) -> Self {
        Self::new(L::load(x), L::load(y), L::load(z))
    }

    /// Copies the vector at index `lane` to every lane.
    ///
    /// # Panics
    /// If `lane` is not below `M`.
    #[inline(always)]
    pub fn splat_lane<const M: usize>([x, y, z]: &[[f32; M]; 3], lane: usize) -> Self {
        Self::new(L::splat(x[lane]), L::splat(y[lane]), L::splat(z[lane]))
    }

    /// The same numbers in `f64`.
    #[inline(always)]
    pub fn widen(self) -> LaneVec3<N, L::Double> {
        LaneVec3::new(self.x.widen(), self.y.widen(), self.z.widen())
    }
}

impl<const N: usize, L: Arithmetic<N>> LaneVec3<N, L> {
    /// The vectors with these coordinates.
    #[inline(always)]
    pub fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z, width: PhantomData }
    }

    /// Scalar products.
    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        self.x.mul(other.x).add(self.y.mul(other.y)).add(self.z.mul(other.z))
    }

    /// Like [`dot`](Self::dot), with [`Arithmetic::mul_add_loosely`].
    #[inline(always)]
    pub fn dot_loosely(self, other: Self) -> L {
        self.z.mul_add_loosely(other.z, self.y.mul_add_loosely(other.y, self.x.mul(other.x)))
    }

    /// Like [`cross`](Self::cross), with [`Arithmetic::mul_sub_loosely`].
    #[inline(always)]
    pub fn cross_loosely(self, other: Self) -> Self {
        let minor = |a: L, b: L, c: L, d: L| a.mul_sub_loosely(b, c.mul(d));
        Self::new(
            minor(self.y, other.z, self.z, other.y),
            minor(self.z, other.x, self.x, other.z),
            minor(self.x, other.y, self.y, other.x),
        )
    }

    /// The sum of the components' magnitudes.
    #[inline(always)]
    pub fn abs_sum(self) -> L {
        let abs = |x: L| x.flip_sign(x);
        abs(self.x).add(abs(self.y)).add(abs(self.z))
    }

    /// The largest of the components' magnitudes.
    #[inline(always)]
    pub fn abs_max(self) -> L {
        let abs = |x: L| x.flip_sign(x);
        abs(self.x).max(abs(self.y)).max(abs(self.z))
    }

    /// Vector products.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y.mul(other.z).sub(self.z.mul(other.y)),
            self.z.mul(other.x).sub(self.x.mul(other.z)),
            self.x.mul(other.y).sub(self.y.mul(other.x)),
        )
    }
}

impl<const N: usize, L: Arithmetic<N>> Sub for LaneVec3<N, L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x.sub(other.x), self.y.sub(other.y), self.z.sub(other.z))
    }
}
