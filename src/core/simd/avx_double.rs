use std::arch::x86_64::*;

use super::{Arithmetic, indexed};

/// Eight lanes of `f64` in two AVX registers.
///
/// Only [`Avx`](super::avx::Avx) uses this type. `Avx` requires a machine with AVX2 and FMA.
#[derive(Clone, Copy, Debug)]
pub struct F64x8(pub(super) [__m256d; 2]);

impl F64x8 {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(__m256d, __m256d) -> __m256d) -> Self {
        Self([f(self.0[0], other.0[0]), f(self.0[1], other.0[1])])
    }

    #[inline(always)]
    fn bits(self, other: Self, f: impl Fn(__m256d, __m256d) -> i32) -> u32 {
        (f(self.0[0], other.0[0]) | f(self.0[1], other.0[1]) << 4) as u32
    }
}

macro_rules! lanewise {
    ($($name:ident: $instruction:ident),*) => {$(
        #[inline(always)]
        fn $name(self, other: Self) -> Self {
            // SAFETY: the machine has the instruction, see `Avx`.
            self.zip(other, |a, b| unsafe { $instruction(a, b) })
        }
    )*};
}

impl Arithmetic<8> for F64x8 {
    type Scalar = f64;

    lanewise!(add: _mm256_add_pd, sub: _mm256_sub_pd, mul: _mm256_mul_pd, div: _mm256_div_pd);
    lanewise!(min: _mm256_min_pd, max: _mm256_max_pd);

    instructions! {
        fn splat(value: f64) -> Self {
            Self([_mm256_set1_pd(value); 2])
        }
        fn store(self) -> [f64; 8] {
            let mut values = [0.0; 8];
            // Each store fills half of the array.
            _mm256_storeu_pd(values.as_mut_ptr(), self.0[0]);
            _mm256_storeu_pd(values.as_mut_ptr().add(4), self.0[1]);
            values
        }
        fn flip_sign(self, other: Self) -> Self {
            self.zip(other, |a, b| _mm256_xor_pd(a, _mm256_and_pd(b, _mm256_set1_pd(-0.0))))
        }
        fn le(self, other: Self) -> u32 {
            self.bits(other, |a, b| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(a, b)))
        }
        fn lt(self, other: Self) -> u32 {
            self.bits(other, |a, b| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(a, b)))
        }
        fn mul_add_loosely(self, factor: Self, term: Self) -> Self {
            Self(indexed(|half| _mm256_fmadd_pd(self.0[half], factor.0[half], term.0[half])))
        }
        fn mul_sub_loosely(self, factor: Self, term: Self) -> Self {
            Self(indexed(|half| _mm256_fmsub_pd(self.0[half], factor.0[half], term.0[half])))
        }
    }
}
