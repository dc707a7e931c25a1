//! Lanes of `f32` and `f64`: written once over a small trait, so that every width gives the same bits.

#[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
mod avx;
#[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
mod avx_double;
mod portable;
#[cfg(target_arch = "x86_64")]
mod sse;
mod vector;

#[cfg(target_arch = "x86_64")]
pub use sse::F32x4;
#[cfg(not(target_arch = "x86_64"))]
pub type F32x4 = portable::Portable<4>;

#[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
pub use avx::F32x8;
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx")))]
pub type F32x8 = portable::Portable<8>;

pub use portable::Portable;
pub use vector::LaneVec3;

/// `N` lanes of one type of float. Arithmetic is that of IEEE 754, lane by lane and never fused.
pub trait Arithmetic<const N: usize>: Copy {
    type Scalar: Copy;

    /// Zero in every lane.
    fn zero() -> Self;
    fn splat(value: Self::Scalar) -> Self;
    fn store(self) -> [Self::Scalar; N];
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// The lesser; `other` where they are equal or one is NaN.
    fn min(self, other: Self) -> Self;
    /// The greater; `other` where they are equal or one is NaN.
    fn max(self, other: Self) -> Self;
    /// `self`, negated in the lanes where the sign bit of `other` is set.
    fn flip_sign(self, other: Self) -> Self;
    /// Lanes where `self <= other`, as bits, lane 0 lowest; false where one is NaN.
    fn le(self, other: Self) -> u32;
    /// Lanes where `self < other`, likewise.
    fn lt(self, other: Self) -> u32;
}

/// `N` lanes of `f32`.
pub trait Lanes<const N: usize>: Arithmetic<N, Scalar = f32> {
    type Double: Arithmetic<N, Scalar = f64>;

    fn load(values: &[f32; N]) -> Self;
    /// The same numbers.
    fn widen(self) -> Self::Double;
    /// The nearest floats.
    fn narrow(wide: Self::Double) -> Self;
    /// `self * factor + term`, rounded once where the machine does that in one step, else twice: only for what no hit depends on.
    fn mul_add_loosely(self, factor: Self, term: Self) -> Self;
    /// `self * factor - term`, likewise.
    fn mul_sub_loosely(self, factor: Self, term: Self) -> Self;
}

/// Eight lanes that can be written to memory in a given order, some left out.
pub trait Sieve: Lanes<8> {
    /// Appends the lanes where `self <= limit`, in the order given (three bits a lane, the first one lowest), to `keys`, and
    /// their `values` to `chosen`; returns how many they are.
    ///
    /// # Safety
    /// Eight floats and eight numbers may be written, whatever the answer.
    unsafe fn sieve(self, limit: Self, values: *const u32, order: u32, keys: *mut f32, chosen: *mut u32) -> u32;

    /// As `sieve`, in the order of the lanes and without the keys.
    ///
    /// # Safety
    /// As there.
    unsafe fn sift(self, limit: Self, values: *const u32, chosen: *mut u32) -> u32;
}

/// The instruction set that this build of the lanes uses, for records.
pub fn level() -> &'static str {
    if cfg!(all(target_arch = "x86_64", target_feature = "avx")) {
        "avx"
    } else if cfg!(target_arch = "x86_64") {
        "sse2"
    } else {
        "portable"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPECIAL: [f32; 12] =
        [0.0, -0.0, 1.0, -1.5, 1e-40, 3e38, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.1, 7.0, -1e-20];

    fn same_as_portable<const N: usize, L: Lanes<N>>() {
        for i in 0..SPECIAL.len() {
            for j in 0..SPECIAL.len() {
                let a = std::array::from_fn(|k| SPECIAL[(i + k) % SPECIAL.len()]);
                let b = std::array::from_fn(|k| SPECIAL[(j + 5 * k) % SPECIAL.len()]);
                let (x, y) = (L::load(&a), L::load(&b));
                let (p, q) = (Portable::load(&a), Portable::load(&b));
                let bits = |v: [f32; N]| v.map(|f| if f.is_nan() { 0x7fc0_0000 } else { f.to_bits() });
                assert_eq!(bits(x.add(y).store()), bits(p.add(q).store()));
                assert_eq!(bits(x.sub(y).store()), bits(p.sub(q).store()));
                assert_eq!(bits(x.mul(y).store()), bits(p.mul(q).store()));
                assert_eq!(bits(x.div(y).store()), bits(p.div(q).store()));
                assert_eq!(bits(x.min(y).store()), bits(p.min(q).store()));
                assert_eq!(bits(x.flip_sign(y).store()), bits(p.flip_sign(q).store()));
                assert_eq!((x.le(y), x.lt(y)), (p.le(q), p.lt(q)));
                assert_eq!(bits(L::splat(a[0]).store()), bits([a[0]; N]));
            }
        }
    }

    #[test]
    fn every_width_gives_the_bits_of_the_portable_lanes() {
        same_as_portable::<4, F32x4>();
        same_as_portable::<8, F32x8>();
    }
}
