use std::arch::x86_64::*;

use super::avx_double::F64x8;
use super::{Arithmetic, EightLanes, Lanes};

/// Eight lanes in one register, for machines with AVX2 and FMA. `MASKS = true` also requires AVX-512 F and VL.
///
/// The type is private to `simd`. Only [`dispatch`](super::dispatch) may use it, in functions that are compiled for
/// the instructions, and only if the machine has them.
///
/// Loads and stores need no alignment. An array of eight `f32` or eight `u32` is as large as a register.
#[derive(Clone, Copy, Debug)]
pub struct Avx<const MASKS: bool>(__m256);

macro_rules! lanewise {
    ($($name:ident: $instruction:ident),*) => {$(
        #[inline(always)]
        fn $name(self, other: Self) -> Self {
            // SAFETY: the machine has the instruction, see `Avx`.
            Self(unsafe { $instruction(self.0, other.0) })
        }
    )*};
}

macro_rules! instructions {
    ($(fn $name:ident($($parameter:tt)*) -> $result:ty { $($body:tt)* })*) => {$(
        #[inline(always)]
        fn $name($($parameter)*) -> $result {
            // SAFETY: the machine has the instructions, see `Avx`.
            unsafe { $($body)* }
        }
    )*};
}

impl<const MASKS: bool> Arithmetic<8> for Avx<MASKS> {
    type Scalar = f32;

    lanewise!(add: _mm256_add_ps, sub: _mm256_sub_ps, mul: _mm256_mul_ps, div: _mm256_div_ps);
    lanewise!(min: _mm256_min_ps, max: _mm256_max_ps);

    instructions! {
        fn splat(value: f32) -> Self {
            Self(_mm256_set1_ps(value))
        }
        fn store(self) -> [f32; 8] {
            let mut values = [0.0; 8];
            _mm256_storeu_ps(values.as_mut_ptr(), self.0);
            values
        }
        fn flip_sign(self, other: Self) -> Self {
            Self(_mm256_xor_ps(self.0, _mm256_and_ps(other.0, _mm256_set1_ps(-0.0))))
        }
        fn le(self, other: Self) -> u32 {
            _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) as u32
        }
        fn lt(self, other: Self) -> u32 {
            _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) as u32
        }
        fn mul_add_loosely(self, factor: Self, term: Self) -> Self {
            Self(_mm256_fmadd_ps(self.0, factor.0, term.0))
        }
        fn mul_sub_loosely(self, factor: Self, term: Self) -> Self {
            Self(_mm256_fmsub_ps(self.0, factor.0, term.0))
        }
    }
}

impl<const MASKS: bool> Lanes<8> for Avx<MASKS> {
    type Double = F64x8;

    instructions! {
        fn load(values: &[f32; 8]) -> Self {
            Self(_mm256_loadu_ps(values.as_ptr()))
        }
        fn narrow(F64x8([low, high]): F64x8) -> Self {
            Self(_mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low)))
        }
        fn widen(self) -> F64x8 {
            let halves = [_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0)];
            F64x8([_mm256_cvtps_pd(halves[0]), _mm256_cvtps_pd(halves[1])])
        }
    }
}

/// `MEMBERS[set]` is the ascending list of the lanes in the bit set `set`, padded with zeros.
static MEMBERS: [[u8; 8]; 256] = {
    let mut table = [[0; 8]; 256];
    let mut set = 0;
    while set < 256 {
        let (mut lane, mut at) = (0, 0);
        while lane < 8 {
            if set >> lane & 1 == 1 {
                table[set][at] = lane as u8;
                at += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    table
};

impl<const MASKS: bool> EightLanes for Avx<MASKS> {
    type Mask = __m256;
    type Numbers = __m256i;

    const FAST: bool = true;

    #[inline(always)]
    fn transpose([a, b, c, d, e, f, g, h]: [Self; 8]) -> [Self; 8] {
        // SAFETY: the machine has the instructions, see `Avx`.
        unsafe {
            let pairs = |x: Self, y: Self| (_mm256_unpacklo_ps(x.0, y.0), _mm256_unpackhi_ps(x.0, y.0));
            let ((ab0, ab1), (cd0, cd1), (ef0, ef1), (gh0, gh1)) = (pairs(a, b), pairs(c, d), pairs(e, f), pairs(g, h));
            let low = |x, y| _mm256_shuffle_ps::<0b01_00_01_00>(x, y);
            let high = |x, y| _mm256_shuffle_ps::<0b11_10_11_10>(x, y);
            let (abcd0, abcd1, abcd2, abcd3) = (low(ab0, cd0), high(ab0, cd0), low(ab1, cd1), high(ab1, cd1));
            let (efgh0, efgh1, efgh2, efgh3) = (low(ef0, gh0), high(ef0, gh0), low(ef1, gh1), high(ef1, gh1));
            let near = |x, y| Self(_mm256_permute2f128_ps::<0x20>(x, y));
            let far = |x, y| Self(_mm256_permute2f128_ps::<0x31>(x, y));
            [
                near(abcd0, efgh0),
                near(abcd1, efgh1),
                near(abcd2, efgh2),
                near(abcd3, efgh3),
                far(abcd0, efgh0),
                far(abcd1, efgh1),
                far(abcd2, efgh2),
                far(abcd3, efgh3),
            ]
        }
    }

    #[inline(always)]
    unsafe fn compress_ordered(
        self,
        limit: Self,
        values: &[u32; 8],
        order: u32,
        keys: *mut f32,
        chosen: *mut u32,
    ) -> u32 {
        // SAFETY: the machine has the instructions, see `Avx`. By contract, `keys` and `chosen` are valid for writes of
        // eight elements.
        unsafe {
            let hit = _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, limit.0);
            let shifts = _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21);
            // A permutation uses only bits 0 to 2 of each index.
            let order = _mm256_srlv_epi32(_mm256_set1_epi32(order as i32), shifts);
            let set = _mm256_movemask_ps(_mm256_permutevar8x32_ps(hit, order)) as u32;
            let lanes = if MASKS {
                _mm256_maskz_compress_epi32(set as u8, order)
            } else {
                _mm256_permutevar8x32_epi32(order, members(set))
            };
            _mm256_storeu_ps(keys, _mm256_permutevar8x32_ps(self.0, lanes));
            _mm256_storeu_si256(
                chosen.cast(),
                _mm256_permutevar8x32_epi32(_mm256_loadu_si256(values.as_ptr().cast()), lanes),
            );
            set
        }
    }

    #[inline(always)]
    unsafe fn compress(self, limit: Self, values: &[u32; 8], chosen: *mut u32) -> u32 {
        // SAFETY: the machine has the instructions, see `Avx`. By contract, `chosen` is valid for writes of eight
        // elements.
        unsafe {
            let set = self.le(limit);
            let values = _mm256_loadu_si256(values.as_ptr().cast());
            let left = if MASKS {
                _mm256_maskz_compress_epi32(set as u8, values)
            } else {
                _mm256_permutevar8x32_epi32(values, members(set))
            };
            _mm256_storeu_si256(chosen.cast(), left);
            set
        }
    }

    instructions! {
        fn cmp_le(self, other: Self) -> __m256 {
            _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)
        }
        fn cmp_lt(self, other: Self) -> __m256 {
            _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)
        }
        fn mask(bits: u32) -> __m256 {
            let own = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let set = _mm256_and_si256(_mm256_set1_epi32(bits as i32), own);
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, own))
        }
        fn bits(mask: __m256) -> u32 {
            _mm256_movemask_ps(mask) as u32
        }
        fn both(one: __m256, other: __m256) -> __m256 {
            _mm256_and_ps(one, other)
        }
        fn either(one: __m256, other: __m256) -> __m256 {
            _mm256_or_ps(one, other)
        }
        fn choose(self, other: Self, mask: __m256) -> Self {
            Self(_mm256_blendv_ps(other.0, self.0, mask))
        }
        fn numbers(numbers: &[u32; 8]) -> __m256i {
            _mm256_loadu_si256(numbers.as_ptr().cast())
        }
        fn splat_number(number: u32) -> __m256i {
            _mm256_set1_epi32(number as i32)
        }
        fn store_numbers(numbers: __m256i) -> [u32; 8] {
            let mut stored = [0; 8];
            _mm256_storeu_si256(stored.as_mut_ptr().cast(), numbers);
            stored
        }
        fn cmp_le_numbers(one: __m256i, other: __m256i) -> __m256 {
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_min_epu32(one, other), one))
        }
        fn choose_numbers(one: __m256i, other: __m256i, mask: __m256) -> __m256i {
            _mm256_blendv_epi8(other, one, _mm256_castps_si256(mask))
        }
    }
}

#[inline(always)]
fn members(set: u32) -> __m256i {
    // SAFETY: the machine has the instructions, see `Avx`. A row of `MEMBERS` has eight bytes.
    unsafe { _mm256_cvtepu8_epi32(_mm_loadl_epi64(MEMBERS[(set & 0xff) as usize].as_ptr().cast())) }
}
