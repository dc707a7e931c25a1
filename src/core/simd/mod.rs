//! SIMD lanes of `f32` and `f64` behind small traits.

#[cfg(target_arch = "x86_64")]
#[macro_use]
mod avx;
#[cfg(target_arch = "x86_64")]
mod avx_double;
mod each;
mod level;
mod portable;
mod vector;

pub use each::{each, indexed};
pub use level::{Kernel, Level, UnknownLevel, dispatch};
pub use portable::Portable;
pub use vector::LaneVec3;

/// `N` lanes of one float type.
///
/// Arithmetic follows IEEE 754 in each lane. Only `mul_add_loosely` and `mul_sub_loosely` may fuse operations. Every
/// comparison with NaN is false.
pub trait Arithmetic<const N: usize>: Copy {
    /// The type of one lane.
    type Scalar: Copy + Default;

    /// Zero in every lane.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(Self::Scalar::default())
    }
    /// The same number in every lane.
    fn splat(value: Self::Scalar) -> Self;
    /// The lanes as an array.
    fn store(self) -> [Self::Scalar; N];
    /// Sums.
    fn add(self, other: Self) -> Self;
    /// Differences.
    fn sub(self, other: Self) -> Self;
    /// Products.
    fn mul(self, other: Self) -> Self;
    /// Quotients.
    fn div(self, other: Self) -> Self;
    /// The lesser number in each lane. For equal numbers or NaN, the result is the number in `other`.
    fn min(self, other: Self) -> Self;
    /// The greater number in each lane. For equal numbers or NaN, the result is the number in `other`.
    fn max(self, other: Self) -> Self;
    /// `self`, negated in the lanes where the sign bit of `other` is set.
    fn flip_sign(self, other: Self) -> Self;
    /// Bit `i` of the result is set if `self <= other` in lane `i`.
    fn le(self, other: Self) -> u32;
    /// Bit `i` of the result is set if `self < other` in lane `i`.
    fn lt(self, other: Self) -> u32;
    /// `self * factor + term`, rounded once or twice. Hits must not depend on the number of roundings.
    fn mul_add_loosely(self, factor: Self, term: Self) -> Self;
    /// `self * factor - term`, rounded like [`mul_add_loosely`](Self::mul_add_loosely).
    fn mul_sub_loosely(self, factor: Self, term: Self) -> Self;
}

/// `N` lanes of `f32`.
pub trait Lanes<const N: usize>: Arithmetic<N, Scalar = f32> {
    /// `N` lanes of `f64`.
    type Double: Arithmetic<N, Scalar = f64>;

    /// Lanes with the numbers in `values`.
    fn load(values: &[f32; N]) -> Self;
    /// The same numbers as `f64`.
    fn widen(self) -> Self::Double;
    /// The nearest `f32` numbers.
    fn narrow(wide: Self::Double) -> Self;
}

/// Eight lanes of `f32`, with comparison masks.
pub trait EightLanes: Lanes<8> {
    /// A boolean per lane.
    type Mask: Copy;
    /// A `u32` per lane.
    type Numbers: Copy;

    /// Whether lane operations are vector instructions.
    const FAST: bool;

    /// Selects the lanes where `self <= limit`.
    ///
    /// The selected lanes of `self` are written to `keys`. The selected elements of `values` are written to `chosen`.
    ///
    /// `order` is a list of eight lane indices, 3 bits each. Bits 0 to 2 of `order` contain the index at position 0.
    /// The selected lanes and elements are written in list order. Bit `i` of the result is set if the lane at list
    /// position `i` is selected.
    ///
    /// # Safety
    /// `keys` and `chosen` must be valid for writes of eight elements, even if fewer lanes are selected.
    unsafe fn compress_ordered(
        self,
        limit: Self,
        values: &[u32; 8],
        order: u32,
        keys: *mut f32,
        chosen: *mut u32,
    ) -> u32;

    /// Selects the lanes where `self <= limit`.
    ///
    /// The selected elements of `values` are written to `chosen` in ascending lane order. Bit `i` of the result is
    /// set if lane `i` is selected.
    ///
    /// # Safety
    /// `chosen` must be valid for writes of eight numbers, even if fewer lanes are selected.
    unsafe fn compress(self, limit: Self, values: &[u32; 8], chosen: *mut u32) -> u32;

    /// The lanes where `self <= other`.
    fn cmp_le(self, other: Self) -> Self::Mask;
    /// The lanes where `self < other`.
    fn cmp_lt(self, other: Self) -> Self::Mask;
    /// The mask that contains lane `i` if bit `i` of `bits` is set.
    fn mask(bits: u32) -> Self::Mask;
    /// Bit `i` of the result is set if `mask` contains lane `i`.
    fn bits(mask: Self::Mask) -> u32;
    /// The lanes that are in both masks.
    fn both(one: Self::Mask, other: Self::Mask) -> Self::Mask;
    /// The lanes that are in at least one of the masks.
    fn either(one: Self::Mask, other: Self::Mask) -> Self::Mask;
    /// `self` in the lanes of `mask`, `other` elsewhere.
    fn choose(self, other: Self, mask: Self::Mask) -> Self;

    /// Lanes with the numbers in `numbers`.
    fn numbers(numbers: &[u32; 8]) -> Self::Numbers;
    /// The same number in every lane.
    fn splat_number(number: u32) -> Self::Numbers;
    /// The lanes as an array.
    fn store_numbers(numbers: Self::Numbers) -> [u32; 8];
    /// The lanes where `one <= other`.
    fn cmp_le_numbers(one: Self::Numbers, other: Self::Numbers) -> Self::Mask;
    /// `one` in the lanes of `mask`, `other` elsewhere.
    fn choose_numbers(one: Self::Numbers, other: Self::Numbers, mask: Self::Mask) -> Self::Numbers;

    /// Lane `j` of row `i` becomes lane `i` of row `j`.
    fn transpose(rows: [Self; 8]) -> [Self; 8];
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPECIAL: [f32; 12] =
        [0.0, -0.0, 1.0, -1.5, 1e-40, 3e38, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.1, 7.0, -1e-20];

    fn specials() -> impl Iterator<Item = ([f32; 8], [f32; 8])> {
        let n = SPECIAL.len();
        (0..n * n).map(move |i| {
            let lanes = |first, step| std::array::from_fn(|k| SPECIAL[(first + step * k) % n]);
            (lanes(i / n, 1), lanes(i % n, 5))
        })
    }

    fn same_arithmetic<L: EightLanes>() {
        for (a, b) in specials() {
            let (x, y) = (L::load(&a), L::load(&b));
            let (p, q) = (Portable::load(&a), Portable::load(&b));
            let bits = |v: [f32; 8]| v.map(|f| if f.is_nan() { 0x7fc0_0000 } else { f.to_bits() });
            let own = [x.add(y), x.sub(y), x.mul(y), x.div(y), x.min(y), x.max(y), x.flip_sign(y)];
            let portable = [p.add(q), p.sub(q), p.mul(q), p.div(q), p.min(q), p.max(q), p.flip_sign(q)];
            assert_eq!(own.map(|v| bits(v.store())), portable.map(|v| bits(v.store())));
            assert_eq!((x.le(y), x.lt(y)), (p.le(q), p.lt(q)));
            assert_eq!(bits(L::splat(a[0]).store()), bits([a[0]; 8]));
        }
    }

    fn taken<L: EightLanes>(a: &[f32; 8], b: &[f32; 8], order: u32) -> ([u32; 2], [Vec<u32>; 3]) {
        let (a, b, values) = (L::load(a), L::load(b), std::array::from_fn(|i| 100 + i as u32));
        let (mut keys, [mut ordered, mut plain]) = ([0.0_f32; 8], [[0_u32; 8]; 2]);
        // SAFETY: the arrays have eight elements.
        let sets = unsafe {
            let set = a.compress_ordered(b, &values, order, keys.as_mut_ptr(), ordered.as_mut_ptr());
            [set, a.compress(b, &values, plain.as_mut_ptr())]
        };
        let first = |lanes: [u32; 8], set: u32| lanes[..set.count_ones() as usize].to_vec();
        (sets, [first(keys.map(f32::to_bits), sets[0]), first(ordered, sets[0]), first(plain, sets[1])])
    }

    fn same_compression<L: EightLanes>() {
        for seed in 0..SPECIAL.len() * SPECIAL.len() {
            let a: [f32; 8] = std::array::from_fn(|k| SPECIAL[(seed + 3 * k) % SPECIAL.len()]);
            let b: [f32; 8] = std::array::from_fn(|k| SPECIAL[(seed / SPECIAL.len() + 7 * k) % SPECIAL.len()]);
            let order = (0..8).fold(0, |order, i| order << 3 | ((i * 3 + seed) % 8) as u32);
            assert_eq!(taken::<L>(&a, &b, order), taken::<Portable<8>>(&a, &b, order));
        }
        for (x, y) in specials() {
            let (a, b) = (L::load(&x), L::load(&y));
            let (one, other) = (L::numbers(&x.map(f32::to_bits)), L::numbers(&y.map(f32::to_bits)));
            let least = (0..8).fold(0, |bits, i| bits | u32::from(x[i].to_bits() <= y[i].to_bits()) << i);
            let some = 0b1011_0110;
            let masks = [
                (a.cmp_le(b), a.le(b)),
                (a.cmp_lt(b), a.lt(b)),
                (L::cmp_le_numbers(one, other), least),
                (L::both(a.cmp_le(b), L::mask(some)), a.le(b) & some),
                (L::either(a.cmp_lt(b), L::mask(some)), a.lt(b) | some),
            ];
            for (mask, bits) in masks {
                let chosen =
                    |x: [u32; 8], y: [u32; 8]| std::array::from_fn(|i| if bits >> i & 1 == 1 { x[i] } else { y[i] });
                let (x, y) = (x.map(f32::to_bits), y.map(f32::to_bits));
                assert_eq!(a.choose(b, mask).store().map(f32::to_bits), chosen(x, y));
                assert_eq!(L::store_numbers(L::choose_numbers(one, L::splat_number(7), mask)), chosen(x, [7; 8]));
            }
        }
        let square: [[f32; 8]; 8] = std::array::from_fn(|i| std::array::from_fn(|j| (8 * i + j) as f32));
        let transposed = L::transpose(square.map(|row| L::load(&row))).map(L::store);
        assert_eq!(transposed, Portable::transpose(square.map(|row| Portable::load(&row))).map(Portable::store));
        assert_eq!(transposed, std::array::from_fn(|i| std::array::from_fn(|j| square[j][i])));
    }

    struct SameAsPortable;

    impl Kernel for SameAsPortable {
        type Output = ();

        #[inline(always)]
        fn run<L: EightLanes>(self) {
            same_arithmetic::<L>();
            same_compression::<L>();
        }
    }

    #[test]
    fn every_level_gives_the_bits_of_the_portable_lanes() {
        for level in Level::available() {
            dispatch(level, SameAsPortable);
        }
    }
}
