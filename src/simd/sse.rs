use std::arch::x86_64::*;

use super::{Arithmetic, Lanes, Portable};

/// 4 lanes in one SSE register.
#[derive(Clone, Copy, Debug)]
pub struct F32x4(__m128);

// SAFETY of every block below: the module is compiled only where the target is x86-64, which always has SSE2,
// so the instructions exist; loads and stores are unaligned ones, of arrays of exactly the register's size.
impl Arithmetic<4> for F32x4 {
    type Scalar = f32;

    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm_set1_ps(value) })
    }

    #[inline(always)]
    fn store(self) -> [f32; 4] {
        let mut values = [0.0; 4];
        // SAFETY: see above.
        unsafe { _mm_storeu_ps(values.as_mut_ptr(), self.0) };
        values
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm_add_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm_sub_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm_mul_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm_div_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm_min_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm_max_ps(self.0, other.0) })
    }

    #[inline(always)]
    fn flip_sign(self, other: Self) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm_xor_ps(self.0, _mm_and_ps(other.0, _mm_set1_ps(-0.0))) })
    }

    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        // SAFETY: see above.
        unsafe { _mm_movemask_ps(_mm_cmple_ps(self.0, other.0)) as u32 }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        // SAFETY: see above.
        unsafe { _mm_movemask_ps(_mm_cmplt_ps(self.0, other.0)) as u32 }
    }
}

impl Lanes<4> for F32x4 {
    type Double = Portable<4, f64>;

    #[inline(always)]
    fn load(values: &[f32; 4]) -> Self {
        // SAFETY: see above.
        Self(unsafe { _mm_loadu_ps(values.as_ptr()) })
    }

    #[inline(always)]
    fn widen(self) -> Portable<4, f64> {
        Portable::<4>::load(&self.store()).widen()
    }

    #[inline(always)]
    fn narrow(wide: Portable<4, f64>) -> Self {
        Self::load(&Portable::narrow(wide).store())
    }

    #[inline(always)]
    fn mul_add_loosely(self, factor: Self, term: Self) -> Self {
        self.mul(factor).add(term)
    }

    #[inline(always)]
    fn mul_sub_loosely(self, factor: Self, term: Self) -> Self {
        self.mul(factor).sub(term)
    }
}
