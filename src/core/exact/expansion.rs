//! Exact sums of floats.

use std::cmp::Ordering;

use smallvec::SmallVec;

/// A number as the exact sum of nonzero floats in ascending magnitude. The bits of different terms do not overlap.
///
/// Sums and products are exact unless a result overflows or underflows. A product of six differences of `f32` numbers
/// neither overflows nor underflows. The magnitude of such a product is below 2^780. Such a product is a multiple of
/// 2^-894.
///
/// # References
/// Shewchuk: Adaptive precision floating-point arithmetic and fast robust geometric predicates. Discrete &
/// Computational Geometry 18, 1997.
#[derive(Clone, Debug, Default)]
pub(super) struct Expansion(SmallVec<[f64; 6]>);

impl Expansion {
    pub fn difference(a: f64, b: f64) -> Self {
        let mut difference = Self::from(a);
        difference.add(-b);
        difference
    }

    /// `x` times 2 to the power of `exponent`. Within the asserted ranges, no term overflows or underflows.
    pub fn of_integer(mut x: i128, exponent: i32) -> Self {
        debug_assert!(x.unsigned_abs() < 1 << 126 && (-1022..=800).contains(&exponent));
        let scale = f64::from_bits(((1023 + exponent) as u64) << 52);
        let mut terms = SmallVec::new();
        while x != 0 {
            let term = x as f64;
            terms.push(term * scale);
            x -= term as i128;
        }
        terms.reverse();
        Self(terms)
    }

    /// Adds a float by Shewchuk's Grow-Expansion.
    fn add(&mut self, mut x: f64) {
        let mut kept = 0;
        for i in 0..self.0.len() {
            let error;
            (x, error) = exact_sum(x, self.0[i]);
            if error != 0.0 {
                self.0[kept] = error;
                kept += 1;
            }
        }
        self.0.truncate(kept);
        if x != 0.0 {
            self.0.push(x);
        }
    }

    fn add_signed_product(&mut self, sign: f64, a: &Self, b: &Self) {
        for &x in &a.0 {
            for &y in &b.0 {
                let product = sign * x * y;
                self.add((sign * x).mul_add(y, -product));
                self.add(product);
            }
        }
    }

    /// `a * b - c * d`.
    pub fn minor(a: &Self, b: &Self, c: &Self, d: &Self) -> Self {
        let mut minor = Self::default();
        minor.add_signed_product(1.0, a, b);
        minor.add_signed_product(-1.0, c, d);
        minor
    }

    pub fn dot(a: &[Self; 3], b: &[Self; 3]) -> Self {
        let mut sum = Self::default();
        for (x, y) in a.iter().zip(b) {
            sum.add_signed_product(1.0, x, y);
        }
        sum
    }

    pub fn negate(&mut self) {
        self.0.iter_mut().for_each(|term| *term = -*term);
    }

    /// The sign of the number is the sign of the last term, which exceeds the sum of all other terms in magnitude.
    pub fn sign(&self) -> Ordering {
        self.0.last().map_or(Ordering::Equal, |largest| largest.total_cmp(&0.0))
    }

    /// The value of the number, with a relative error of at most 2^-52.
    ///
    /// The bits of two terms from `add` are never adjacent, because sums round to even (Shewchuk: Grow-Expansion). Each
    /// term from `of_integer` is at most 2^-53 of the next term. So the magnitudes of the partial sums grow. The
    /// rounding errors of the partial sums add up to at most twice the error bound of the last sum.
    pub fn approximate(&self) -> f64 {
        self.0.iter().fold(0.0, |sum, term| sum + term)
    }
}

#[cfg(test)]
impl From<&Expansion> for dashu_ratio::RBig {
    fn from(x: &Expansion) -> Self {
        x.0.iter().fold(Self::ZERO, |sum, &term| sum + Self::try_from(term).unwrap())
    }
}

impl From<f64> for Expansion {
    fn from(x: f64) -> Self {
        let mut sum = Self::default();
        sum.add(x);
        sum
    }
}

/// The rounded sum and the exact rounding error (Knuth's TwoSum).
#[inline(always)]
pub(super) fn exact_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    (sum, (a - of_a) + (b - of_b))
}

#[cfg(test)]
mod tests {
    use dashu_ratio::RBig;

    use super::*;

    fn approximates(sum: &Expansion, right: RBig) {
        assert_eq!(sum.sign(), right.cmp(&RBig::ZERO));
        let error = (RBig::try_from(sum.approximate()).unwrap() - &right) * RBig::from(1_u64 << 52);
        let size = right.clone().max(-right);
        assert!(error >= -size.clone() && error <= size);
    }

    #[test]
    fn integers_are_those_of_rationals() {
        let touching = (((1_i128 << 52) + 1) << 73) + (1 << 72) - 1;
        let around = (0..126).flat_map(|bits| [-1, 0, 1].map(|k| (1_i128 << bits) + k)).filter(|&x| x < 1 << 126);
        for x in around.chain([touching, (1 << 126) - 1, 0x1234_5678_9abc_def0_1234_5678_9abc]) {
            for (x, exponent) in [(x, 0), (-x, -447), (x, 300)] {
                let scale = RBig::try_from(2.0_f64.powi(exponent)).unwrap();
                let sum = Expansion::of_integer(x, exponent);
                let right = RBig::from(x) * scale;
                assert_eq!(RBig::from(&sum), right, "{x} {exponent}");
                approximates(&sum, right);
            }
        }
    }

    #[test]
    fn sums_and_products_are_those_of_rationals() {
        let rational = |x: &Expansion| RBig::from(x);
        let number = |i: u32| {
            let bits = i.wrapping_mul(2_654_435_761);
            let similar = bits & 0xbfff_ffff | 0x2000_0000;
            f64::from(f32::from_bits(if i.is_multiple_of(3) { bits & 0xff7f_ffff } else { similar }))
        };
        for i in 0..2_000 {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| Expansion::difference(number(5 * i + k), number(7 * i + 2 * k)));
            let minor = Expansion::minor(&a, &b, &c, &d);
            let right = rational(&a) * rational(&b) - rational(&c) * rational(&d);
            assert_eq!(rational(&minor), right);
            // The magnitude of each term is less than half of the lowest set bit of the next term.
            for pair in minor.0.windows(2) {
                let next = pair[1].to_bits();
                let (bits, exponent) = (next & ((1 << 52) - 1), (next >> 52 & 0x7ff) as i32 - 1075);
                let lowest = 2.0_f64.powi(exponent + (bits | 1 << 52).trailing_zeros() as i32);
                assert!(pair[0] != 0.0 && 2.0 * pair[0].abs() < lowest, "{minor:?}");
            }
            assert_eq!(Expansion::minor(&minor, &minor, &minor, &minor).sign(), Ordering::Equal);
            approximates(&minor, right);
        }
    }
}
